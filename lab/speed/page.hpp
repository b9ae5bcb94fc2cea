// BENCHMARK.md, one screen, docs/benchmark-search.md with everything, and the search's part of docs/goals.md, from the
// records of one run.
#pragma once

#include <string>

#include "lab/speed/record.hpp"

namespace depthgrid::lab {

/// Writes `file`, and beside it docs/benchmark-search.md and the marked part of docs/goals.md. `images` is the plots'
/// folder as seen from `file`. Throws Error when one cannot be written.
void write_page(const std::string& file, const std::string& images, const Report& report);

}  // namespace depthgrid::lab
