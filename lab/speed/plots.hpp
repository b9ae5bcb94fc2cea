// The benchmark's plots, from its records.
#pragma once

#include <string>

#include "lab/speed/record.hpp"

namespace depthgrid::lab {

/// Writes benchmark-<name>.png for cameras, query, points, rho, resolution, image and accuracy into the folder, which
/// is made when it is not there. Throws Error when a file cannot be written.
void draw_plots(const std::string& folder, const Report& report);

}  // namespace depthgrid::lab
