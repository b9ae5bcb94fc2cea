// Numbers and poses as options of the command line give them.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/core/pose.hpp"

namespace depthgrid::program {

/// The finite numbers between the commas of `text`. Throws UsageError that begins with `option`, as all here.
[[nodiscard]] std::vector<double> numbers_of(const std::string& option, const std::string& text);

/// The pose of x,y,z,qx,qy,qz,qw: the quaternion's length is 1 to a thousandth.
[[nodiscard]] Pose pose_of_quaternion(const std::string& option, const std::string& text,
                                      const std::vector<double>& seven);

/// As check_plausible() of a pose.
void check_plausible_option(const std::string& option, const Pose& pose);

}  // namespace depthgrid::program
