#include "depthgrid/control/joint_limits.hpp"

#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::control {
namespace {

constexpr double kLongestPeriod = 1.0;

void check_size(const char* what, const JointVector& values, int joints) {
  if (values.size() != joints) {
    fail("joint limits: ", what, " has ", values.size(), " joints, the lowest positions have ", joints);
  }
}

void check_positive(const char* what, double value, int joint, const char* unit) {
  if (!(std::isfinite(value) && value > 0)) {
    fail("joint limits: ", what, " of joint ", joint, " is ", value, unit, ", must be greater than 0 and finite");
  }
}

}  // namespace

void validate(const JointLimits& limits) {
  const int joints = limits.joints();
  if (joints < 1) {  // more than kMaxJoints do not fit the type
    fail("joint limits: there is no joint");
  }
  check_size("highest", limits.highest_rad, joints);
  check_size("velocity", limits.velocity_rad_s, joints);
  check_size("acceleration", limits.acceleration_rad_s2, joints);
  for (int i = 0; i < joints; ++i) {
    const double low = limits.lowest_rad[i];
    const double high = limits.highest_rad[i];
    if (!(std::isfinite(low) && std::isfinite(high) && low < high)) {
      fail("joint limits: joint ", i, " reaches from ", low, " to ", high,
           " rad, the lowest position must lie below the highest, both finite");
    }
    check_positive("velocity", limits.velocity_rad_s[i], i, " rad/s");
    check_positive("acceleration", limits.acceleration_rad_s2[i], i, " rad/s^2");
  }
}

void validate_period(double period_s, const char* name) {
  if (!(period_s > 0 && period_s <= kLongestPeriod)) {
    fail(name, ": period is ", period_s, " s, must be greater than 0 and at most ", kLongestPeriod, " s");
  }
}

}  // namespace depthgrid::control
