// The asking of a running cell: one question to all parts, and what its answer stands on. Internal.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/monitor/camera_line.hpp"
#include "depthgrid/monitor/cell_answer.hpp"
#include "depthgrid/monitor/event.hpp"
#include "depthgrid/monitor/part_places.hpp"
#include "depthgrid/monitor/stop_hold.hpp"
#include "depthgrid/monitor/time_histogram.hpp"
#include "depthgrid/robot/joint_history.hpp"
#include "depthgrid/search/search_evaluator.hpp"

namespace depthgrid::monitor {

struct AskingHistograms {
  TimeHistogram exposure_to_answer;
  TimeHistogram asking;
  TimeHistogram period;
  TimeHistogram skew;
  TimeHistogram hand_over;
  std::array<TimeHistogram, views::kMaxCameras> image_age;
};

struct StopRule {
  double stop_m = 0;  ///< MonitorSettings::stop_m, and hold_s
  double hold_s = 0;
};

/// - Threads: ask() belongs to one. The counters are for any.
/// - ask() locks, allocates and throws nothing.
class AskingLine {
 public:
  /// All that is handed over outlives it; the history is null without a robot.
  AskingLine(const cell::CellSetup& setup, const StopRule& rule, search::SearchEvaluator& evaluator,
             const robot::JointHistory* history, const std::vector<std::unique_ptr<CameraLine>>& cameras);

  /// At time now_s, which goes on from call to call.
  const CellAnswer& ask(double now_s) noexcept;

  /// An answer of the final size, for those who copy one.
  [[nodiscard]] const CellAnswer& answer() const noexcept { return answer_; }

  [[nodiscard]] EventQueue& events() noexcept { return events_; }
  [[nodiscard]] const EventQueue& events() const noexcept { return events_; }
  [[nodiscard]] const AskingHistograms& histograms() const noexcept { return histograms_; }
  [[nodiscard]] std::uint64_t stops() const noexcept { return stops_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t stopped() const noexcept { return stopped_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t answers() const noexcept { return answers_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t of_state(std::size_t limit) const noexcept {
    return by_state_.at(limit).load(std::memory_order_relaxed);
  }

 private:
  /// False: nobody knows where the robot is.
  [[nodiscard]] bool place_parts(double now_s) noexcept;
  void look_at_cameras() noexcept;
  /// Keeps where the parts were, for the speeds.
  void remember_parts(bool placed) noexcept;
  /// NaN where it is not known how it moved.
  [[nodiscard]] double speed_m_s(std::size_t part) const noexcept;
  void find_reason(bool placed) noexcept;
  /// A stop goes on until all was clear for a while, so that nothing moves in jerks.
  void hold_stop() noexcept;
  void note(bool was_stopped) noexcept;

  PartPlaces places_;
  bool has_robot_;
  StopHold hold_;
  double max_image_age_s_;
  search::SearchEvaluator& evaluator_;
  const robot::JointHistory* history_;
  const std::vector<std::unique_ptr<CameraLine>>& cameras_;
  struct PlacesAtTime {
    double time_s = Proximity::kNaN;
    std::vector<Capsule> parts_world;
  };
  PlacesAtTime newer_;  ///< less than 0.1 s old
  PlacesAtTime older_;  ///< less than 0.2 s
  CellAnswer answer_;
  bool has_asked_ = false;
  EventQueue events_;
  AskingHistograms histograms_;
  std::atomic<std::uint64_t> answers_{0};
  std::atomic<std::uint64_t> stops_{0};
  std::atomic<std::uint64_t> stopped_{0};
  std::array<std::atomic<std::uint64_t>, 8> by_state_{};
};

}  // namespace depthgrid::monitor
