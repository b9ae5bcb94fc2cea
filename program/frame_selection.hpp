// Which frames of a recording a command works on.
#pragma once

#include <string>
#include <vector>

namespace depthgrid::program {

/// Frame numbers from a text such as "5", "0:80" (both ends included), "0:80:8" (every eighth) or "0,5,10:12"; an empty
/// text means all frames. The recording has frames first .. first + count - 1. The result is ascending, without
/// repetition. Throws UsageError on a malformed text or a frame that the recording does not have.
std::vector<int> select_frames(const std::string& text, int first, int count);

}  // namespace depthgrid::program
