#include "lab/experiments/timing/loop_clock.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stop_token>
#include <thread>

#include "depthgrid/avoidance/history_port.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "lab/experiments/stage/declared_rig.hpp"
#include "lab/measure/clocks.hpp"

namespace depthgrid::experiments {

namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }
Clock::duration ticks(double duration_s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(duration_s));
}

/// Passes everything on, notes how long the distances took, and counts the answers that a budget ended.
class TimedEvaluator final : public DistanceEvaluator {
 public:
  explicit TimedEvaluator(DistanceEvaluator& evaluator) : evaluator_(evaluator) {}
  [[nodiscard]] std::string_view name() const noexcept override { return evaluator_.name(); }
  [[nodiscard]] std::size_t camera_count() const noexcept override { return evaluator_.camera_count(); }
  [[nodiscard]] double image_time_s(std::size_t camera) const noexcept override {
    return evaluator_.image_time_s(camera);
  }
  FrameUpdate update(std::size_t camera, const Frame& frame) noexcept override {
    return evaluator_.update(camera, frame);
  }
  FrameUpdate update(std::size_t camera, const Frame& frame, const Pose& T_world_camera) noexcept override {
    return evaluator_.update(camera, frame, T_world_camera);
  }
  void evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept override {
    const auto begin = Clock::now();
    evaluator_.evaluate(capsules, now_s, answers);
    evaluate_s_ = seconds(Clock::now() - begin);
    answered_ += static_cast<std::int64_t>(answers.size());
    stopped_ += std::count_if(answers.begin(), answers.end(), [](const Answer& a) { return a.nearest.budget; });
  }
  [[nodiscard]] double evaluate_s() const noexcept { return evaluate_s_; }
  [[nodiscard]] std::int64_t answered() const noexcept { return answered_; }
  [[nodiscard]] std::int64_t stopped_by_budget() const noexcept { return stopped_; }

 private:
  DistanceEvaluator& evaluator_;
  double evaluate_s_ = 0;
  std::int64_t answered_ = 0;
  std::int64_t stopped_ = 0;
};

avoidance::LoopSettings settings_of(Method method, LoopParts parts, const robot::RobotModel& model,
                                    const AvoidanceSettings& settings) {
  avoidance::LoopSettings loop = loop_settings(method, model, settings);
  if (parts == LoopParts::nine_points) {
    loop.parts = robot::nine_control_points(model);
  }
  loop.evaluate_every = 1;
  return loop;
}

/// Real-time priority for the calling thread while it lives.
class RealTimePriority {
 public:
  RealTimePriority() {
    sched_param parameter{};
    parameter.sched_priority = 50;
    granted_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) == 0;
  }
  ~RealTimePriority() {
    if (granted_) {
      const sched_param parameter{};
      pthread_setschedparam(pthread_self(), SCHED_OTHER, &parameter);
    }
  }
  RealTimePriority(const RealTimePriority&) = delete;
  RealTimePriority& operator=(const RealTimePriority&) = delete;
  [[nodiscard]] bool granted() const noexcept { return granted_; }

 private:
  bool granted_ = false;
};

constexpr std::size_t kSeenBefore = 15;  ///< frames that a memory sees before it is asked

/// Robot, history, evaluator and loop of one run.
struct Parts {
  Parts(const LoopRecording& recording, Method method, LoopParts which, const AvoidanceSettings& settings,
        const search::Budget& budget)
      : model(robot::kuka_lwr4()),
        common(settings_for(method, settings)),
        rig(method == Method::search_memory ? with_declarations(recording.rig()) : recording.rig()),
        loop_settings(settings_of(method, which, model, common)),
        history(model.joints().size(), 256, 0.02, 0.0),
        intake(rig, {model}, history, exposure_settings(common)),
        evaluator(make_evaluator(method, rig, common, budget)),
        timed(*evaluator),
        task(hexagon(model)),
        loop({model}, task, timed, loop_settings),
        arm(recording),
        port(arm, history) {}

  /// Throws Error, as nothing of a recording can fail.
  void start() {
    if (!loop.start(port)) {
      fail("timing: the loop does not start at the recorded joint positions");
    }
  }

  /// The images of one exposure with the joint positions of then, before any cycle at that time. Throws Error.
  void take(const control::JointVector& q, const std::vector<Frame>& seen, double exposed_s) {
    if (!history.add(exposed_s, {q.data(), static_cast<std::size_t>(q.size())}) ||
        !update_all(timed, intake.frames(seen)).taken()) {
      fail("timing: the images of ", exposed_s, " s are not taken");
    }
  }

  robot::RobotModel model;
  AvoidanceSettings common;
  Rig rig;
  avoidance::LoopSettings loop_settings;
  robot::JointHistory history;
  robot::FrameIntake intake;
  std::unique_ptr<DistanceEvaluator> evaluator;
  TimedEvaluator timed;
  control::PolygonTask task;
  avoidance::AvoidanceLoop loop;
  RecordedArm arm;
  avoidance::HistoryPort port;
};

}  // namespace

