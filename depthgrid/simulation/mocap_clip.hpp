// A recorded human motion as moving capsules.
#pragma once

#include <filesystem>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/simulation/mocap_skeleton.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::simulation {

/// Const members may be called from many threads at once.
class MocapClip {
 public:
  /// One capsule a bone, as thick as an adult's. `rate_hz` is that of the recording. Throws Error on a rate that is not
  /// positive or a frame of another skeleton.
  MocapClip(const MocapSkeleton& skeleton, const std::vector<MocapFrame>& frames, double rate_hz = 120);

  /// Throws Error that names the file, the line and the rule.
  [[nodiscard]] static MocapClip load(const std::filesystem::path& asf, const std::filesystem::path& amc,
                                      double rate_hz = 120);

  /// The body at a time, in the frame `T_world_floor` maps from: z up, z = 0 on the recording's floor. Between two
  /// frames the ends move straight. Before 0 as at 0, after duration_s() as then.
  [[nodiscard]] std::vector<Capsule> at(double time_s, const Pose& T_world_floor = Pose::Identity()) const;

  [[nodiscard]] double duration_s() const noexcept;
  [[nodiscard]] std::size_t frames() const noexcept { return frames_.size(); }

  /// No end of a capsule's axis moves faster, and so no point of the surface, taken as a set.
  [[nodiscard]] double v_max_m_s() const noexcept { return v_max_m_s_; }

  /// The middle of the body's path over the floor, z up.
  [[nodiscard]] Eigen::Vector3d middle_m() const noexcept;

 private:
  double rate_hz_;
  double v_max_m_s_ = 0;
  std::vector<std::vector<Capsule>> frames_;  ///< z up
};

}  // namespace depthgrid::simulation
