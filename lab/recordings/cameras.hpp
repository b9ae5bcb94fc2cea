// Sub-rigs: a principal camera and some of the others.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/grid/closed_form_map.hpp"

namespace depthgrid::lab {

/// Indices in the whole rig; the first is the principal camera.
using CameraSet = std::vector<std::size_t>;

[[nodiscard]] Rig sub_rig(const Rig& rig, const CameraSet& cameras);
[[nodiscard]] std::vector<Frame> sub_frames(std::span<const Frame> frames, const CameraSet& cameras);
[[nodiscard]] std::vector<grid::SecondaryCamera> secondaries(const Rig& rig, const CameraSet& cameras);

/// Every set with `principal` first and the others in ascending order; 2^(n-1) sets, smallest first.
[[nodiscard]] std::vector<CameraSet> camera_sets(std::size_t camera_count, std::size_t principal);

}  // namespace depthgrid::lab
