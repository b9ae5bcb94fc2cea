// The eight children of an octree cube: how near they are, and which of them the cameras free.
#pragma once

#include <array>
#include <cstdint>

#include "depthgrid/search/frontier.hpp"
#include "depthgrid/search/local_camera.hpp"

namespace depthgrid::search {

/// What a query asks of cubes; everything relative to the query's origin, metres.
struct CubeQuery {
  std::array<LocalCamera, kMostCameras> cameras;
  std::size_t camera_count = 0;
  std::array<std::uint8_t, kMostCameras> order{};  ///< in which cameras are asked; the last that freed cubes is first

  float axis_a[3];           ///< the primitive's axis from a to a + along
  float axis_along[3];
  float inverse_square = 0;  ///< 1 / |along|^2; 0 for a point

  bool boxed = false;  ///< W is a box that the primitive's surroundings leave
  float box_low[3];    ///< rounded outwards
  float box_high[3];
  int principal = -1;  ///< W is this camera's view between these depths
  float d_min_m = 0;
  float d_max_m = 0;
  bool uncovered_ignored = false;  ///< what no camera covers does not count
  float slack_m = 0;               ///< how near to a camera's not-free set the nearest point of an answer has to lie
};

/// Children of a cube that may hold an obstacle nearer than the bound.
struct Children {
  std::array<Cube, 8> cubes;
  int count = 0;
  /// Bit i: every camera seems to have not-free space within slack and reach of the point of cube i that is nearest to
  /// the axis. A hint: in single precision, roughly for segments, and the robot's islands are not looked at.
  std::uint32_t touching = 0;
};

/// Splits `parent`, whose children have this half side, and keeps the children that lie nearer than bound_m to the axis
/// and are neither outside W nor freed by the cameras. Never drops a child that holds a point of the obstacle set.
void split(CubeQuery& query, const Cube& parent, float half_m, float bound_m, Children& children) noexcept;

}  // namespace depthgrid::search
