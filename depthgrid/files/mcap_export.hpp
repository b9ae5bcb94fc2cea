// Writes a recording as an MCAP file.
#pragma once

#include <filesystem>

#include "depthgrid/files/mcap_writer.hpp"
#include "depthgrid/files/recording.hpp"

namespace depthgrid::files {

/// Every image as it was recorded, its calibration, and where the cameras stand, in frame "world":
/// /ID/depth/image_raw with /ID/depth/camera_info, and /tf_static. Images of millimetres are 16UC1; others are 32FC1,
/// the same float that the library makes of them. Values that are listed as invalid become "no measurement". What ROS
/// has no messages for (sensors, margins, near and far) stays in the rig file: give it as McapChoice::rig. Throws Error
/// for a camera that moves, an id that is no topic's name, and what cannot be read or written.
void save_mcap(Recording& recording, const std::filesystem::path& file, const McapWriterOptions& options = {});

}  // namespace depthgrid::files
