#include "program/run/run_command.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/monitor/cell_recording.hpp"
#include "depthgrid/monitor/open_cell.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "program/interruption.hpp"
#include "program/run/json_lines.hpp"
#include "program/run/records.hpp"
#include "program/run/run_text.hpp"
#include "program/usage_error.hpp"
#include "program/warning.hpp"
#include "report/number_text.hpp"

namespace depthgrid::program {
namespace {

/// Between two looks at what happened.
constexpr double kLook_s = 0.1;
/// Between two lines where nobody sees them change.
constexpr double kLine_s = 1.0;
constexpr std::size_t kToldStops = 10;
/// Lines about events a second: a cell that flutters must not flood the log.
constexpr int kMostLines = 10;

struct RunOptions {
  std::string cell;
  std::string record;
  std::optional<double> seconds;
  bool again = false;
};

/// The lines on the terminal: one that changes, or one a second; and one an event.
class Teller {
 public:
  Teller(bool shows_status, const monitor::Names& names)
      : shows_status_(shows_status), is_terminal_(::isatty(STDERR_FILENO) == 1), names_(names) {}

  void event(const monitor::Event& event, double begin_s) {
    const std::string line = time_text(event.time_s - begin_s) + printable(monitor::event_line(event, names_));
    if (event.kind == monitor::EventKind::stop) {
      stops_.push_back(line);
      if (stops_.size() > kToldStops) {
        stops_.pop_front();
      }
    }
    const auto second = static_cast<std::int64_t>(event.time_s - begin_s);
    lines_ = second == second_ ? lines_ + 1 : 1;
    second_ = second;
    if (lines_ <= kMostLines) {
      print(line);
    } else if (lines_ == kMostLines + 1) {
      print("           more than " + std::to_string(kMostLines) + " events in this second, the others are not told");
    }
  }

  void status(const monitor::CellAnswer& answer, double begin_s) {
    const double now_s = answer.time_s - begin_s;
    if (!shows_status_ || (!is_terminal_ && now_s < next_s_)) {
      return;
    }
    next_s_ = now_s + kLine_s;
    std::string line = time_text(now_s) + printable(status_line(answer, names_));
    if (is_terminal_) {
      constexpr std::size_t kWidest = 160;
      (void)std::fputs(("\r\033[K" + line.substr(0, kWidest)).c_str(), stderr);
      (void)std::fflush(stderr);
      has_status_ = true;
    } else {
      print(line);
    }
  }

  void end() const {
    if (has_status_) {
      (void)std::fputs("\r\033[K", stderr);
    }
  }
  [[nodiscard]] std::vector<std::string> stops() const { return {stops_.begin(), stops_.end()}; }

 private:
  static std::string time_text(double seconds) {
    constexpr std::size_t kWide = 8;
    const std::string text = report::fixed(seconds, 3);
    return std::string(kWide - std::min(text.size(), kWide), ' ') + text + " s  ";
  }
  void print(const std::string& line) {
    (void)std::fputs(((has_status_ ? "\r\033[K" : "") + line + "\n").c_str(), stderr);
    has_status_ = false;
  }

