#include "lab/recordings/gray_area.hpp"

#include <vector>

#include "depthgrid/grid/cell_carver.hpp"
#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/observation.hpp"

namespace depthgrid::lab {

namespace {

constexpr int kPixelStride = 8;
constexpr int kCellStride = 4;

/// Volume that one sampled cell stands for: its own times those that are skipped.
double cell_volume_m3(const PinholeCamera& camera, double d1_m, double d2_m) {
  return kPixelStride * kPixelStride * kCellStride * (d2_m * d2_m * d2_m - d1_m * d1_m * d1_m) /
         (3 * camera.fx_px * camera.fy_px);
}

}  // namespace

void add_gray_area(const Rig& rig, const CameraSet& cameras, std::span<const Frame> frames,
                   const grid::DepthQuantisation& quantisation, const Eigen::AlignedBox3d& workspace_floor,
                   GrayArea& area) {
  const RigCamera& principal = rig.cameras[cameras.front()];
  const grid::DepthGrid depth_grid(principal.intrinsics, quantisation);
  const auto others = secondaries(rig, cameras);
  const grid::ClosedFormMap map(depth_grid, others);
  const Pose T_floor_principal = rig.T_floor_world.value_or(Pose::Identity()) * principal.T_world_camera;

  const SensorMargin no_margin;
  std::vector<grid::Observation> observations;
  std::vector<grid::CellCarver> carvers;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const RigCamera& camera = rig.cameras[cameras[i]];
    observations.emplace_back(camera, &no_margin);
    observations.back().update(frames[cameras[i]]);
    carvers.emplace_back(camera.intrinsics, camera.T_world_camera.inverse() * principal.T_world_camera,
                         camera.rule.near_m, PoseMargin{});
  }

  for (int v = kPixelStride / 2; v < principal.intrinsics.height_px; v += kPixelStride) {
    for (int u = kPixelStride / 2; u < principal.intrinsics.width_px; u += kPixelStride) {
      const double measured_m = observations.front().measured_m().at(u, v);
      for (int n = 0; n < depth_grid.count(); n += kCellStride) {
        const double d1_m = depth_grid.boundary_m(n);
        const double d2_m = depth_grid.boundary_m(n + 1);
        const Eigen::Vector3d centre = deproject(principal.intrinsics, {u + 0.5, v + 0.5, 0.5 * (d1_m + d2_m)});
        if (!workspace_floor.contains(T_floor_principal * centre)) {
          continue;
        }
        const double volume_m3 = cell_volume_m3(principal.intrinsics, d1_m, d2_m);
        area.workspace_m3 += volume_m3;
        if (d1_m < measured_m) {
          continue;
        }
        area.gray_m3 += volume_m3;
        bool denied = false;
        bool known_free = false;
        for (std::size_t i = 1; i < cameras.size(); ++i) {
          denied = denied ||
                   map.ray(u, v, i - 1).confirm(n, observations[i].measured_m().data()) == grid::Confirmation::denied;
          known_free = known_free || carvers[i].frees(carvers[i].edges(depth_grid.cell(u, v, n)), d1_m, d2_m,
                                                      observations[i].free_m());
        }
        area.known_free_letter_m3 += denied ? volume_m3 : 0;
        area.known_free_corrected_m3 += known_free ? volume_m3 : 0;
      }
    }
  }
}

}  // namespace depthgrid::lab
