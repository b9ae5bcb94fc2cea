// BENCHMARK.md, one screen, and docs/benchmark-search.md with everything, from the records of one run.
#pragma once

#include <string>

#include "lab/speed/record.hpp"

namespace depthgrid::lab {

/// Writes `file`, and docs/benchmark-search.md beside it. `images` is the plots' folder as seen from `file`. Throws
/// Error when one cannot be written.
void write_page(const std::string& file, const std::string& images, const Report& report);

}  // namespace depthgrid::lab
