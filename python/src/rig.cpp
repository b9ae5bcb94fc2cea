// Rigs and cameras.
#include "depthgrid/core/rig.hpp"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/files/rig_file.hpp"
#include "parts.hpp"

namespace depthgrid::python {
namespace {

using namespace nb::literals;

RigCamera make_camera(const std::string& id, int width_px, int height_px, double fx_px, double fy_px, double cx_px,
                      double cy_px, nb::handle T_world_camera, const std::optional<std::string>& sensor,
                      double metres_per_unit, std::optional<double> near_m, std::optional<double> far_m,
                      std::optional<double> translation_m, std::optional<double> rotation_rad,
                      std::optional<double> half_exposure_s, std::optional<double> time_uncertainty_s,
                      std::optional<double> smallest_obstacle_m) {
  RigCamera camera;
  camera.id = id;
  camera.intrinsics = from_opencv(width_px, height_px, fx_px, fy_px, cx_px, cy_px);
  camera.T_world_camera = pose_of(T_world_camera, "T_world_camera");
  camera.metres_per_unit = metres_per_unit;
  if (sensor) {
    const SensorModel& model = sensor_model(*sensor);
    camera.sensor = std::string(model.name);
    camera.rule = model.rule;
    camera.margins = sensor_margins(model, camera.intrinsics, metres_per_unit);
  } else if (translation_m || rotation_rad || half_exposure_s || time_uncertainty_s || smallest_obstacle_m) {
    fail("camera '", id,
         "': errors are stated but no sensor, whose own are missing then; sensor='ideal' says that it has none");
  }
  camera.rule.near_m = near_m.value_or(camera.rule.near_m);
  camera.rule.far_m = far_m.value_or(camera.rule.far_m);
  if (camera.margins) {
    camera.margins->translation_m = translation_m.value_or(camera.margins->translation_m);
    camera.margins->rotation_rad = rotation_rad.value_or(camera.margins->rotation_rad);
    camera.margins->half_exposure_s = half_exposure_s.value_or(camera.margins->half_exposure_s);
    camera.margins->time_uncertainty_s = time_uncertainty_s.value_or(camera.margins->time_uncertainty_s);
    camera.margins->smallest_obstacle_m = smallest_obstacle_m.value_or(camera.margins->smallest_obstacle_m);
  }
  validate(Rig{.name = "rig", .cameras = {camera}, .T_floor_world = std::nullopt});
  return camera;
}

Doubles matrix_of(const Pose& pose) {
  std::vector<double> values(16);
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data()) = pose.matrix();
  return doubles(std::move(values), 4);
}

}  // namespace

void add_rig(nb::module_& module) {
  nb::class_<RigCamera>(module, "Camera", "One calibrated depth camera.")
      .def(
          "__init__",
          [](RigCamera* self, const std::string& id, int width_px, int height_px, double fx_px, double fy_px,
             double cx_px, double cy_px, nb::object T_world_camera, const std::optional<std::string>& sensor,
             double metres_per_unit, std::optional<double> near_m, std::optional<double> far_m,
             std::optional<double> translation_m, std::optional<double> rotation_rad,
             std::optional<double> half_exposure_s, std::optional<double> time_uncertainty_s,
             std::optional<double> smallest_obstacle_m) {
            new (self) RigCamera(make_camera(id, width_px, height_px, fx_px, fy_px, cx_px, cy_px, T_world_camera,
                                             sensor, metres_per_unit, near_m, far_m, translation_m, rotation_rad,
                                             half_exposure_s, time_uncertainty_s, smallest_obstacle_m));
          },
          "id"_a, nb::kw_only(), "width_px"_a, "height_px"_a, "fx_px"_a, "fy_px"_a, "cx_px"_a, "cy_px"_a,
          "T_world_camera"_a, "sensor"_a = nb::none(), "metres_per_unit"_a = 0.001, "near_m"_a = nb::none(),
          "far_m"_a = nb::none(), "translation_m"_a = nb::none(), "rotation_rad"_a = nb::none(),
          "half_exposure_s"_a = nb::none(), "time_uncertainty_s"_a = nb::none(), "smallest_obstacle_m"_a = nb::none(),
          "Intrinsics as OpenCV and ROS state them (pixel 0's centre is 0), of images without distortion.\n\n"
          "T_world_camera: 4 x 4, metres; x right, y down, z forward.\n"
          "sensor: a model of sensor_models(), which says how far readings may err and the range; None: nothing is "
          "said.\n"
          "translation_m, rotation_rad: errors of the pose; half_exposure_s: half the time of an exposure; "
          "time_uncertainty_s: of its time stamps.\n"
          "smallest_obstacle_m: no obstacle is smaller; 0 says nothing. Has to be said here or to the evaluator.\n"
          "Raises Error with the value, the rule and a hint.")
      .def_ro("id", &RigCamera::id)
      .def_prop_ro("width_px", [](const RigCamera& camera) { return camera.intrinsics.width_px; })
      .def_prop_ro("height_px", [](const RigCamera& camera) { return camera.intrinsics.height_px; })
      .def_prop_ro(
          "T_world_camera", [](const RigCamera& camera) { return matrix_of(camera.T_world_camera); },
          nb::rv_policy::move, "4 x 4, metres.")
      .def_ro("sensor", &RigCamera::sensor, "The sensor model; empty: none.")
      .def_ro("metres_per_unit", &RigCamera::metres_per_unit, "Of uint16 images.")
      .def("__repr__", [](const RigCamera& camera) {
        return "<depthgrid.Camera '" + camera.id + "' " + std::to_string(camera.intrinsics.width_px) + " x " +
               std::to_string(camera.intrinsics.height_px) + ">";
      });

  nb::class_<Rig>(module, "Rig", "Calibrated cameras in one world frame, metres.")
      .def(
          "__init__",
          [](Rig* self, const std::vector<RigCamera>& cameras, const std::string& name) {
            Rig rig{.name = name, .cameras = cameras, .T_floor_world = std::nullopt};
            validate(rig);
            new (self) Rig(std::move(rig));
          },
          "cameras"_a, nb::kw_only(), "name"_a = "rig", "Raises Error where ids are not distinct.")
      .def_static(
          "load", [](const std::filesystem::path& file) { return files::load_rig(file).rig; }, "file"_a,
          nb::sig("def load(file: str | os.PathLike[str]) -> Rig"),
          "From a rig file (docs/rig-file.md). Raises Error that names file, place, value and rule.")
      .def_static(
          "parse", [](std::string_view text) { return files::parse_rig(text, "text").rig; }, "text"_a,
          "From the text of a rig file.")
      .def_ro("name", &Rig::name)
      .def_ro("cameras", &Rig::cameras)
      .def("__len__", [](const Rig& rig) { return rig.cameras.size(); })
      .def("__repr__", [](const Rig& rig) {
        return "<depthgrid.Rig '" + rig.name + "', " + std::to_string(rig.cameras.size()) + " cameras>";
      });

  module.def(
      "sensor_models",
      [] {
        nb::dict models;
        for (const SensorModel& model : sensor_models()) {
          models[nb::str(model.name.data(), model.name.size())] =
              nb::str(model.description.data(), model.description.size());
        }
        return models;
      },
      nb::sig("def sensor_models() -> dict[str, str]"), "Names of the sensor models, and a line about each.");
}

}  // namespace depthgrid::python
