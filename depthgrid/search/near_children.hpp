// How near the children of a cube are to an axis. Internal.
#pragma once

#include <array>
#include <cstdint>

#include "depthgrid/search/lattice.hpp"

namespace depthgrid::search {

/// A primitive's axis from a to a + along, relative to the lattice's origin, metres.
struct Axis {
  std::array<float, 3> a{};
  std::array<float, 3> along{};
  float inverse_square = 0;  ///< 1 / |along|^2; 0 for a point
};

/// Distances of the eight children of a cube, half_m half a side, from the axis: none is nearer, up to the rounding of
/// single precision (see near_guard_m). Bit i of the result: child i is nearer than bound_m.
[[nodiscard]] std::uint32_t near_children(const Axis& axis, const Cube& cube, float half_m, float bound_m,
                                          std::array<float, 8>& distances_m) noexcept;

/// More than those distances may be too large by, within extent_m of the origin.
[[nodiscard]] constexpr double near_guard_m(double extent_m) noexcept { return 2e-6 + 32 * 0x1p-24 * extent_m; }

}  // namespace depthgrid::search
