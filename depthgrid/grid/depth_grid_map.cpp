#include "depthgrid/grid/depth_grid_map.hpp"

#include <string>

#include "depthgrid/core/error.hpp"

namespace depthgrid::grid {

std::vector<SecondaryCamera> secondary_cameras(const Rig& rig, std::size_t principal) {
  if (principal >= rig.cameras.size()) {
    fail("rig '", rig.name, "': principal camera is ", principal, ", the rig has ", rig.cameras.size(), " cameras");
  }
  const Pose& T_world_principal = rig.cameras[principal].T_world_camera;
  std::vector<SecondaryCamera> secondaries;
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    if (k != principal) {
      const RigCamera& camera = rig.cameras[k];
      secondaries.push_back({camera.intrinsics, camera.T_world_camera.inverse() * T_world_principal});
    }
  }
  return secondaries;
}

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
