// A running cell: images and joint states in, answers at a fixed rate out, whatever fails meanwhile.
//
//   sources, a thread each -> prepared images -> asking, at a fixed rate -> outputs, a thread each
//
// None waits for another. Queues hold the newest, and what is passed over is counted.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/monitor/cell_answer.hpp"
#include "depthgrid/monitor/event.hpp"
#include "depthgrid/monitor/recorder.hpp"
#include "depthgrid/monitor/source_counts.hpp"
#include "depthgrid/monitor/time_histogram.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::monitor {

/// What becomes of answers: a datagram, a line, what a program does with them.
/// - Threads: take() is called by one thread, its own. It may wait; then it gets the newest answer, and the sequence
///   numbers show how many it passed over.
class Output {
 public:
  Output() = default;
  virtual ~Output() = default;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  virtual void take(const CellAnswer& answer) = 0;
};

/// An Output that calls a function.
[[nodiscard]] std::unique_ptr<Output> call(std::function<void(const CellAnswer&)> function);

struct Sources {
  std::vector<std::unique_ptr<sensors::DepthSource>> cameras;  ///< in the rig's order
  std::unique_ptr<sensors::JointSource> joints{};              ///< null without a robot
};

struct MonitorSettings {
  double rate_hz = 500;
  double stop_m = 0;  ///< clear distances that are not above it say stop
  double hold_s = 0;  ///< answers say stop until none would have for so long
  double max_joints_age_s = 0.1;
  std::vector<bool> equal_images{};  ///< a camera each: the same pixels twice are no failure; empty: they are one
};

/// What was counted since the start.
struct MonitorReport {
  double seconds = 0;
  std::uint64_t answers = 0;
  std::uint64_t stopped = 0;                ///< of the answers, how many say stop
  std::uint64_t stops = 0;                  ///< how often it came to that
  std::array<std::uint64_t, 8> by_state{};  ///< answers by avoidance::MotionLimit
  double longest_period_s = 0;              ///< between two questions, the worst
  std::uint64_t late_questions = 0;         ///< that began more than a period late
  std::vector<SourceCounts> cameras;
  SourceCounts joints;
  std::vector<std::uint64_t> passed_over;  ///< answers that an output did not get, one an output
  std::uint64_t events_dropped = 0;
  std::optional<RecorderCounts> recorded{};
};

class Monitor {
 public:
  /// Throws Error where setup or settings do not fit together. `sources` has one a camera.
  Monitor(const cell::CellSetup& setup, const MonitorSettings& settings, Sources sources);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  /// Before start().
  void add(std::unique_ptr<Output> output);
  /// Before start(): everything that is used, answered and said is recorded. `recorder`: of this cell's rig and names.
  void record(std::unique_ptr<Recorder> recorder);

  /// Once. Throws std::system_error where there are no threads.
  void start();
  /// Ends all threads; returns within a tenth of a second after the slowest output. Nothing happens a second time.
  void stop() noexcept;

  /// The newest answer, when it is newer than the one before. For one thread.
  [[nodiscard]] bool newest(CellAnswer& answer) noexcept;
  /// What happened since the last call, in the order of time. For one thread.
  [[nodiscard]] std::vector<Event> events();

  [[nodiscard]] const Names& names() const noexcept;
  [[nodiscard]] MonitorReport report() const;
  /// From the newest exposure to the first answer that stands on it.
  [[nodiscard]] const TimeHistogram& exposure_to_answer() const noexcept;
  /// What one question takes.
  [[nodiscard]] const TimeHistogram& asking() const noexcept;
  /// Between the beginnings of two questions.
  [[nodiscard]] const TimeHistogram& period() const noexcept;
  /// Between the oldest and the newest image of each answer.
  [[nodiscard]] const TimeHistogram& skew() const noexcept;
  /// Of the camera's image, at every question.
  [[nodiscard]] const TimeHistogram& image_age(std::size_t camera) const;
  /// From the middle of the camera's exposure to the image at hand, of those that are used.
  [[nodiscard]] const TimeHistogram& receipt(std::size_t camera) const;
  /// From the image at hand to the image that can be asked.
  [[nodiscard]] const TimeHistogram& preparation(std::size_t camera) const;
  /// From an image that can be asked to the question that asks it, of all cameras.
  [[nodiscard]] const TimeHistogram& hand_over() const noexcept;
  /// From an answer to its output's being done with it; outputs in the order in which they were added.
  [[nodiscard]] const TimeHistogram& sending(std::size_t output) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// An event as one line, with the names: "left: lost: ...", "stop: lwr_5_link is ...".
[[nodiscard]] std::string event_line(const Event& event, const Names& names);

}  // namespace depthgrid::monitor
