// What a frame of librealsense2 says. Private.
#pragma once

#include <optional>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/sensors/device_clock.hpp"
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

/// By how much stamps of global time may be off: librealsense2 fits a line to times that it asks the device for.
inline constexpr double kGlobalTimeError_s = 0.005;

/// What is to be taken off stamps of this clock: the lag of those of the arrival. Throws Error where what is declared
/// does not cover how far they may be off. Nothing is demanded of the device's own clock.
[[nodiscard]] double lag_of_stamps(int domain, const ArrivalTimes& declared);

/// The middle of the exposure on the clock of the frame's stamps, seconds. Where the frame does not say when that was,
/// a whole period is taken off: it may look older than it is, not newer.
[[nodiscard]] double middle_s(const Library& library, const Frame* frame, double lag_s, double period_s);

/// Seconds of the frame's stamp.
[[nodiscard]] double stamp_s(const Library& library, const Frame* frame);

}  // namespace depthgrid::sensors::rs2
