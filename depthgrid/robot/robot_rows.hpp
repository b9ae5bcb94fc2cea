// The depth interval of capsules in one row of an image, a vector register of pixels at a time.
#pragma once

#include <array>
#include <cstddef>

#include "depthgrid/robot/capsule_spans.hpp"

namespace depthgrid::robot {

/// Most pixels that are looked at together, and what rows are padded to.
inline constexpr int kLanes = 16;

/// A capsule in the camera's frame, in single precision.
struct RowCapsule {
  std::array<float, 3> a{};
  std::array<float, 3> b{};
  std::array<float, 3> axis{};      ///< unit, from a to b; any where they are the same
  std::array<float, 3> a_across{};  ///< a less its part along the axis
  float a_along = 0;                ///< a's part along the axis
  float length = 0;                 ///< from a to b
  float body_square = 0;            ///< squared radius
  float padded_square = 0;          ///< of the padded capsule, a little more than rounding takes
};

/// One row's work. `near_m` and `far_m` have room for whole vectors from `pixels.begin` (a multiple of kLanes) on.
struct RobotRow {
  const RowCapsule* capsules = nullptr;
  const PixelSpan* spans = nullptr;  ///< of each capsule in this row
  std::size_t count = 0;
  const float* x_ray = nullptr;      ///< of each column: x / z of the ray through the pixels' centres
  float y_ray = 0;                   ///< y / z of the row's
  const float* reading_m = nullptr;  ///< of each column: the camera's own; null: none
  PixelSpan pixels;                  ///< what is written
  float* near_m = nullptr;
  float* far_m = nullptr;
  float* scratch = nullptr;  ///< 2 * kLanes floats a capsule, aligned as AlignedVector is
};

/// Writes for each pixel of the row the ends of one part of the padded capsules along the ray through its centre: the
/// one that holds the reading; where none does, the one that holds the first surface of the capsules without padding;
/// where there is none, the first one. 0 where the ray meets no padded capsule.
void robot_row(const RobotRow& row) noexcept;

}  // namespace depthgrid::robot
