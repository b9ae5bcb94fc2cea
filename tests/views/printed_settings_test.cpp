// What to_string() prints of rigs and settings is C++ that makes them again: printed_settings.hpp is such text.
#include "printed_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace depthgrid::views {
namespace {

// Structured bindings, so that a member that is forgotten here does not compile.

bool same(const RigCamera& a, const RigCamera& b);

bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same(std::monostate /*a*/, std::monostate /*b*/) { return true; }
template <class Derived>
bool same(const Eigen::MatrixBase<Derived>& a, const Eigen::MatrixBase<Derived>& b) {
  return a.binaryExpr(b, [](double x, double y) { return same(x, y) ? 1.0 : 0.0; }).minCoeff() == 1.0;
}
bool same(const Pose& a, const Pose& b) { return same(a.matrix(), b.matrix()); }
bool same(const CameraMargins& a, const CameraMargins& b) {
  const auto& [sensor, translation, rotation, exposure, time, smallest, second_view] = a;
  const auto& [constant, linear, quadratic, lateral] = sensor;
  return same(constant, b.sensor.constant_m) && same(linear, b.sensor.linear) &&
         same(quadratic, b.sensor.quadratic_per_m) && lateral == b.sensor.lateral_px &&
         same(translation, b.translation_m) && same(rotation, b.rotation_rad) && same(exposure, b.half_exposure_s) &&
         same(time, b.time_uncertainty_s) && same(smallest, b.smallest_obstacle_m) &&
         same(second_view, b.second_view_x_m);
}
bool same(const FrustumSpace& a, const FrustumSpace& b) {
  const auto& [principal, d_min, d_max] = a;
  return principal == b.principal && same(d_min, b.d_min_m) && same(d_max, b.d_max_m);
}
bool same(const BoxSpace& a, const BoxSpace& b) {
  const auto& [low, high] = a;
  return same(low, b.low_world) && same(high, b.high_world);
}
template <class Value>
bool same(const std::optional<Value>& a, const std::optional<Value>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}
template <class Range>
bool same_range(const Range& a, const Range& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) { return same(x, y); });
}
bool same(const RigCamera& a, const RigCamera& b) {
  const auto& [id, intrinsics, distortion, scale, rule, T_world_camera, sensor, margins] = a;
  const auto& [width, height, fx, fy, cx, cy] = intrinsics;
  const auto& [model, coefficients] = distortion;
  const auto& [near, far, clamp, invalid] = rule;
  return id == b.id && width == b.intrinsics.width_px && height == b.intrinsics.height_px &&
         same(fx, b.intrinsics.fx_px) && same(fy, b.intrinsics.fy_px) && same(cx, b.intrinsics.cx_px) &&
         same(cy, b.intrinsics.cy_px) && model == b.distortion.model &&
         same_range(coefficients, b.distortion.coefficients) && same(scale, b.metres_per_unit) &&
         same(near, b.rule.near_m) && same(far, b.rule.far_m) && clamp == b.rule.clamp_beyond_far &&
         invalid == b.rule.invalid_units && same(T_world_camera, b.T_world_camera) && sensor == b.sensor &&
         same(margins, b.margins);
}
bool same(const Rig& a, const Rig& b) {
  const auto& [name, cameras, T_floor_world] = a;
  return name == b.name && same_range(cameras, b.cameras) && same(T_floor_world, b.T_floor_world);
}
bool same(const Settings& a, const Settings& b) {
  const auto& [space, policies, margins, rho, resolution, v_max, age, blend, alpha] = a;
  const auto& [unobserved, outside, pockets, pocket] = policies;
  const bool same_space =
      space.index() == b.space.index() &&
      std::visit([&b](const auto& s) { return same(s, std::get<std::decay_t<decltype(s)>>(b.space)); }, space);
  return same_space && unobserved == b.policies.unobserved && outside == b.policies.outside &&
         pockets == b.policies.robot_pockets && same(pocket, b.policies.ignored_pocket_m) &&
         same_range(margins, b.margins) && same(rho, b.rho_m) && same(resolution, b.resolution_m) &&
         same(v_max, b.v_max_m_s) && same(age, b.max_frame_age_s) && same(blend, b.direction_blend) &&
         same(alpha, b.repulsion_alpha);
}

template <class Value>
void expect_same(const std::vector<Value>& printed, const std::vector<Value>& made) {
  ASSERT_EQ(printed.size(), made.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_TRUE(same(printed[i], made[i])) << i << ": " << to_string(made[i]);
  }
}

TEST(PrintedSettings, AreTheSameAgain) {
  expect_same(printed_rigs(), odd_rigs());
  expect_same(printed_settings(), odd_settings());
}

}  // namespace
}  // namespace depthgrid::views
