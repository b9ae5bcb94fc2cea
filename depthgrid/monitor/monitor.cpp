#include "depthgrid/monitor/monitor.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <thread>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/triple_buffer.hpp"
#include "depthgrid/monitor/asking_line.hpp"
#include "depthgrid/monitor/camera_line.hpp"
#include "depthgrid/monitor/joint_line.hpp"
#include "depthgrid/monitor/output_line.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {
namespace {

class CallingOutput final : public Output {
 public:
  explicit CallingOutput(std::function<void(const CellAnswer&)> function) : function_(std::move(function)) {}
  void take(const CellAnswer& answer) override { function_(answer); }

 private:
  std::function<void(const CellAnswer&)> function_;
};

Names names_of(const cell::CellSetup& setup) {
  Names names;
  names.cell = setup.rig.name;
  for (const RigCamera& camera : setup.rig.cameras) {
    names.cameras.push_back(camera.id);
  }
  for (const cell::AskedPart& part : setup.parts) {
    names.parts.push_back(part.name);
  }
  return names;
}

const MonitorSettings& checked(const cell::CellSetup& setup, const MonitorSettings& settings, const Sources& sources) {
  if (!(settings.rate_hz > 0 && settings.rate_hz <= 10000)) {
    fail("monitor: asks ", settings.rate_hz, " times a second, must be above 0 and at most 10000");
  }
  if (!(settings.stop_m >= 0) || !std::isfinite(settings.stop_m)) {
    fail("monitor: stops at ", settings.stop_m, " m, must be 0 or more");
  }
  if (!(settings.hold_s >= 0) || !std::isfinite(settings.hold_s)) {
    fail("monitor: holds a stop for ", settings.hold_s, " s, must be 0 or more");
  }
  if (sources.cameras.size() != setup.rig.cameras.size()) {
    fail("monitor: ", sources.cameras.size(), " sources for ", setup.rig.cameras.size(), " cameras, must be one each");
  }
  if (setup.robot && sources.joints == nullptr) {
    fail("monitor: there is a robot, and no source of its joints");
  }
  if (setup.parts.empty()) {
    fail("monitor: nothing is asked");
  }
  return settings;
}

}  // namespace

struct Monitor::State {
  State(const cell::CellSetup& setup, const MonitorSettings& wanted, Sources sources)
      : settings(checked(setup, wanted, sources)),
        names(names_of(setup)),
        evaluator(setup.rig, setup.settings, setup.options) {
    if (setup.robot) {
      history.emplace(setup.robot->model.joints().size(), kJointSamples, settings.max_joints_age_s,
                      settings.max_joints_age_s);
      intake.emplace(setup.rig, *setup.robot, *history, setup.exposure);
      joints.emplace(std::move(sources.joints), *history, settings.max_joints_age_s);
    }
    for (std::size_t k = 0; k < setup.rig.cameras.size(); ++k) {
      CameraLineSettings line;
      line.camera = k;
      line.max_image_age_s = setup.options.max_image_age_s;
      line.equal_images = k < settings.equal_images.size() && settings.equal_images[k];
      cameras.push_back(std::make_unique<CameraLine>(std::move(sources.cameras[k]), setup.rig.cameras[k], line,
                                                     evaluator, intake ? &*intake : nullptr));
    }
    asking.emplace(setup, StopRule{.stop_m = settings.stop_m, .hold_s = settings.hold_s}, evaluator,
                   history ? &*history : nullptr, cameras);
    newest.emplace(asking->answer());
  }

  void ask(const std::stop_token& stop) noexcept;

  MonitorSettings settings;
  Names names;
  search::SearchEvaluator evaluator;
  std::optional<robot::JointHistory> history;
  std::optional<robot::FrameIntake> intake;
  std::optional<JointLine> joints;
  std::vector<std::unique_ptr<CameraLine>> cameras;
  std::optional<AskingLine> asking;
  std::optional<TripleBuffer<CellAnswer>> newest;
  std::vector<std::unique_ptr<OutputLine>> outputs;
  std::atomic<std::uint64_t> late_questions{0};
  double begin_s = 0;
  std::atomic<double> end_s{Proximity::kNaN};
  std::unique_ptr<Recorder> recorder;  ///< null: nothing is recorded
  std::vector<std::jthread> threads;
  std::jthread recording;
};

