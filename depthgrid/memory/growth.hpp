// Obstacles move, no faster than v_max: where something may be grows. Internal.
#pragma once

#include <vector>

#include "depthgrid/memory/history.hpp"
#include "depthgrid/memory/possible_space.hpp"

namespace depthgrid::memory {

/// Adds the 26 neighbours of each voxel, and to the outermost voxels what comes from outside. `scratch` has as many
/// blocks as the set.
void dilate(VoxelSet& set, std::vector<Block>& scratch) noexcept;

/// What may be where after things have moved by up to motion_m, from anywhere and in at the border. Whole voxels are
/// added, the rest is kept as pending: less than a voxel.
///
/// A place that is within pending of a voxel's cube is within pending - h of the cube and its neighbours: these hold
/// the ball of radius h around every point of it.
///
/// `history`, where there is one, is told each step with its time between the space's own and until_s.
void grow(PossibleSpace& space, double motion_m, std::vector<Block>& scratch, History* history = nullptr,
          double until_s = 0) noexcept;

}  // namespace depthgrid::memory
