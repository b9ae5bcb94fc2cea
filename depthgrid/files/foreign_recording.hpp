// Recordings in containers that depthgrid does not read: what they are, and what to do. Internal.
#pragma once

#include <filesystem>

namespace depthgrid::files {

/// Throws Error that says what the file is and how it becomes a folder of PNG files, where its name or its first bytes
/// are those of a recording of another program: .bag, .db3, .oni, .mkv, .svo; and for the folder of a ROS 2 bag
/// without a rig.json.
void refuse_foreign_recording(const std::filesystem::path& path);

/// The MCAP file that `path` is, by its name or its first bytes, or the one that lies in the folder of a ROS 2 bag;
/// empty: it is something else. Throws Error for a folder with several.
[[nodiscard]] std::filesystem::path mcap_recording(const std::filesystem::path& path);

}  // namespace depthgrid::files
