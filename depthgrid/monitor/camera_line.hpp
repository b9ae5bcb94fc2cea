// One camera of a running cell: from its source to the evaluator, in a thread of its own. Internal.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/monitor/cell_answer.hpp"
#include "depthgrid/monitor/event.hpp"
#include "depthgrid/monitor/image_check.hpp"
#include "depthgrid/monitor/recorder.hpp"
#include "depthgrid/monitor/source_counts.hpp"
#include "depthgrid/monitor/time_histogram.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::monitor {

/// Read by any thread, written by the source's.
struct SourceCounters {
  std::atomic<std::int64_t> taken{0};
  std::atomic<std::int64_t> skipped{0};
  std::atomic<std::int64_t> refused{0};
  std::atomic<std::int64_t> dropped{0};
  std::atomic<std::int64_t> opened{0};
  std::atomic<std::int64_t> failures{0};

  [[nodiscard]] SourceCounts now() const noexcept;
};

struct CameraLineSettings {
  std::size_t camera = 0;
  double max_image_age_s = 0.5;
  bool equal_images = false;
};

class CameraLine {
 public:
  /// All but the source outlive it; `intake` may be null: no robot.
  CameraLine(std::unique_ptr<sensors::DepthSource> source, const RigCamera& camera, const CameraLineSettings& settings,
             search::SearchEvaluator& evaluator, robot::FrameIntake* intake);

  /// Images that are used go there, too. Before run().
  void record(Recorder& recorder) noexcept { recorder_ = &recorder; }
  /// Until it is told to stop.
  void run(const std::stop_token& stop) noexcept;

  // For any thread.
  [[nodiscard]] CameraState state() const noexcept { return state_.load(std::memory_order_relaxed); }
  [[nodiscard]] double without_reading() const noexcept { return without_reading_.load(std::memory_order_relaxed); }
  [[nodiscard]] SourceCounts counts() const noexcept { return counters_.now(); }
  /// When the image that is used was there to be asked; NaN: none was.
  [[nodiscard]] double prepared_s() const noexcept { return prepared_s_.load(std::memory_order_relaxed); }
  [[nodiscard]] const TimeHistogram& receipt() const noexcept { return receipt_; }
  [[nodiscard]] const TimeHistogram& preparation() const noexcept { return preparation_; }
  [[nodiscard]] EventQueue& events() noexcept { return events_; }

 private:
  template <class Source, class Reading, class Line>
  friend void follow(Source& source, Reading reading, Line& line, const std::stop_token& stop) noexcept;
  [[nodiscard]] bool open() noexcept;
  void take(const sensors::DepthReading& given) noexcept;
  void has_nothing() noexcept;
  void has_ended() noexcept;
  void has_failed() noexcept;
  [[nodiscard]] bool is_refused(const sensors::DepthReading& reading, bool is_empty) noexcept;
  [[nodiscard]] double share_without_reading(const DepthView& depth) noexcept;
  /// With an event where it is another one than before.
  void set_state(CameraState state, std::string_view why) noexcept;
  void tell(EventKind kind, std::string_view words) noexcept;

  std::unique_ptr<sensors::DepthSource> source_;
  RigCamera camera_;
  CameraLineSettings settings_;
  search::SearchEvaluator& evaluator_;
  robot::FrameIntake* intake_;
  Recorder* recorder_ = nullptr;
  ImageCheck check_;
  DepthImage measured_m_;
  EventQueue events_;
  SourceCounters counters_;
  TimeHistogram receipt_;
  TimeHistogram preparation_;
  double heard_s_ = 0;  ///< when it gave an image last, or was opened
  std::atomic<double> prepared_s_{Proximity::kNaN};
  std::atomic<CameraState> state_{CameraState::opening};
  std::atomic<double> without_reading_{Proximity::kNaN};
};

}  // namespace depthgrid::monitor
