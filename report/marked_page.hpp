// Measured parts of pages that people write.
#pragma once

#include <filesystem>
#include <string_view>

namespace depthgrid::report {

/// Replaces what stands between the two markers in a file by a line break and `text`. Throws Error that names the file
/// when it cannot be read or written, or lacks the markers in this order.
void write_between(const std::filesystem::path& page, std::string_view begin, std::string_view end,
                   std::string_view text);

}  // namespace depthgrid::report
