// The eight children of an octree cube: how near they are, and which of them are known free. Internal.
#pragma once

#include <array>
#include <cstdint>

#include "depthgrid/search/frontier.hpp"
#include "depthgrid/search/local_camera.hpp"

namespace depthgrid::search {

/// Children of two cubes: what is tested at once.
inline constexpr std::size_t kSplit = 16;

/// Most primitives that are searched at once.
inline constexpr std::size_t kGroup = 32;

/// A primitive's axis from a to a + along, and how far from it an obstacle is of interest.
struct Axis {
  std::array<float, 3> a{};
  std::array<float, 3> along{};
  float inverse_square = 0;  ///< 1 / |along|^2; 0 for a point
  float bound_m = 0;         ///< cubes that are not nearer are dropped
};

/// What a query asks of cubes; everything relative to the query's origin, metres.
struct CubeQuery {
  std::array<LocalCamera, views::kMaxCameras> cameras;
  std::size_t camera_count = 0;
  std::array<std::uint8_t, views::kMaxCameras>
      order{};  ///< in which cameras are asked; the last to which cubes were known free is first

  std::array<Axis, kGroup> axes;

  bool boxed = false;              ///< W is a box that the primitives' surroundings leave
  std::array<float, 3> box_low{};  ///< rounded outwards
  std::array<float, 3> box_high{};
  int principal = -1;  ///< W is this camera's view between these depths
  float d_min_m = 0;
  float d_max_m = 0;
  bool uncovered_ignored = false;  ///< what no camera covers does not count
  float slack_m = 0;  ///< how near to a camera's not known free set the nearest point of an answer has to lie
};

/// Children of a cube that may hold an obstacle nearer than the bound of one of their primitives.
struct Children {
  std::array<Cube, kSplit> cubes{};
  int count = 0;
  /// Of each child, bit i: every camera seems to have not known free space within slack and pose error of the point
  /// that lies at the child's distance from axis i, towards its centre. A hint: in single precision, roughly for
  /// segments, and the robot's islands are not looked at.
  std::array<std::uint32_t, kSplit> tight_witness{};
};

/// Splits one or two parents of the same level, whose children have this half side, and keeps the children that lie
/// nearer to the axis of one of their parent's primitives than its bound and are neither outside W nor known free to
/// the cameras. A kept child may have no primitives left. Never drops a child that holds a point of the obstacle set.
void split(CubeQuery& query, const Cube* parents, int parent_count, float half_m, Children& children) noexcept;

}  // namespace depthgrid::search