void Monitor::State::ask(const std::stop_token& stop) noexcept {
  const double period_s = 1 / settings.rate_hz;
  double next_s = sensors::clock_now_s();
  while (!stop.stop_requested()) {
    // In whole nanoseconds, as a recording holds it.
    const double now_s = sensors::seconds_of(sensors::nanoseconds_of(sensors::clock_now_s()));
    const CellAnswer& answer = asking->ask(now_s);
    if (recorder != nullptr) {
      recorder->answer(answer);
    }
    newest->back() = answer;
    newest->publish();
    for (const std::unique_ptr<OutputLine>& output : outputs) {
      output->put(answer);
    }
    next_s += period_s;
    const double done_s = sensors::clock_now_s();
    if (done_s > next_s + period_s) {  // what was missed is not made up for
      late_questions.fetch_add(1, std::memory_order_relaxed);
      next_s = done_s;
    }
    // Not longer at once than somebody who stops it waits.
    while (!stop.stop_requested() && !sensors::wait_until(next_s, 0.05)) {
    }
  }
}

Monitor::Monitor(const cell::CellSetup& setup, const MonitorSettings& settings, Sources sources)
    : state_(std::make_unique<State>(setup, settings, std::move(sources))) {}

Monitor::~Monitor() { stop(); }

void Monitor::add(std::unique_ptr<Output> output) {
  if (!state_->threads.empty()) {
    fail("monitor: an output is added after the start");
  }
  state_->outputs.push_back(std::make_unique<OutputLine>(std::move(output), state_->asking->answer()));
}

void Monitor::record(std::unique_ptr<Recorder> recorder) {
  State& state = *state_;
  if (!state.threads.empty() || state.recorder != nullptr) {
    fail("monitor: a recorder is added ", state.recorder != nullptr ? "for the second time" : "after the start");
  }
  state.recorder = std::move(recorder);
  for (const std::unique_ptr<CameraLine>& camera : state.cameras) {
    camera->record(*state.recorder);
    camera->events().also(state.recorder->events());
  }
  if (state.joints) {
    state.joints->record(*state.recorder);
    state.joints->events().also(state.recorder->events());
  }
  state.asking->events().also(state.recorder->events());
}

void Monitor::start() {
  State& state = *state_;
  if (!state.threads.empty()) {
    fail("monitor: is started for the second time");
  }
  state.begin_s = sensors::clock_now_s();
  if (state.recorder != nullptr) {
    state.recording = std::jthread([&state](const std::stop_token& stop) { state.recorder->run(stop); });
  }
  for (const std::unique_ptr<OutputLine>& output : state.outputs) {
    state.threads.emplace_back([&line = *output](const std::stop_token& stop) { line.run(stop); });
  }
  if (state.joints) {
    state.threads.emplace_back([&state](const std::stop_token& stop) { state.joints->run(stop); });
  }
  for (const std::unique_ptr<CameraLine>& camera : state.cameras) {
    state.threads.emplace_back([&line = *camera](const std::stop_token& stop) { line.run(stop); });
  }
  state.threads.emplace_back([&state](const std::stop_token& stop) { state.ask(stop); });
}

void Monitor::stop() noexcept {
  for (std::jthread& thread : state_->threads) {
    thread.request_stop();
  }
  for (std::jthread& thread : state_->threads) {
    if (thread.joinable()) {
      thread.join();
    }
  }
  // Last of all, so that everything they said is in it.
  if (state_->recording.joinable()) {
    state_->recording.request_stop();
    state_->recording.join();
  }
  if (!state_->threads.empty() && std::isnan(state_->end_s.load())) {
    state_->end_s = sensors::clock_now_s();
  }
}

