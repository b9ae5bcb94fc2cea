// What a frame of librealsense2 says. Private.
#pragma once

#include <optional>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/sensors/realsense_library.hpp"

namespace depthgrid::sensors::rs2 {

/// Its pixels, good while the frame is held. Throws Error where it is no 16-bit image of this size.
[[nodiscard]] DepthView depth_of(const Library& library, const Frame* frame, int width_px, int height_px,
                                 double metres_per_unit);

/// Seconds, none: it does not say.
[[nodiscard]] std::optional<double> exposure_s(const Library& library, const Frame* frame);

/// By how much the middle of the exposure was before the frame's stamp, seconds: as the device says it, or half the
/// exposure; none where it says neither. Of stamps of the read-out, not of those of the arrival.
[[nodiscard]] std::optional<double> middle_before_stamp_s(const Library& library, const Frame* frame);

/// Seconds of the frame's stamp.
[[nodiscard]] double stamp_s(const Library& library, const Frame* frame);

}  // namespace depthgrid::sensors::rs2
