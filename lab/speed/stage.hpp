// What all competitors are asked: the same frames, the same points, and the oracle's intervals for them.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "lab/peers/peer.hpp"
#include "lab/workload/workload.hpp"
#include "lab/workload/workload_noise.hpp"
#include "reference/reference.hpp"

namespace depthgrid::lab {

/// The space of interest of all comparisons, inside the room: 3 x 3 x 2 m.
[[nodiscard]] Region workload_cell();

inline constexpr double kRho = 0.4;
inline constexpr int kSubSteps = 16;  ///< queries between two frame sets: 480 a second

/// One number of cameras on one workload. Truths and special points are computed when first asked for.
class Stage {
 public:
  /// The first `cameras` cameras. With `noisy` the frames are those; the truth is that of the clean ones.
  Stage(const Workload& clean, const NoisyWorkload* noisy, int cameras);

  [[nodiscard]] int cameras() const { return cameras_; }
  [[nodiscard]] int frame_sets() const { return clean_.frame_sets(); }
  [[nodiscard]] const Rig& rig() const { return rig_; }
  [[nodiscard]] std::span<const Frame> frames(int set) const;
  /// For all peers: ideal sensor.
  [[nodiscard]] PeerSetting setting() const;

  /// Nine control points at a sub-step after the frame set.
  [[nodiscard]] std::vector<Eigen::Vector3d> points(int set, int sub_step) const;
  /// The box around all control points of the whole run and of random_workload_points(), grown by rho.
  [[nodiscard]] const Region& arm_region() const { return arm_region_; }

  /// Bounds of the distance, for points(set, sub_step): ideal sensor, clean images; hi is rho where nothing is nearer.
  struct Truth {
    double lo_m = 0;
    double hi_m = 0;
  };
  [[nodiscard]] const std::vector<Truth>& truths(int set, int sub_step);

  /// Nine points near each other in free space, with nothing within rho; and nine that lie at least 0.1 m deep in space
  /// that no camera sees free. Fewer where there are none.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& far_points(int set);
  [[nodiscard]] const std::vector<Eigen::Vector3d>& deep_points(int set);

  /// The oracle for these margins, on the frames that the peers get or on the clean ones.
  [[nodiscard]] std::unique_ptr<reference::Reference> oracle(int set, const SensorMargin& sensor,
                                                             const PoseMargin& pose, bool clean) const;

 private:
  [[nodiscard]] const reference::Reference& truth_oracle(int set);

  const Workload& clean_;
  const NoisyWorkload* noisy_;
  int cameras_;
  Rig rig_;
  Region arm_region_;
  std::pair<int, std::unique_ptr<reference::Reference>> oracle_{-1, nullptr};
  std::map<std::pair<int, int>, std::vector<Truth>> truths_;
  std::map<int, std::vector<Eigen::Vector3d>> far_points_, deep_points_;
};

/// The smallest box around the points, grown by rho.
[[nodiscard]] Region region_of(std::span<const Eigen::Vector3d> points_world);

}  // namespace depthgrid::lab
