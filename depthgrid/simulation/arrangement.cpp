#include "depthgrid/simulation/arrangement.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"

namespace depthgrid::simulation {

namespace {

constexpr double kFocal = 525;
constexpr int kMaxCameras = 16;

RigCamera camera(int number, std::string_view sensor, const Pose& T_world_camera) {
  const SensorModel& model = sensor_model(sensor);
  RigCamera result;
  result.id = "camera " + std::to_string(number);
  result.intrinsics = from_opencv(640, 480, kFocal, kFocal, 319.5, 239.5);
  result.rule = model.rule;
  result.T_world_camera = T_world_camera;
  result.sensor = model.name;
  result.margins = sensor_margins(model, result.intrinsics, result.metres_per_unit);
  result.margins->smallest_obstacle_m = 0;  // nothing is assumed of what the cell will hold
  return result;
}

/// A camera 2 m from the robot along x on one side, half way up the workspace, looking horizontally: turned so that the
/// depth range of the workspace is exactly the grid's, and beside the x axis where that range begins at d_min.
Pose letter_pose(const Arrangement& letter, double side) {
  const Eigen::Vector3d size_m = letter.workspace_high_world - letter.workspace_low_world;
  const double range_m = letter.cells * letter.cell_m;
  // size_x cos t + size_y sin t = range, t the angle between the optical axis and x.
  const double turn_rad = std::atan2(size_m.y(), size_m.x()) - std::acos(range_m / std::hypot(size_m.x(), size_m.y()));
  constexpr double kDistance = 2.0;
  // The nearest corner is d_min deep: (distance - size_x / 2) cos t - (size_y / 2 - aside) sin t = d_min.
  const double aside_m =
      0.5 * size_m.y() - ((kDistance - 0.5 * size_m.x()) * std::cos(turn_rad) - letter.d_min_m) / std::sin(turn_rad);
  const double height_m = 0.5 * (letter.workspace_low_world.z() + letter.workspace_high_world.z());
  const Eigen::Vector3d position(side * kDistance, side * aside_m, height_m);
  return look_at(position, position - side * Eigen::Vector3d(std::cos(turn_rad), std::sin(turn_rad), 0));
}

WorkcellBody boxes(const char* name,
                   std::initializer_list<std::pair<Eigen::Vector3d, Eigen::Vector3d>> centre_and_size) {
  WorkcellBody body;
  body.name = name;
  for (const auto& [centre, size_m] : centre_and_size) {
    Box box;
    box.T_world_box.translation() = centre;
    box.half_size_m = 0.5 * size_m;
    body.boxes.push_back(box);
  }
  return body;
}

}  // namespace

Arrangement letter_arrangement(std::string_view sensor) { return arrangement(2, sensor); }

Arrangement arrangement(int cameras, std::string_view sensor) {
  if (cameras < 1 || cameras > kMaxCameras) {
    fail("arrangement of ", cameras, " cameras, must be 1 ... ", kMaxCameras);
  }
  Arrangement result;
  result.rig.name = cameras == 2 ? "the letter's two cameras" : std::to_string(cameras) + " cameras";
  result.rig.cameras.push_back(camera(1, sensor, letter_pose(result, -1)));
  if (cameras == 2) {
    result.rig.cameras.push_back(camera(2, sensor, letter_pose(result, 1)));
  }
  for (int i = 1; i < cameras && cameras > 2; ++i) {
    const double azimuth_rad = std::numbers::pi + 2 * std::numbers::pi * i / cameras;
    const double height_m = i % 2 == 0 ? 0.9 : 1.5;
    const Eigen::Vector3d position(2.4 * std::cos(azimuth_rad), 2.4 * std::sin(azimuth_rad), height_m);
    result.rig.cameras.push_back(camera(i + 1, sensor, look_at(position, {0, 0, 0.4})));
  }
  Pose T_floor_world = Pose::Identity();
  T_floor_world.translation().z() = -result.workspace_low_world.z();
  result.rig.T_floor_world = T_floor_world;
  return result;
}

Workcell empty_workcell() {
  Workcell cell;
  WorkcellBody room;
  room.name = "room";
  room.kind = BodyKind::room;
  room.planes.push_back({Eigen::Vector3d::UnitZ(), -0.5});
  for (const double side : {-1.0, 1.0}) {
    room.planes.push_back({side * Eigen::Vector3d::UnitX(), -3.2});
    room.planes.push_back({side * Eigen::Vector3d::UnitY(), -3.2});
  }
  cell.bodies.push_back(room);
  cell.bodies.push_back(boxes("pedestal", {{{0, 0, -0.26}, {0.30, 0.30, 0.48}}}));
  cell.bodies.push_back(boxes("table", {{{0, 0.75, -0.02}, {0.90, 0.50, 0.04}},
                                        {{-0.40, 0.55, -0.27}, {0.05, 0.05, 0.46}},
                                        {{0.40, 0.55, -0.27}, {0.05, 0.05, 0.46}},
                                        {{-0.40, 0.95, -0.27}, {0.05, 0.05, 0.46}},
                                        {{0.40, 0.95, -0.27}, {0.05, 0.05, 0.46}}}));
  cell.bodies.push_back(boxes("workpiece", {{{0.10, 0.70, 0.08}, {0.20, 0.15, 0.16}}}));
  return cell;
}

}  // namespace depthgrid::simulation
