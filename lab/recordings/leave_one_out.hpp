// What one camera measures, asked of a search that knows the other cameras alone: a measured surface must not lie in
// space that the others report free.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/search/search.hpp"
#include "lab/recordings/margin_settings.hpp"

namespace depthgrid::lab {

inline constexpr double kLeaveOneOutRho_m = 0.5;
inline constexpr double kLeaveOneOutResolution_m = 0.005;
inline constexpr double kProbe_m = 0.3;

/// One reading of the camera that was left out.
struct LeftOutReading {
  int u = 0;
  int v = 0;
  float depth_m = 0;
  Eigen::Vector3d p_world;
  double answer_m = 0;     ///< the others' distance at p_world, at most kLeaveOneOutRho_m
  double allowance_m = 0;  ///< see allowance_m()
  /// The camera that reports p_world free by most (slot), its pixel there and how far it measures beyond p_world; -1
  /// where none does, so that the answer is small.
  int known_free_by = -1;
  int known_free_u = 0;
  int known_free_v = 0;
  double gap_m = 0;
  /// The others' distance at the point kProbe_m before the reading on its ray, where the left-out camera sees free
  /// space.
  double before_m = 0;

  [[nodiscard]] bool violates() const { return answer_m > allowance_m; }
};

/// How far the others may report a surface free that the left-out camera measured at depth D at x:
///   r + m(D) |x - c| / D + e_t + e_R |x - c| + v_max (half exposure + time uncertainty)
/// with r the resolution, m the sensor's margin along the ray, and all errors those of the left-out camera. The others'
/// own errors are in their answers already.
[[nodiscard]] double allowance_m(const CameraMargins& left_out, double v_max_m_s, double depth_m, double range_m);

/// The cameras that are asked. W is a box of 20 m around the world's origin; uncovered space counts as obstacle.
class LeaveOneOut {
 public:
  /// Margins in the order of `asked`. Throws Error as ViewStore.
  LeaveOneOut(const Rig& asked, const std::vector<CameraMargins>& margins, double v_max_m_s);

  void update(std::size_t slot, const Frame& frame, const Pose& T_world_camera);

  /// Every `stride`-th reading of every `stride`-th row that lies where at least one of the others looks.
  [[nodiscard]] std::vector<LeftOutReading> check(const RigCamera& left_out, const CameraMargins& margins,
                                                  const DepthImage& depth, int stride);

  [[nodiscard]] std::size_t camera_count() const noexcept { return store_.rig().cameras.size(); }
  [[nodiscard]] const std::string& id(std::size_t slot) const { return store_.rig().cameras[slot].id; }
  /// The measured image of a camera that is asked.
  [[nodiscard]] DepthImage measured(std::size_t slot) const;

 private:
  views::Settings settings_;
  views::ViewStore store_;
  search::Search search_;
};

}  // namespace depthgrid::lab
