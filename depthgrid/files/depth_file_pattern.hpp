// Names of image sequences. Not part of the installed headers; depth_file_name() stands in rig_file.hpp. Internal.
#pragma once

#include <string>

namespace depthgrid::files {

/// The conversion (%d or %0Nd) in `pattern`, empty when it has none. Throws Error (without a place) when the pattern
/// holds any other %, more than one conversion, or leaves the rig file's folder: an absolute path or a part `..`.
std::string checked_conversion(const std::string& pattern);

}  // namespace depthgrid::files
