// What somebody knows about the space around a robot without any camera. Internal.
#pragma once

#include <span>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/memory/possible_space.hpp"

namespace depthgrid::memory {

/// Nothing is within distance_m of the capsules' surface: takes out the voxels whose every place, what is pending
/// included, is that near.
void take_out(std::span<const Capsule> capsules, double distance_m, double thinnest_hidden_m,
              PossibleSpace& space) noexcept;

/// Something may be within distance_m of the capsules' surface: puts back every voxel that is.
void put_in(std::span<const Capsule> capsules, double distance_m, PossibleSpace& space) noexcept;

}  // namespace depthgrid::memory
