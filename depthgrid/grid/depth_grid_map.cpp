#include "depthgrid/grid/depth_grid_map.hpp"

#include <string>

#include "depthgrid/core/error.hpp"

namespace depthgrid::grid {

void check_matches(const DepthGridMap& map, const DepthGrid& grid, std::span<const SecondaryCamera> secondaries) {
  if (const auto* closed_form = std::get_if<ClosedFormMap>(&map)) {
    // It keeps no intrinsics and poses but what it derives from them.
    if (!(*closed_form == ClosedFormMap(grid, secondaries))) {
      fail("depth grid map: the closed form was made for another calibration or depth grid; make it again");
    }
    return;
  }
  const MapCalibration& made_for = std::holds_alternative<OnePixelMap>(map) ? std::get<OnePixelMap>(map).calibration()
                                                                            : std::get<PixelListMap>(map).calibration();
  const std::string mismatch = difference(made_for, map_calibration(grid, secondaries));
  if (!mismatch.empty()) {
    fail("depth grid map: was made for another calibration: ", mismatch, "; build it again");
  }
}

}  // namespace depthgrid::grid
