// Names of image sequences. Not part of the installed headers; depth_file_name() stands in rig_file.hpp. Internal.
#pragma once

#include <string>
#include <string_view>

namespace depthgrid::files {

/// Stands for a time in seconds, as 1305031102.160407.
inline constexpr std::string_view kTimeConversion = "%f";

/// Throws Error (without a place) when the path leaves the folder: an absolute path or a part `..`; or cannot be
/// printed.
void check_stays_inside(const std::string& path);

/// The conversion (%d, %0Nd or %f) in `pattern`, empty when it has none. Throws Error (without a place) when the
/// pattern holds any other %, more than one conversion, or leaves the rig file's folder.
std::string checked_conversion(const std::string& pattern);

/// Whether it stands for all images of a folder: it ends with a slash.
[[nodiscard]] inline bool names_folder(const std::string& pattern) noexcept {
  return !pattern.empty() && pattern.back() == '/';
}

}  // namespace depthgrid::files
