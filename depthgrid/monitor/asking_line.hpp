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
#include "depthgrid/monitor/joint_line.hpp"
#include "depthgrid/monitor/time_histogram.hpp"
#include "depthgrid/robot/joint_history.hpp"
#include "depthgrid/search/search_evaluator.hpp"

namespace depthgrid::monitor {

struct AskingHistograms {
  TimeHistogram exposure_to_answer;
  TimeHistogram asking;
  TimeHistogram period;
  TimeHistogram skew;
  std::array<TimeHistogram, views::kMaxCameras> image_age;
};

/// - Threads: ask() belongs to one. The counters are for any.
/// - ask() locks, allocates and throws nothing.
class AskingLine {
 public:
  /// All that is handed over outlives it; history and joints are null without a robot.
  AskingLine(const cell::CellSetup& setup, double stop_m, search::SearchEvaluator& evaluator,
             const robot::JointHistory* history, const JointLine* joints,
             const std::vector<std::unique_ptr<CameraLine>>& cameras);

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
  /// How far each joint may be from q_ at now_s, into moved_.
  void bound_motion(double now_s, double hold_s) noexcept;
  void look_at_cameras() noexcept;
  void find_reason(bool placed) noexcept;
  void note(bool was_stopped) noexcept;

  std::optional<robot::PlacedRobot> robot_;
  std::vector<cell::AskedPart> asked_;
  std::vector<robot::LinkCapsule> links_;  ///< of the parts on the robot, in their order
  double max_image_age_s_;
  search::SearchEvaluator& evaluator_;
  const robot::JointHistory* history_;
  const JointLine* joints_;
  const std::vector<std::unique_ptr<CameraLine>>& cameras_;
  std::vector<double> q_;
  double time_error_s_;  ///< between the joints' clock and ours
  std::vector<double> speeds_;
  std::vector<double> accelerations_;  ///< infinite where not declared
  std::vector<double> window_;         ///< how far each joint may be, by the samples
  std::vector<double> moved_;          ///< and by all that is known
  std::vector<Pose> T_world_link_;
  std::vector<Capsule> links_world_;
  std::vector<double> motion_m_;
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
