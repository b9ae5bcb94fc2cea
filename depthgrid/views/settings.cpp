#include "depthgrid/views/settings.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "depthgrid/core/error.hpp"

namespace depthgrid::views {
namespace {

constexpr const char* kName = "search settings: ";

/// Longest surveillance radius: far beyond every depth camera.
constexpr double kLargestRho = 100.0;
/// Below this the cubes of the octree would shrink towards the rounding of single precision.
constexpr double kSmallestResolution = 0.0005;

/// Widest space of interest: the octree's cubes are then exact in single precision.
constexpr double kMostResolutions = 32768;

void check_within(const char* what, double value, double low, double high, const char* unit) {
  if (!(value >= low && value <= high)) {
    fail(kName, what, " is ", value, unit, ", must be between ", low, " and ", high, unit);
  }
}

void check_not_negative(const std::string& what, double value, const char* unit) {
  if (!(std::isfinite(value) && value >= 0)) {
    fail(what, " is ", value, unit, ", must be a finite number that is not negative");
  }
}

void check_space(const FrustumSpace& space, const Rig& rig) {
  if (space.principal >= rig.cameras.size()) {
    fail(kName, "principal camera is ", space.principal, ", the rig has ", rig.cameras.size(),
         " cameras, counted from 0");
  }
  check_within("d_min", space.d_min_m, 0, kLargestTranslation, " m");
  if (!(space.d_max_m > space.d_min_m && space.d_max_m <= kLargestTranslation)) {
    fail(kName, "d_max is ", space.d_max_m, " m, must be greater than d_min (", space.d_min_m, " m) and at most ",
         kLargestTranslation, " m");
  }
}

void check_space(const BoxSpace& space) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = space.low_world[axis];
    const double high = space.high_world[axis];
    const char name = "xyz"[axis];
    if (!(std::abs(low) <= kLargestTranslation && std::abs(high) <= kLargestTranslation)) {
      fail(kName, "box reaches from ", low, " to ", high, " m in ", name, ", must stay within ", kLargestTranslation,
           " m of the world's origin; a space without limits is not possible");
    }
    if (!(low < high)) {
      fail(kName, "box reaches from ", low, " to ", high, " m in ", name,
           ", the low corner must lie below the high one");
    }
  }
}

/// The longest way from one corner of W to another along an axis of the world, at most.
double width_m(const Settings& settings, const Rig& rig) {
  if (const auto* box = std::get_if<BoxSpace>(&settings.space)) {
    return (box->high_world - box->low_world).maxCoeff();
  }
  const auto& frustum = std::get<FrustumSpace>(settings.space);
  const PinholeCamera& c = rig.cameras[frustum.principal].intrinsics;
  return std::max(std::hypot(c.width_px / c.fx_px, c.height_px / c.fy_px) * frustum.d_max_m,
                  std::hypot(std::max(c.cx_px, c.width_px - c.cx_px) / c.fx_px,
                             std::max(c.cy_px, c.height_px - c.cy_px) / c.fy_px, 1.0) *
                      frustum.d_max_m);
}

void check_declared(const char* what, Policy policy) {
  if (policy != Policy::obstacle && policy != Policy::ignored) {
    fail(kName, "policy for ", what, " is not declared: choose obstacle or ignored");
  }
}

void check_policies(const Policies& policies) {
  check_declared("unobserved space", policies.unobserved);
  check_declared("space outside W", policies.outside);
  check_declared("pockets behind the robot", policies.robot_pockets);
  check_not_negative(std::string(kName) + "ignored_pocket", policies.ignored_pocket_m, " m");
  if (policies.robot_pockets == Policy::obstacle && policies.ignored_pocket_m != 0) {
    fail(kName, "ignored_pocket is ", policies.ignored_pocket_m,
         " m, must be 0 where pockets behind the robot count as obstacle; declare them ignored to use it");
  }
}

}  // namespace

void validate(const Settings& settings, const Rig& rig) {
  if (rig.cameras.size() > kMaxCameras) {
    fail(kName, "the rig has ", rig.cameras.size(), " cameras, at most ", kMaxCameras, " are supported");
  }
  if (const auto* frustum = std::get_if<FrustumSpace>(&settings.space)) {
    check_space(*frustum, rig);
  } else if (const auto* box = std::get_if<BoxSpace>(&settings.space)) {
    check_space(*box);
  } else {
    fail(kName, "the space of interest is not set: choose a FrustumSpace or a BoxSpace");
  }
  check_policies(settings.policies);
  if (settings.margins.size() != rig.cameras.size()) {
    fail(kName, "there are margins for ", settings.margins.size(), " cameras, must be one for each of the rig's ",
         rig.cameras.size());
  }
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    const std::string name = kName + ("camera '" + rig.cameras[k].id + "'");
    depthgrid::validate(settings.margins[k], name.c_str());
    if (std::isnan(settings.margins[k].smallest_obstacle_m)) {
      fail(name,
           ": the smallest obstacle is not declared: margins.smallest_obstacle_m = 0 assumes nothing, and every pixel "
           "without reading is an obstacle; what a sensor model recommends stands in its smallest_obstacle_m");
    }
    if (settings.margins[k].second_view_x_m != 0 && !(rig.cameras[k].rule.near_m > 0)) {
      fail(name, ": the second view is stated (second_view_x_m ", settings.margins[k].second_view_x_m,
           " m) and rule.near_m is 0 m: how wide its shadows can be depends on how near things can be; set near_m, or "
           "second_view_x_m = 0");
    }
  }
  if (!(settings.rho_m > 0 && settings.rho_m <= kLargestRho)) {
    fail(kName, "rho is ", settings.rho_m, " m, must be greater than 0 and at most ", kLargestRho, " m");
  }
  if (!(settings.resolution_m >= kSmallestResolution && settings.resolution_m <= settings.rho_m)) {
    fail(kName, "resolution is ", settings.resolution_m, " m, must be between ", kSmallestResolution, " m and rho (",
         settings.rho_m, " m)");
  }
  const double most_m = kMostResolutions * settings.resolution_m;
  if (!(width_m(settings, rig) <= most_m)) {
    fail(kName, "the space of interest is up to ", width_m(settings, rig), " m wide, must be at most ",
         kMostResolutions, " times the resolution, ", most_m,
         " m: nothing beyond the robot's reach and rho around it is needed");
  }
  if (std::isnan(settings.v_max_m_s)) {
    fail(kName,
         "v_max, the speed of the fastest obstacle, is not set: 1.6 m/s for walking and 2 m/s for the motion of "
         "arms are ISO 13855's values; 0 only if all cameras expose at one instant or nothing moves");
  }
  check_not_negative(std::string(kName) + "v_max", settings.v_max_m_s, " m/s");
  if (!(settings.max_frame_age_s >= 0)) {
    fail(kName, "max_frame_age is ", settings.max_frame_age_s, " s, must not be negative");
  }
  check_within("direction_blend", settings.direction_blend, 0, 1, "");
  check_within("repulsion_alpha", settings.repulsion_alpha, 0, kLargestAlpha, "");
}

}  // namespace depthgrid::views
