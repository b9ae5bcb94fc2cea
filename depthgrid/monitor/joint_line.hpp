// The joints of a running cell: from their source into the history, in a thread of their own. Internal.
#pragma once

#include <atomic>
#include <memory>
#include <stop_token>
#include <string_view>

#include "depthgrid/monitor/camera_line.hpp"
#include "depthgrid/monitor/event.hpp"
#include "depthgrid/robot/joint_history.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::monitor {

/// Samples that are kept of the joints: two seconds at 1 kHz.
inline constexpr std::size_t kJointSamples = 2000;

class JointLine {
 public:
  /// The history outlives it, and nobody else adds to it.
  JointLine(std::unique_ptr<sensors::JointSource> source, robot::JointHistory& history, double max_age_s)
      : source_(std::move(source)), history_(history), max_age_s_(max_age_s) {}

  /// States that are used go there, too. Before run().
  void record(Recorder& recorder) noexcept { recorder_ = &recorder; }
  void run(const std::stop_token& stop) noexcept;

  // For any thread.
  /// Of the newest state; NaN: none so far.
  [[nodiscard]] double newest_s() const noexcept { return newest_s_.load(std::memory_order_relaxed); }
  [[nodiscard]] SourceCounts counts() const noexcept { return counters_.now(); }
  [[nodiscard]] EventQueue& events() noexcept { return events_; }

 private:
  template <class Source, class Reading, class Line>
  friend void follow(Source& source, Reading reading, Line& line, const std::stop_token& stop) noexcept;
  [[nodiscard]] bool open() noexcept;
  void take(const sensors::JointReading& reading) noexcept;
  void has_nothing() noexcept {}  // their age says it
  void has_ended() noexcept;
  void has_failed() noexcept;
  void tell(EventKind kind, std::string_view words) noexcept;

  std::unique_ptr<sensors::JointSource> source_;
  robot::JointHistory& history_;
  double max_age_s_;
  Recorder* recorder_ = nullptr;
  bool refusing_ = false;
  bool has_ended_ = false;
  EventQueue events_;
  SourceCounters counters_;
  std::atomic<double> newest_s_{Proximity::kNaN};
};

}  // namespace depthgrid::monitor
