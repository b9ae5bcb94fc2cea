// Every number of an answer, to be compared to the bit.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "depthgrid/core/answer.hpp"

namespace depthgrid::search {

inline void put(const Eigen::Vector3d& v, std::vector<std::uint64_t>& bits) {
  for (int i = 0; i < 3; ++i) {
    bits.push_back(std::bit_cast<std::uint64_t>(v[i]));
  }
}

inline std::vector<std::uint64_t> bits_of(const Answer& answer) {
  std::vector<std::uint64_t> bits;
  const Proximity& nearest = answer.nearest;
  bits.push_back(std::bit_cast<std::uint64_t>(nearest.distance_m));
  bits.push_back(std::bit_cast<std::uint64_t>(nearest.known_to_m));
  bits.push_back(std::bit_cast<std::uint64_t>(answer.distance_now_m));
  bits.push_back(std::bit_cast<std::uint64_t>(answer.blind_m));
  bits.push_back(static_cast<std::uint64_t>(answer.obstacle_points));
  put(nearest.nearest_world, bits);
  put(nearest.direction_world, bits);
  put(answer.on_axis_world, bits);
  put(answer.hybrid_direction_world, bits);
  bits.push_back(static_cast<std::uint64_t>(nearest.state));
  bits.push_back(nearest.camera ? *nearest.camera : 999);
  bits.push_back((nearest.stale ? 1U : 0U) + (nearest.budget ? 2U : 0U));
  return bits;
}

}  // namespace depthgrid::search
