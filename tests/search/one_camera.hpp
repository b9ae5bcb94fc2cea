// One camera before a wall, for tests of a single thing, and what the oracle allows.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "search/search_setup.hpp"

namespace depthgrid::search {

/// One camera at the origin that looks along z at a wall, W a box around both.
struct OneCamera {
  static constexpr int kWidthPx = 64;
  static constexpr int kHeightPx = 48;
  std::vector<float> image_m;
  SearchSetup setup;

  explicit OneCamera(float wall_m = 2.0F, int width_px = kWidthPx, int height_px = kHeightPx)
      : image_m(static_cast<std::size_t>(width_px * height_px), wall_m) {
    RigCamera camera;
    camera.id = "front";
    camera.intrinsics = {width_px, height_px, 50, 50, 0.5 * width_px, 0.5 * height_px};
    camera.rule.near_m = 0.3;
    setup.rig.name = "one camera";
    setup.rig.cameras = {camera};
    setup.frames.resize(1);
    refer();
    setup.settings.space = views::BoxSpace{{-3, -3, -3}, {3, 3, 3}};
    setup.settings.policies = {views::Policy::obstacle, views::Policy::obstacle, views::Policy::obstacle, 0};
    setup.settings.margins = {CameraMargins{.sensor = {0, 0, 0, 0}, .smallest_obstacle_m = 0}};
    setup.settings.v_max_m_s = 0;
  }
  void refer() {
    const PinholeCamera& pinhole = setup.rig.cameras[0].intrinsics;
    setup.frames[0].depth = depth_view(image_m, pinhole.width_px, pinhole.height_px);
  }
};

/// Both ends of what the oracle allows.
inline void expect_within_oracle(const SearchSetup& setup, const Eigen::Vector3d& p_world) {
  const double rho_m = setup.settings.rho_m;
  const double answer_m = Asker(setup).distance(Capsule::point(p_world)).nearest.distance_m;
  const reference::Interval exact = reference::Reference(oracle_problem(setup)).distance(p_world);
  const reference::Interval grown =
      reference::Reference(oracle_problem(setup, setup.settings.resolution_m)).distance(p_world);
  EXPECT_LE(answer_m, exact.hi_m.value_or(rho_m)) << "point " << p_world.transpose();
  EXPECT_GE(answer_m, grown.lo_m - kRounding - kDoubleRounding) << "point " << p_world.transpose();
}

}  // namespace depthgrid::search
