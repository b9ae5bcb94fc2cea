// What two cameras' surfaces say about their poses.
#include "program/info/agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace depthgrid::program {
namespace {

constexpr PinholeCamera kCamera{64, 48, 60.0, 60.0, 32.0, 24.0};

Surface wall(float depth_m) {
  DepthImage depth(kCamera.width_px, kCamera.height_px);
  std::fill_n(depth.data(), depth.index(0, depth.height_px()), depth_m);
  Surface surface;
  make_surface(kCamera, depth, surface);
  return surface;
}

// What one camera sees 0.1 m before the other's wall, both margins explain in part: it is left to the poses.
TEST(Agreement, SuggestsAPoseMarginForWhatTheMarginsDoNotExplain) {
  for (const auto& [a_m, b_m, left_m] :
       {std::array{0.0, 0.0, 0.1}, std::array{0.01, 0.03, 0.06}, std::array{0.2, 0.0, 0.0}}) {
    PairAgreement agreement;
    add_pair(wall(1.9F), wall(2.0F), kCamera, Eigen::Isometry3d::Identity(), 4.0, 1, {a_m, 0, 0, 0}, {b_m, 0, 0, 0},
             agreement);
    EXPECT_NEAR(suggested_pose_margin_m(agreement), left_m, 0.002) << a_m << ' ' << b_m;
  }
}

}  // namespace
}  // namespace depthgrid::program
