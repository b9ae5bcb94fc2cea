#include "lab/experiments/cameras/gray_area.hpp"

#include <algorithm>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "lab/experiments/stage/distance_method.hpp"
#include "report/free_space_slice.hpp"

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

struct Sampler {
  const StagedCell& stage;
  const CameraImages& images;
  simulation::Scene scene;
  std::vector<DepthImage> free_m;

  [[nodiscard]] bool seen_free(const Eigen::Vector3d& p_world) const {
    for (std::size_t k = 0; k < free_m.size(); ++k) {
      if (report::sees_past(images.rig().cameras[k], free_m[k], p_world)) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool near_arm(const Eigen::Vector3d& p_world) const {
    const auto points = stage.arm().points_world();
    return std::any_of(points.begin(), points.end(),
                       [&](const Eigen::Vector3d& point) { return (point - p_world).norm() < DistanceMethod::kRho; });
  }

  /// One point's counts; none where it lies in a body.
  [[nodiscard]] GrayArea at(const Eigen::Vector3d& p_world) const {
    if (scene.contains(p_world, simulation::Body::obstacle) || scene.contains(p_world, simulation::Body::robot)) {
      return {};
    }
    const std::size_t gray = seen_free(p_world) ? 0 : 1;
    const std::size_t close = near_arm(p_world) ? 1 : 0;
    return {1, gray, close, close * gray};
  }
};

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
  const Sampler sampler{stage, images, simulation::scene_of(stage.cell()), free_depths(images)};
  const Eigen::Vector3d& low = arrangement.workspace_low_world;
  const Eigen::Array3d size = (arrangement.workspace_high_world - low).array();
  const Eigen::Array3i count = (size / spacing_m).round().cast<int>();
  GrayArea result;
  for (int i = 0; i < count.prod(); ++i) {
    const Eigen::Array3i index(i % count.x(), i / count.x() % count.y(), i / count.x() / count.y());
    result.add(sampler.at(low + spacing_m * (index.cast<double>() + 0.5).matrix()));
  }
  return result;
}

}  // namespace depthgrid::experiments
