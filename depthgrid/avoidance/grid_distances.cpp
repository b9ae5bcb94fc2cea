#include "depthgrid/avoidance/grid_distances.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::avoidance {

GridDistances::GridDistances(const Rig& rig, const GridDistancesSettings& settings)
    : rig_(rig),
      robot_pixels_(settings.robot_pixels),
      evaluator_(rig, settings.principal, settings.cells, settings.evaluation) {
  beyond_m_ = evaluator_.grid().d_max_m() + 2 * settings.evaluation.rho_m;
  for (const RigCamera& camera : rig.cameras) {
    beyond_m_ = std::isfinite(camera.rule.far_m) ? std::min(beyond_m_, camera.rule.far_m) : beyond_m_;
    depth_m_.emplace_back(camera.intrinsics.width_px, camera.intrinsics.height_px);
  }
  frames_.resize(rig.cameras.size());
}

Frame GridDistances::without_robot(std::size_t camera, const Frame& frame) noexcept {
  DepthImage& depth_m = depth_m_[camera];
  const bool usable = frame.depth.data != nullptr && frame.depth.width_px == depth_m.width_px() &&
                      frame.depth.height_px == depth_m.height_px();
  if (robot_pixels_ == RobotPixels::case_iv || !usable || frame.robot.near_m == nullptr ||
      frame.robot.far_m == nullptr) {
    return frame;
  }
  normalise(frame.depth, rig_.cameras[camera].rule, depth_m);
  const std::ptrdiff_t stride_px = frame.robot.stride_px != 0 ? frame.robot.stride_px : depth_m.width_px();
  for (int v = 0; v < depth_m.height_px(); ++v) {
    for (int u = 0; u < depth_m.width_px(); ++u) {
      const std::ptrdiff_t at = v * stride_px + u;
      float& reading_m = depth_m.at(u, v);
      if (frame.robot.near_m[at] > 0 && frame.robot.near_m[at] <= reading_m && reading_m <= frame.robot.far_m[at]) {
        reading_m = static_cast<float>(beyond_m_);
      }
    }
  }
  Frame result;
  result.depth = {depth_m.data(),
                  DepthFormat::float32_metres,
                  depth_m.width_px(),
                  depth_m.height_px(),
                  static_cast<std::ptrdiff_t>(sizeof(float)) * depth_m.width_px(),
                  frame.depth.metres_per_unit};
  result.time_s = frame.time_s;
  return result;
}

bool GridDistances::take(std::span<const Frame> frames) noexcept {
  std::fill(frames_.begin(), frames_.end(), Frame{});
  for (std::size_t k = 0; k < std::min(frames.size(), frames_.size()); ++k) {
    frames_[k] = without_robot(k, frames[k]);
  }
  return evaluator_.update(frames_);
}

void GridDistances::evaluate(std::span<const Capsule> parts_world, double /*now_s*/,
                             std::span<PartAnswer> answers) noexcept {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const grid::Evaluation found = evaluator_.evaluate(parts_world[i].a);
    answers[i] = {found.nearest, control::obstacle_of(found.nearest, found.hybrid_direction_world), parts_world[i].a};
  }
}

}  // namespace depthgrid::avoidance
