#include "lab/experiments/stage/declared_rig.hpp"

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"

namespace depthgrid::experiments {

Rig with_declarations(Rig rig) {
  for (RigCamera& camera : rig.cameras) {
    const SensorModel& model = sensor_model(camera.sensor);
    if (!camera.margins) {
      fail("camera '", camera.id, "' has no margins to which anything could be declared");
    }
    camera.margins->smallest_obstacle_m = model.smallest_obstacle_m;
    camera.margins->second_view_x_m = model.second_view_x_m;
    camera.margins->half_exposure_s = kSimulatedHalfExposure_s;
  }
  return rig;
}

double thin_padding_m(std::string_view sensor) {
  constexpr double kLeast_m = 0.05;
  const SensorModel& model = sensor_model(sensor);
  return model.stereo ? 2 * kLeast_m : kLeast_m;
}

}  // namespace depthgrid::experiments
