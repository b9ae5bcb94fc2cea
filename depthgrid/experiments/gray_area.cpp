#include "depthgrid/experiments/gray_area.hpp"

#include <algorithm>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/experiments/distance_method.hpp"
#include "depthgrid/report/free_space_slice.hpp"
#include "depthgrid/simulation/scene.hpp"

namespace depthgrid::experiments {

namespace {

std::vector<DepthImage> free_depths(const CameraImages& images) {
  std::vector<DepthImage> free_m;
  for (std::size_t k = 0; k < images.rig().cameras.size(); ++k) {
    const DepthImage& depth_m = images.depth_m(k);
    FreeDepth free(depth_m.width_px(), depth_m.height_px(), images.rig().cameras[k].margins->sensor);
    free.update(depth_m, images.frames()[k].robot);
    free_m.push_back(free.image());
  }
  return free_m;
}

double ratio(std::size_t part, std::size_t whole) noexcept {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void GrayArea::add(const GrayArea& other) noexcept {
  empty += other.empty;
  gray += other.gray;
  empty_near += other.empty_near;
  gray_near += other.gray_near;
}
double GrayArea::share() const noexcept { return ratio(gray, empty); }
double GrayArea::share_near() const noexcept { return ratio(gray_near, empty_near); }

GrayArea gray_area(const StagedCell& stage, const CameraImages& images, const simulation::Arrangement& arrangement,
                   double spacing_m) {
  if (!(spacing_m > 0)) {
    fail("gray area: spacing is ", spacing_m, " m, must be positive");
  }
  const std::vector<DepthImage> free_m = free_depths(images);
  const simulation::Scene scene = simulation::scene_of(stage.cell());
  const Eigen::Vector3d& low = arrangement.workspace_low_world;
  const Eigen::Vector3d& high = arrangement.workspace_high_world;
  GrayArea result;
  for (double x = low.x() + 0.5 * spacing_m; x < high.x(); x += spacing_m) {
    for (double y = low.y() + 0.5 * spacing_m; y < high.y(); y += spacing_m) {
      for (double z = low.z() + 0.5 * spacing_m; z < high.z(); z += spacing_m) {
        const Eigen::Vector3d p_world(x, y, z);
        if (scene.contains(p_world, simulation::Body::obstacle) || scene.contains(p_world, simulation::Body::robot)) {
          continue;
        }
        bool seen_free = false;
        for (std::size_t k = 0; k < free_m.size() && !seen_free; ++k) {
          seen_free = report::sees_past(images.rig().cameras[k], free_m[k], p_world);
        }
        const auto points = stage.arm().points_world();
        const bool near_arm = std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
          return (point - p_world).norm() < DistanceMethod::kRho;
        });
        result.add({1, seen_free ? 0U : 1U, near_arm ? 1U : 0U, near_arm && !seen_free ? 1U : 0U});
      }
    }
  }
  return result;
}

}  // namespace depthgrid::experiments
