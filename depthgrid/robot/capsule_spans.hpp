// Which pixels of each row of an image a capsule may cover.
#pragma once

#include <span>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/capsule.hpp"

namespace depthgrid::robot {

/// Pixels [begin, end) of a row.
struct PixelSpan {
  int begin = 0;
  int end = 0;

  [[nodiscard]] bool empty() const noexcept { return begin >= end; }
};

/// Rows [begin, end) of an image.
struct RowRange {
  int begin = 0;
  int end = 0;
};

/// Widens `rows[v]`, one a row of the image, to every pixel whose square the capsule's projection (camera frame) meets,
/// and returns the rows touched; all others are left alone. Everything where a part of the capsule may be nearer than
/// 1e-6 m to the camera's plane; nothing where all of it lies behind. The capsule is taken piece by piece along its
/// axis, so that a slanting one does not claim the whole rectangle around it.
RowRange widen(const PinholeCamera& camera, const Capsule& capsule_camera, std::span<PixelSpan> rows) noexcept;

}  // namespace depthgrid::robot
