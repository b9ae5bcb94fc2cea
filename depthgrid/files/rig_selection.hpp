// Some cameras of a rig file, in an order of their own. Internal.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "depthgrid/files/rig_file.hpp"

namespace depthgrid::files {

/// Throws ChoiceError with the parts streamed one after the other into one line.
template <class... Parts>
[[noreturn]] void fail_choice(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw ChoiceError(text.str());
}

/// The file with only the cameras of `ids`, in that order; empty: all. `name` is the file in messages. Throws
/// ChoiceError for unknown and doubled ids.
[[nodiscard]] RigFile select_cameras(RigFile all, const std::vector<std::string>& ids, const std::string& name);

}  // namespace depthgrid::files
