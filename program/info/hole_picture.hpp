// A picture of what cameras measure and what that frees, without and with a smallest obstacle.
#pragma once

#include <filesystem>
#include <span>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::program {

/// A row for each camera, at most four: its depth image, and up to which depth each pixel frees space with the smallest
/// obstacles 0, 2 and 5 cm. `frames`: one a camera. Throws Error if the file cannot be written.
void save_hole_picture(const std::filesystem::path& file, const Rig& rig, std::span<const Frame> frames);

}  // namespace depthgrid::program
