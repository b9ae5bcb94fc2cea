#include "lab/experiments/stage/rig_width.hpp"

#include "depthgrid/core/sensor_models.hpp"

namespace depthgrid::experiments {

Rig with_width(Rig rig, int width_px) {
  for (RigCamera& camera : rig.cameras) {
    const double scale = static_cast<double>(width_px) / camera.intrinsics.width_px;
    camera.intrinsics.width_px = width_px;
    camera.intrinsics.height_px = width_px / 4 * 3;
    camera.intrinsics.fx_px *= scale;
    camera.intrinsics.fy_px *= scale;
    camera.intrinsics.cx_px *= scale;
    camera.intrinsics.cy_px *= scale;
    if (camera.margins && !camera.sensor.empty()) {
      const double smallest_obstacle_m = camera.margins->smallest_obstacle_m;
      camera.margins = sensor_margins(sensor_model(camera.sensor), camera.intrinsics, camera.metres_per_unit);
      camera.margins->smallest_obstacle_m = smallest_obstacle_m;
    }
  }
  return rig;
}

}  // namespace depthgrid::experiments
