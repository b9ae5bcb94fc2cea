#include "avoidance/kinect_cell.hpp"

#include <numbers>

#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/robot/placed_robot.hpp"
#include "depthgrid/simulation/arrangement.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"

namespace depthgrid::avoidance::test {

namespace {

/// The letter's two cameras with images of this width and the same view, and what is declared.
Rig rig_of(const KinectCellOptions& options) {
  Rig rig = simulation::letter_arrangement(options.sensor).rig;
  for (RigCamera& camera : rig.cameras) {
    PinholeCamera& image = camera.intrinsics;
    const double scale = static_cast<double>(options.width_px) / image.width_px;
    image = {options.width_px,    options.width_px / 4 * 3, scale * image.fx_px,
             scale * image.fy_px, scale * image.cx_px,      scale * image.cy_px};
    const SensorModel& model = sensor_model(options.sensor);
    camera.margins = sensor_margins(model, image, camera.metres_per_unit);
    camera.margins->smallest_obstacle_m = options.declared ? model.smallest_obstacle_m : 0;
    camera.margins->second_view_x_m = options.declared ? model.second_view_x_m : 0;
    camera.margins->half_exposure_s = options.declared ? 0.008 : camera.margins->half_exposure_s;
  }
  return rig;
}

}  // namespace

KinectCell kinect_cell(const KinectCellOptions& options, const std::vector<simulation::WorkcellBody>& more) {
  KinectCell result;
  result.rig = rig_of(options);
  const std::vector<double> q{std::numbers::pi / 2, 0.1, 0.0, -1.55, 0.0, 1.2, 0.0};
  const std::vector<Pose> T_world_link = robot::PlacedRobot{result.model}.link_poses(q);
  const auto links = robot::link_capsules(result.model);
  std::vector<Capsule> arm(links.size());
  robot::place(links, T_world_link, arm);
  simulation::Workcell cell = simulation::empty_workcell();
  cell.bodies.push_back(simulation::capsule_body("arm", simulation::BodyKind::robot, arm));
  cell.bodies.insert(cell.bodies.end(), more.begin(), more.end());
  const simulation::Scene scene = simulation::scene_of(cell);
  const std::size_t cameras = result.rig.cameras.size();
  std::vector<DepthImage> ideal_m;
  for (const RigCamera& camera : result.rig.cameras) {
    ideal_m.push_back(scene.render(camera.intrinsics, camera.T_world_camera).depth_m);
  }
  simulation::SimulatedSensors sensors(result.rig, {.seed = options.seed});
  result.images_m.resize(static_cast<std::size_t>(options.images) * cameras);
  for (std::size_t i = 0; i < static_cast<std::size_t>(options.images); ++i) {
    const std::span<DepthImage> measured_m = std::span(result.images_m).subspan(i * cameras, cameras);
    for (std::size_t k = 0; k < cameras; ++k) {
      measured_m[k] = DepthImage(options.width_px, options.width_px / 4 * 3);
    }
    sensors.measure(ideal_m, i, measured_m);
    EmptyCell& seen = result.cells.emplace_back();
    seen.T_world_link = T_world_link;
    for (const DepthImage& image_m : measured_m) {
      seen.seen.push_back({depth_view(image_m), {}, static_cast<double>(i) / 30});
    }
  }
  views::Settings& search = result.settings.search;
  const simulation::Arrangement letter = simulation::letter_arrangement(options.sensor);
  search.space = views::BoxSpace{letter.workspace_low_world, letter.workspace_high_world};
  search.policies = {.unobserved = views::Policy::obstacle,
                     .outside = views::Policy::obstacle,
                     .robot_pockets = views::Policy::obstacle};
  search.margins = camera_margins(result.rig);
  search.v_max_m_s = 2;
  search.resolution_m = 0.01;
  search.rho_m = 0.5;
  result.settings.removal.margin_in_test = options.margin_in_test;
  return result;
}

}  // namespace depthgrid::avoidance::test
