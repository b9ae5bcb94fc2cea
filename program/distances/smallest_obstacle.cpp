#include "program/distances/smallest_obstacle.hpp"

#include <cmath>
#include <sstream>

#include "depthgrid/core/plausibility.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

struct Declared {
  double size_m;
  std::string by;
};

Declared declared(std::optional<double> own_m, const std::optional<std::string>& sensor, const RigCamera& camera,
                  double rig_file_m) {
  if (own_m) {
    CameraMargins stated;
    stated.smallest_obstacle_m = *own_m;
    as_usage([&stated] { check_plausible(stated, "--smallest-obstacle"); });
    return {*own_m, "--smallest-obstacle"};
  }
  if (!std::isnan(rig_file_m)) {
    return {rig_file_m, "the rig file"};
  }
  const std::string name = sensor.value_or(camera.sensor);
  if (name.empty()) {
    return {0.0, "nothing is said of it"};
  }
  const SensorModel& model = sensor_model(name);
  return {model.smallest_obstacle_m, "recommended for " + std::string(model.name)};
}

std::string text_of(const Declared& declared) {
  std::ostringstream text;
  text << declared.size_m << " m (" << declared.by << ')';
  return text.str();
}

}  // namespace

std::string declare_smallest_obstacles(std::optional<double> own_m, const std::optional<std::string>& sensor,
                                       const Rig& rig, std::vector<CameraMargins>& margins) {
  std::string first;
  std::string all;
  bool same = true;
  bool assumes = false;
  for (std::size_t k = 0; k < margins.size(); ++k) {
    const Declared camera = declared(own_m, sensor, rig.cameras[k], margins[k].smallest_obstacle_m);
    margins[k].smallest_obstacle_m = camera.size_m;
    const std::string text = text_of(camera);
    first = k == 0 ? text : first;
    same = same && text == first;
    assumes = assumes || camera.size_m > 0;
    all += (k == 0 ? "" : ", ") + ("'" + rig.cameras[k].id + "' ") + text;
  }
  return "smallest obstacle: " + (same ? first : all) +
         (assumes
              ? "; what is smaller may be missed where a camera has no reading; --smallest-obstacle 0 assumes nothing"
              : "; every pixel without reading is an obstacle");
}

}  // namespace depthgrid::program