FreeRun run_free(const LoopRecording& recording, Method method, LoopParts parts, const AvoidanceSettings& settings,
                 int snapshots, int cycles, const search::Budget& budget) {
  FreeRun result;
  Parts all(recording, method, parts, settings, budget);
  all.start();
  const bool remembers = method == Method::search_memory;
  const double again_s = remembers ? 2 / kFrameRate_hz : 1.0;
  double now_s = 0;
  for (int i = 0; i < snapshots; ++i) {
    const auto frame = static_cast<std::size_t>(i) * recording.frames() / static_cast<std::size_t>(snapshots);
    const std::int64_t period = recording.period_of(frame);
    for (std::size_t before = std::min(frame, kSeenBefore); remembers && before > 0; --before) {
      now_s += 2 / kFrameRate_hz;
      all.take(recording.joints(recording.period_of(frame - before)), recording.seen(frame - before, now_s), now_s);
    }
    for (int c = 0; c < cycles; ++c) {
      // The frame is used for the next two frame periods, as an image in the loop is, and is then taken anew: time only
      // goes forward.
      const std::int64_t later = c % 32 + 1;
      if (later == 1) {
        now_s += again_s;
        all.take(recording.joints(period), recording.seen(frame, now_s), now_s);
      }
      const double at_s = now_s + recording.period_s() * static_cast<double>(later);
      all.arm.set_period(period + later, at_s);
      const auto begin = Clock::now();
      const double begin_s = lab::processor_time_s();
      const bool done = all.loop.cycle(all.port, at_s);
      result.cycle_s.push_back(lab::processor_time_s() - begin_s);
      result.wall_s += seconds(Clock::now() - begin);
      result.evaluate_s += all.timed.evaluate_s();
      if (!done) {
        fail("timing: the cycle at ", at_s, " s failed");
      }
    }
  }
  return result;
}

PacedRun run_paced(const LoopRecording& recording, LoopParts parts, const AvoidanceSettings& settings,
                   double duration_s, const search::Budget& budget, const std::function<void(double)>& progress) {
  PacedRun result;
  Parts all(recording, recording.method(), parts, settings, budget);
  // The first images are there before the first cycle.
  all.take(recording.joints(recording.period_of(0)), recording.seen(0, -recording.period_s()), -recording.period_s());
  all.start();
  const auto periods = static_cast<std::int64_t>(std::llround(duration_s / recording.period_s()));
  result.periods.resize(static_cast<std::size_t>(periods));
  result.frame_s.reserve(recording.frames() + static_cast<std::size_t>(std::max(0.0, duration_s) * kFrameRate_hz));
  const Clock::time_point begin = Clock::now() + std::chrono::milliseconds(100);
  const auto time_of = [&](std::int64_t period) {
    return begin + ticks(static_cast<double>(period) * recording.period_s());
  };
  std::atomic<bool> taking{false};

  // Stopped and joined, too, when this thread leaves by an exception.
  std::jthread control([&](const std::stop_token& stop) {
    const RealTimePriority priority;
    result.real_time_priority = priority.granted();
    for (std::int64_t k = 0; k < periods && !stop.stop_requested(); ++k) {
      std::this_thread::sleep_until(time_of(k));
      PeriodTimes& times = result.periods[static_cast<std::size_t>(k)];
      const auto start = Clock::now();
      const double processor_s = lab::processor_time_s();
      const double now_s = static_cast<double>(k) * recording.period_s();
      all.arm.set_period(k, now_s);
      const bool done = all.loop.cycle(all.port, now_s);
      times.processor_s = lab::processor_time_s() - processor_s;
      times.took_s = seconds(Clock::now() - start);
      times.late_s = seconds(start - time_of(k));
      times.evaluate_s = all.timed.evaluate_s();
      result.failed_cycles += done ? 0 : 1;
      times.frame_arriving = taking.load(std::memory_order_relaxed);
    }
  });
  // Frames in this thread, as late as the settings say.
  for (std::int64_t k = 0; k < periods; ++k) {
    const auto frame = recording.frame_at(k);
    if (!frame) {
      continue;
    }
    std::this_thread::sleep_until(time_of(k) + ticks(settings.frame_latency_s));
    taking.store(true, std::memory_order_relaxed);
    const auto start = Clock::now();
    const double exposed_s = static_cast<double>(k) * recording.period_s();
    const bool taken = update_all(all.timed, all.intake.frames(recording.seen(*frame, exposed_s))).taken();
    result.frame_s.push_back(seconds(Clock::now() - start));
    taking.store(false, std::memory_order_relaxed);
    result.failed_frames += taken ? 0 : 1;
    progress(exposed_s);
  }
  control.join();
  result.answered = all.timed.answered();
  result.stopped_by_budget = all.timed.stopped_by_budget();
  return result;
}

}  // namespace depthgrid::experiments