bool Monitor::newest(CellAnswer& answer) noexcept {
  if (!state_->newest->take()) {
    return false;
  }
  answer = state_->newest->front();
  return true;
}

std::vector<Event> Monitor::events() {
  std::vector<Event> result;
  const auto drain = [&](EventQueue& queue) {
    Event event;
    while (queue.pop(event)) {
      result.push_back(event);
    }
  };
  for (const std::unique_ptr<CameraLine>& camera : state_->cameras) {
    drain(camera->events());
  }
  if (state_->joints) {
    drain(state_->joints->events());
  }
  drain(state_->asking->events());
  if (state_->recorder != nullptr) {
    drain(state_->recorder->told());
  }
  std::stable_sort(result.begin(), result.end(), [](const Event& a, const Event& b) { return a.time_s < b.time_s; });
  return result;
}

const Names& Monitor::names() const noexcept { return state_->names; }

MonitorReport Monitor::report() const {
  const State& state = *state_;
  MonitorReport report;
  const double end_s = state.end_s.load();
  report.seconds = (std::isnan(end_s) ? sensors::clock_now_s() : end_s) - state.begin_s;
  report.answers = state.asking->answers();
  report.stopped = state.asking->stopped();
  report.stops = state.asking->stops();
  for (std::size_t i = 0; i < report.by_state.size(); ++i) {
    report.by_state.at(i) = state.asking->of_state(i);
  }
  report.longest_period_s = period().largest_s();
  report.late_questions = state.late_questions.load(std::memory_order_relaxed);
  report.events_dropped = state.asking->events().dropped();
  for (const std::unique_ptr<CameraLine>& camera : state.cameras) {
    report.cameras.push_back(camera->counts());
    report.events_dropped += camera->events().dropped();
  }
  if (state.joints) {
    report.joints = state.joints->counts();
    report.events_dropped += state_->joints->events().dropped();
  }
  if (state.recorder != nullptr) {
    report.recorded = state.recorder->counts();
  }
  for (const std::unique_ptr<OutputLine>& output : state.outputs) {
    report.passed_over.push_back(output->passed_over());
  }
  return report;
}

const TimeHistogram& Monitor::exposure_to_answer() const noexcept {
  return state_->asking->histograms().exposure_to_answer;
}
const TimeHistogram& Monitor::asking() const noexcept { return state_->asking->histograms().asking; }
const TimeHistogram& Monitor::period() const noexcept { return state_->asking->histograms().period; }
const TimeHistogram& Monitor::skew() const noexcept { return state_->asking->histograms().skew; }
const TimeHistogram& Monitor::image_age(std::size_t camera) const {
  return state_->asking->histograms().image_age.at(camera);
}
const TimeHistogram& Monitor::receipt(std::size_t camera) const { return state_->cameras.at(camera)->receipt(); }
const TimeHistogram& Monitor::hand_over() const noexcept { return state_->asking->histograms().hand_over; }
const TimeHistogram& Monitor::sending(std::size_t output) const { return state_->outputs.at(output)->sending(); }
const TimeHistogram& Monitor::preparation(std::size_t camera) const {
  return state_->cameras.at(camera)->preparation();
}

std::unique_ptr<Output> call(std::function<void(const CellAnswer&)> function) {
  return std::make_unique<CallingOutput>(std::move(function));
}

std::string event_line(const Event& event, const Names& names) {
  if (event.kind == EventKind::stop || event.kind == EventKind::go) {
    std::array<char, 640> buffer{};
    return std::string(event.kind == EventKind::stop ? "stop: " : "go: ") +
           std::string(sentence(event.reason, names, buffer));
  }
  if (event.kind == EventKind::recording_failed) {
    return "recording: " + std::string(event.words());
  }
  const std::string who = event.camera < names.cameras.size() ? names.cameras[event.camera] : "joints";
  const std::string what = event.kind == EventKind::source_open    ? "open: "
                           : event.kind == EventKind::camera_state ? std::string(to_string(event.state)) + ": "
                                                                   : "";
  return who + ": " + what + std::string(event.words());
}

}  // namespace depthgrid::monitor
