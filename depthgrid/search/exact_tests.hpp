// Exact tests of cubes and points, in double precision. Internal.
#pragma once

#include <Eigen/Core>

#include "depthgrid/search/cube_query.hpp"
#include "depthgrid/search/search.hpp"

namespace depthgrid::search {

/// Relative to the lattice's origin, metres.
struct Box {
  Eigen::Vector3d low, high;
};

/// The part of a cube in W where that is a box.
[[nodiscard]] Box box_of(const CubeQuery& query, const Cube& cube) noexcept;

/// Whether a point of a cube that is cut to W lies in W.
[[nodiscard]] bool in_space(const CubeQuery& query, const Eigen::Vector3d& x_local) noexcept;

/// By the memory something may be in the box, as far as few look-ups tell.
[[nodiscard]] bool may_be_occupied(const CubeQuery& query, const Box& box) noexcept;

/// Every camera and the memory have x in its not known free set, or nearly so along the ray, and x counts.
[[nodiscard]] bool is_blocked(const CubeQuery& query, const Eigen::Vector3d& x_local, double slack_m) noexcept;

/// The ball around the cube with all its pose error is known free to some camera, or all that is covered of it is; or,
/// by the memory, nothing can be in the cube.
[[nodiscard]] bool is_free(const CubeQuery& query, const Cube& cube, Count& count) noexcept;

}  // namespace depthgrid::search
