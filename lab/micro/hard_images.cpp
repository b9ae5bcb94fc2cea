#include "lab/micro/hard_images.hpp"

#include <span>

#include "lab/workload/workload.hpp"

namespace depthgrid::lab {

views::Settings hard_settings(int cameras, double pose_error_m) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.5, -1.5, 0.0}, {1.5, 1.5, 2.0}};
  settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0};
  settings.margins.resize(static_cast<std::size_t>(cameras));
  for (auto& margins : settings.margins) {
    margins.translation_m = pose_error_m;
    margins.smallest_obstacle_m = 0;
  }
  settings.v_max_m_s = 0;
  return settings;
}

HardImages hard_images(const SlowScene& scene) {
  HardImages hard{workload_rig(scene.camera_count()), hard_settings(scene.camera_count(), scene.pose_error_m), {}};
  for (int k = 0; k < scene.camera_count(); ++k) {
    hard.images.push_back(image_of(scene, k));
  }
  return hard;
}

std::unique_ptr<views::ViewStore> stored(const HardImages& hard) {
  auto store = std::make_unique<views::ViewStore>(hard.rig, hard.settings);
  for (std::size_t k = 0; k < hard.images.size(); ++k) {
    Frame frame;
    frame.depth = depth_view(std::span<const std::uint16_t>(hard.images[k]), 640, 480, 0.001);
    static_cast<void>(store->update(k, frame));
  }
  return store;
}

std::vector<Capsule> nine_on_arm() {
  std::vector<Capsule> points;
  for (const Eigen::Vector3d& p : workload_points(0)) {
    points.push_back(Capsule::point(p));
  }
  return points;
}

}  // namespace depthgrid::lab
