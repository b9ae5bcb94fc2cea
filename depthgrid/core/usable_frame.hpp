// Which frames can be used: one rule for everything that takes images.
#pragma once

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid {

/// Why this is no image of this camera, as a static string: no data, another size than the intrinsics', rows that
/// overlap. Null: it is one.
[[nodiscard]] const char* why_unusable(const DepthView& depth, const PinholeCamera& camera) noexcept;

/// Why nothing can be measured in this frame of the camera: the same, another depth scale than the camera's, half a
/// robot view, or one whose rows overlap or whose blind layer is no thickness. Null: it can be used.
[[nodiscard]] const char* why_unusable(const Frame& frame, const RigCamera& camera) noexcept;

/// The same with the stride written out that 0 stands for: rows without padding.
[[nodiscard]] DepthView with_stride(DepthView depth) noexcept;
[[nodiscard]] Frame with_strides(Frame frame) noexcept;

}  // namespace depthgrid