  bool shows_status_;
  bool is_terminal_;
  const monitor::Names& names_;
  bool has_status_ = false;
  double next_s_ = 0;
  std::int64_t second_ = -1;
  int lines_ = 0;
  std::deque<std::string> stops_;
};

/// Of a recording that is played: no camera has another image.
bool is_over(const monitor::CellAnswer& answer) {
  const auto* const end = answer.cameras.begin() + answer.camera_count;
  return answer.camera_count > 0 && std::all_of(answer.cameras.begin(), end, [](const monitor::CameraBasis& camera) {
           return camera.state == monitor::CameraState::ended;
         });
}

bool is_recording(const RunOptions& options) { return std::filesystem::path(options.cell).extension() == ".mcap"; }

void told_damage(const std::string& file, const monitor::CellRecording& recording) {
  if (const std::string damage = recording.damage(); !damage.empty()) {
    warn(file + ": " + damage);
  }
}

void ask_again(const std::string& file) {
  monitor::CellRecording recording(file);
  told_damage(file, recording);
  const cell::Cell cell = recording.cell();
  const monitor::AskedAgain again = recording.ask_again(cell, cell::setup(cell));
  std::string text = std::to_string(again.answers) + " answers, " + std::to_string(again.equal) +
                     " are the same to the bit when they are asked again, " + std::to_string(again.differ) + " differ";
  if (again.without_images + again.without_joints > 0) {
    text += "; of " + std::to_string(again.without_images) + " an image, of " + std::to_string(again.without_joints) +
            " a joint state is not in the recording";
  }
  (void)std::fputs((text + "\n").c_str(), stdout);
  if (again.differ > 0) {
    fail(file, ": ", again.first_difference);
  }
  if (again.equal == 0) {
    fail(file, ": no answer could be asked again");
  }
}

/// Of the file, or of the recording, which then stands in place of cameras and joints.
cell::Cell cell_of(const RunOptions& options, const std::optional<monitor::CellRecording>& recording) {
  cell::Cell cell = recording ? recording->played() : cell::load_cell(options.cell);
  if (!options.record.empty()) {
    if (!cell.outputs.record.empty()) {
      warn("--record " + options.record + " in place of " + cell.outputs.record.string() + " of the cell file");
    }
    cell.outputs.record = options.record;
  }
  return cell;
}

/// What each is called.
std::vector<std::string> add_outputs(const cell::Cell& cell, const cell::CellSetup& setup,
                                     const std::shared_ptr<dds::Node>& ros2,
                                     const std::shared_ptr<std::atomic<bool>>& lines_failed,
                                     monitor::Monitor& monitor) {
  std::vector<std::string> outputs;
  if (cell.outputs.udp) {
    monitor.add(monitor::udp_output(*cell.outputs.udp));
    outputs.push_back("udp " + cell.outputs.udp->host + " port " + std::to_string(cell.outputs.udp->port));
  }
  if (cell.outputs.ros2) {
    monitor.add(monitor::ros2_output(cell, setup, monitor.names(), ros2));
    outputs.push_back("ROS 2 node " + cell.ros2.node + ", domain " + std::to_string(cell.ros2.domain));
  }
  if (!cell.outputs.jsonl.empty()) {
    monitor.add(json_lines(cell.outputs.jsonl, monitor.names(), lines_failed));
    outputs.push_back(cell.outputs.jsonl.string());
  }
  return outputs;
}

void run_cell(const RunOptions& options) {
  std::optional<monitor::CellRecording> recording;
  if (is_recording(options)) {
    recording.emplace(options.cell);
    told_damage(options.cell, *recording);
  }
  const cell::Cell cell = cell_of(options, recording);
  // Of a recording the calibration and margins are those that it ran with.
  const cell::CellSetup setup = cell::setup(recording ? recording->cell() : cell);
  if (recording) {
    warn(options.cell + ": is played; of the cell's outputs none but the terminal");
  } else {
    for (const std::string& line : cell::implausible(cell, setup)) {
      warn(line);
    }
  }
  const auto ros2 = monitor::ros2_node(cell);
  monitor::Monitor monitor(setup, monitor::monitor_settings(cell), monitor::make_sources(cell, setup, ros2));
  const auto lines_failed = std::make_shared<std::atomic<bool>>(false);
  const std::vector<std::string> outputs = add_outputs(cell, setup, ros2, lines_failed, monitor);
  Records records(cell, setup, monitor);
  if (!cell.outputs.record.empty()) {  // last: where another output cannot be written no recording is left behind
    monitor.record(monitor::recorder(cell, setup, monitor.names()));
  }
  Teller teller(cell.outputs.terminal, monitor.names());
  ask_before_the_end();
  const double begin_s = sensors::clock_now_s();
  monitor.start();
  monitor::CellAnswer answer;
  while (!stop_is_asked() && !(recording && is_over(answer)) &&
         !(options.seconds && sensors::clock_now_s() - begin_s >= *options.seconds)) {
    (void)sensors::wait_until(options.seconds ? begin_s + *options.seconds : begin_s + 1e9, kLook_s);
    for (const monitor::Event& event : monitor.events()) {
      teller.event(event, begin_s);
      records.event(event);
    }
    if (monitor.newest(answer)) {
      teller.status(answer, begin_s);
    }
    records.look(answer);
  }
  monitor.stop();
  for (const monitor::Event& event : monitor.events()) {
    teller.event(event, begin_s);
    records.event(event);
  }
  (void)monitor.newest(answer);
  records.end(answer);
  teller.end();
  std::FILE* const out = cell.outputs.jsonl.filename() == "-" ? stderr : stdout;
  (void)std::fputs(summary(monitor, outputs, teller.stops()).c_str(), out);
  const auto recorded = monitor.report().recorded;
  if (recorded && recorded->failed) {
    fail("the recording is not whole, as was said above");
  }
  if (*lines_failed || records.has_failed()) {
    fail("an output could not be written, as was said above");
  }
}

void run(const RunOptions& options) {
  if (options.seconds && !(*options.seconds > 0)) {
    fail_usage("--seconds ", *options.seconds, ": must be above 0");
  }
  if (options.again && (options.seconds || !options.record.empty())) {
    fail_usage("--again asks what was recorded, all of it: ", options.seconds ? "--seconds" : "--record",
               " says nothing beside it");
  }
  if (!options.again) {
    run_cell(options);
  } else if (is_recording(options)) {
    ask_again(options.cell);
  } else {
    fail_usage("--again asks the answers of a recording: depthgrid run FILE.mcap --again");
  }
}

}  // namespace

void add_run_command(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App& command = *app.add_subcommand("run", "distances of a robot cell, live: cameras and joints in, answers out");
  command
      .add_option("CELL", options->cell,
                  "the cell file (depthgrid cell new writes one), or a recording of one, FILE.mcap")
      ->required();
  command.add_option("--record", options->record,
                     "makes this MCAP file: images, joint states, answers and events, as ROS 2 records them");
  command.add_flag(
      "--again", options->again,
      "of a recording: asks each recorded answer again, and says whether the parts' numbers are the same to the bit");
  command.add_option("--seconds", options->seconds, "ends after this many seconds (default: Ctrl-C ends it)");
  command.footer(
      "Reads the cell file, opens its cameras and joints, and answers at a fixed rate how far the robot's links are "
      "from what\n"
      "is not known free, whatever fails meanwhile; then it says why. Ctrl-C ends it with a summary. docs/run.md says "
      "more.");
  command.callback([options] { run(*options); });
}

}  // namespace depthgrid::program
