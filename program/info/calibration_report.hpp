// What depthgrid info says about whether a calibration can be right.
#pragma once

#include <string>

#include "program/info/info_report.hpp"

namespace depthgrid::program {

/// A line a camera: field of view, nearest, median and farthest reading, the nearest other camera; a second one where
/// lens distortion is removed, with what that cuts off; and a remark for everything that looks like a mistake.
[[nodiscard]] std::string calibration_text(const files::Recording& recording, const RecordingInfo& info);

}  // namespace depthgrid::program
