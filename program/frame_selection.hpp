// Which frames of a recording a command works on.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"

namespace depthgrid::program {

/// Frame numbers from a text such as "5", "0:80" (both ends included), "0:80:8" (every eighth) or "0,5,10:12"; an empty
/// text means all frames. The recording has frames first .. first + count - 1. The result is ascending, without
/// repetition. Throws UsageError on a malformed text or a frame that the recording does not have.
std::vector<int> select_frames(const std::string& text, int first, int count);

/// The same as indices of a recording, whose numbers may have gaps: a range takes the numbers that there are, a single
/// number must be there.
std::vector<int> select_frames(const std::string& text, const files::Recording& recording);

}  // namespace depthgrid::program
