// BENCHMARK.md, from the records of one run.
#pragma once

#include <string>

#include "lab/speed/record.hpp"

namespace depthgrid::lab {

/// `images` is the plots' folder as seen from the page. Throws Error when the file cannot be written.
void write_page(const std::string& file, const std::string& images, const Report& report);

}  // namespace depthgrid::lab
