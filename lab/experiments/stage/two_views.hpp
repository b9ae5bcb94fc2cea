// The letter's first camera with two choices of a second one, 4 m from it: opposite, and aside.
#pragma once

#include <string_view>

#include "depthgrid/simulation/arrangement.hpp"

namespace depthgrid::experiments {

inline constexpr std::size_t kFirstCamera = 0;
inline constexpr std::size_t kOppositeCamera = 1;
inline constexpr std::size_t kAsideCamera = 2;

/// The letter says that its cameras stand about 4 m apart, not where. simulation::letter_arrangement() has them
/// opposite each other with the robot on the line between them; then what the first camera cannot see of the space
/// before the robot is hidden from the second by the robot itself. The camera aside stands 4 m from the first one too,
/// 123 degrees around the robot from it.
[[nodiscard]] simulation::Arrangement two_views(std::string_view sensor);

}  // namespace depthgrid::experiments
