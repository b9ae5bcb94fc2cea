// The depth grid map of the letter's section V behind one type, whatever its storage.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/map/one_pixel_map.hpp"
#include "depthgrid/grid/map/pixel_list_map.hpp"

namespace depthgrid::grid {

/// Any storage of the map. Evaluation visits it once a call, not once a cell. All storages have
/// ray(u, v, k).confirm(n, depth_m) and camera_count().
using DepthGridMap = std::variant<ClosedFormMap, OnePixelMap, PixelListMap>;

/// The cameras of the rig other than `principal`, in the rig's order, relative to it. Throws Error when there is no
/// such camera.
[[nodiscard]] std::vector<SecondaryCamera> secondary_cameras(const Rig& rig, std::size_t principal);

/// Throws Error when the map was made for other cameras, another grid or other relative poses than these; the message
/// names the first number that differs (see kCalibrationTolerance).
void check_matches(const DepthGridMap& map, const DepthGrid& grid, std::span<const SecondaryCamera> secondaries);

}  // namespace depthgrid::grid
