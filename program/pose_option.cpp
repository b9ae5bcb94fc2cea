#include "program/pose_option.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/plausibility.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

std::vector<double> numbers_of(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const auto number = parse_number<double>(std::string_view(text).substr(begin, comma - begin));
    if (!number || !std::isfinite(*number)) {
      fail_usage(option, " ", text, ": '", text.substr(begin, comma - begin), "' is no finite number");
    }
    numbers.push_back(*number);
    begin = comma + 1;
  }
  return numbers;
}

Pose pose_of_quaternion(const std::string& option, const std::string& text, const std::vector<double>& seven) {
  constexpr double kRounding = 1e-3;
  const Eigen::Quaterniond q(seven.at(6), seven.at(3), seven.at(4), seven.at(5));
  if (!(std::abs(q.norm() - 1.0) <= kRounding)) {
    fail_usage(option, " ", text, ": the quaternion qx,qy,qz,qw has length ", q.norm(), ", must be 1");
  }
  Pose pose = Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(seven[0], seven[1], seven[2]);
  return pose;
}

void check_plausible_option(const std::string& option, const Pose& pose) {
  as_usage([&] { check_plausible(pose, option.c_str()); });
}

}  // namespace depthgrid::program
