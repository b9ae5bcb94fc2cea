// Quick start of the avoidance loop: arm, cameras and driver are stand-ins, what is yours is marked YOURS.
//
//   avoidance_quickstart [arm.urdf tool0]       your arm, and the link that follows the task; else the KUKA LWR 4+
//   find_package(depthgrid 0.1 REQUIRED COMPONENTS avoidance search simulation)    simulation: for the stand-ins
//
// Positions are in one world frame, that in which the cameras were calibrated. cycle() belongs to the robot's thread,
// frames() and update() to that of the cameras; here they take turns. Only construction throws, depthgrid::Error.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <stdexcept>

#include "depthgrid/avoidance/avoidance_loop.hpp"
#include "depthgrid/avoidance/history_port.hpp"
#include "depthgrid/avoidance/model_limits.hpp"
#include "depthgrid/control/polygon_task.hpp"
#include "depthgrid/control/simulated_arm.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/urdf.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "depthgrid/views/surveillance_radius.hpp"

using namespace depthgrid;
using Eigen::Vector3d;
using enum views::Policy;

namespace {

// YOURS: a camera's driver. This one draws a wall 4 m before the camera, the arm, and a ball of 0.3 m; metres.
DepthImage image(const RigCamera& camera, std::span<const Capsule> arm_world, const Vector3d& ball_world) {
  simulation::Scene scene;
  const Vector3d back = -camera.T_world_camera.linear().col(2);
  scene.add(simulation::Plane{back, back.dot(camera.T_world_camera.translation()) - 4.0});
  scene.add(Capsule::sphere(ball_world, 0.15));
  for (const Capsule& link : arm_world) {
    scene.add(link);
  }
  return scene.render(camera.intrinsics, camera.T_world_camera).depth_m;
}

int run(const robot::RobotModel& model, const std::string& tip_name) {
  // YOURS: where the arm's base stands, here on a table of 0.7 m and turned by 90 degrees.
  const robot::PlacedRobot robot{
      model, Eigen::Translation3d(0.3, 0.2, 0.7) * Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ())};
  avoidance::LoopSettings settings;
  settings.parts = tip_first(moving_capsules(model), model.link_index(tip_name));
  settings.end_effector_limits = true;  // the tip also approaches nothing faster than it may
  settings.evaluate_every = 5;          // periods; in between obstacles stand where they did
  // YOURS: the acceleration, which no URDF has: what each joint can always brake with, rad/s^2.
  const control::JointLimits limits = settings.controller.limits = avoidance::joint_limits(model, 5.0);
  const double period_s = settings.controller.period_s = 0.002;
  const double rho_m = settings.controller.repulsion.rho_m = settings.controller.body.rho_m = 0.4;
  settings.controller.body.law = control::BodyLaw::approach_row;
  // YOURS: where the arm stands at the start, here also where joints drift that the task leaves free.
  const control::JointVector q_start = settings.controller.posture_rad =
      0.4 * limits.lowest_rad + 0.6 * limits.highest_rad;
  // YOURS: the task, here two points that the tip visits in turn, for ever. Other tasks: examples/own_task.cpp.
  const Vector3d start_world =
      robot.link_poses({q_start.data(), model.joints().size()})[settings.parts[0].link].translation();
  control::PolygonTask task({.vertices_world = {start_world, start_world - Vector3d(0, 0, 0.2)}, .speed_m_s = 0.2});

  // YOURS: the cameras. Intrinsics as OpenCV or ROS give them; camera coordinates are x right, y down, z forward.
  const SensorModel& sensor = sensor_model("azure_kinect_nfov_binned");
  Rig rig;
  for (const Vector3d& place : {Vector3d(2.3, 1.6, 2.0), Vector3d(-1.9, 1.5, 2.0)}) {
    RigCamera& camera = rig.cameras.emplace_back();
    camera.id = "camera " + std::to_string(rig.cameras.size());
    camera.intrinsics = from_opencv(320, 288, 252.0, 252.0, 159.5, 143.5);
    camera.T_world_camera = look_at(place, {0.3, 0.2, 1.1});
    camera.rule = sensor.rule;
    camera.margins = sensor_margins(sensor, camera.intrinsics, camera.metres_per_unit);
    camera.margins->translation_m = 0.005;                             // calibration: where the camera stands
    camera.margins->rotation_rad = 0.002;                              // and looks
    camera.margins->smallest_obstacle_m = sensor.smallest_obstacle_m;  // what is smaller may be missed
  }

  // Where distances come from. What counts as an obstacle has no default (docs/search.md).
  views::Settings what;
  what.space = views::BoxSpace{{-1.5, -1.6, 0.2}, {2.1, 2.0, 2.6}};  // YOURS: the arm's reach and rho around it; world
  what.policies = {.unobserved = obstacle, .outside = obstacle, .robot_pockets = ignored, .ignored_pocket_m = 0.10};
  what.margins = camera_margins(rig);
  what.v_max_m_s = 1.6;  // a person who walks
  what.resolution_m = 0.01;
  // Until an image is here, until the next one, until the next evaluation: so old is what rho is asked of.
  const double greatest_age_s = 0.02 + 1.0 / 30 + settings.evaluate_every * period_s;
  // YOURS: how thick the layer around the arm is at most in which nothing is seen: loop.report().blind_m. The arm keeps
  // this layer, not only itself, away from what it sees.
  const double blind_m = 0.18;
  what.rho_m = views::surveillance_radius_m(rho_m, what.v_max_m_s, greatest_age_s, blind_m);
  // The first part, the tip, gets the direction that it is repelled along. YOURS: a budget of time (docs/avoidance.md).
  search::SearchEvaluator evaluator(rig, what, {.directions = 1});

  // What takes the arm out of the images: its positions of the last 2 s, and a padding. YOURS: the padding is no less
  // than the sensor's margin (intake.missing_padding_m()) and the errors of calibration and model, or the arm stops for
  // itself; what is nearer to it is not seen (docs/robot.md). The time error is that of the clocks, half the exposure
  // too.
  robot::JointHistory history(model.joints().size(), 1000, 0.02, 0.01);
  robot::ExposureSettings exposure{.removal = {.padding_m = 0.085}, .time_error_s = 0.005};
  exposure.joint_accelerations.assign(model.joints().size(), 10.0);  // YOURS: the greatest, protective stops included
  robot::FrameIntake intake(rig, robot, history, exposure);

  // YOURS: the arm's driver, a class derived from control::RobotPort: read() and write() (docs/avoidance.md).
  control::SimulatedArm arm(limits, period_s, q_start);
  avoidance::HistoryPort port(arm, history);
  avoidance::AvoidanceLoop loop(robot, task, evaluator, settings);
  bool working = loop.start(port);
  Vector3d tip_before_world = start_world;
  const auto print = [&] {
    // What the arm acts upon: from the surface of the blind layer, or nothing.
    const auto clear_m = [](const Answer& answer) {
      return control::obstacle_of(answer, control::BlindLayer::kept_clear).distance_m.value_or(0);
    };
    const auto nearer = [&](const auto& a, const auto& b) { return clear_m(a) < clear_m(b); };
    const auto nearest = std::min_element(loop.answers().begin(), loop.answers().end(), nearer);
    const std::size_t link = settings.parts[static_cast<std::size_t>(nearest - loop.answers().begin())].link;
    std::printf("%.1f s  ", loop.report().time_s);
    if (std::isnan(nearest->distance_now_m)) {
      std::printf("no images yet, distances are unknown");
    } else if (clear_m(*nearest) < rho_m) {  // "measured" is a surface, the other states are space not seen free
      std::printf("%s is %.3f m from the nearest obstacle (%s), of which %.3f m are blind",
                  model.links()[link].name.c_str(), nearest->distance_now_m,
                  std::string(to_string(nearest->nearest.state)).c_str(), loop.report().blind_m);
    } else {
      std::printf("nothing is nearer than %.1f m to the blind layer of %.3f m", rho_m, loop.report().blind_m);
    }
    std::printf("; tip moves at %.3f m/s, repulsion asks for %.3f m/s; fastest joint %.2f rad/s\n",
                (loop.report().end_effector_world - tip_before_world).norm() / period_s,
                loop.report().output.repulsion_m_s.norm(),
                loop.report().output.command.velocity_rad_s.cwiseAbs().maxCoeff());
  };
  for (int k = 0; k <= 1000; ++k) {
    const double now_s = k * period_s;  // YOURS: the cameras' clock
    // The robot's thread, every period. False: no state, or a command that was not taken; what then is yours.
    working = loop.cycle(port, now_s) && working;
    if (k % 250 == 0) {
      print();
    }
    tip_before_world = loop.report().end_effector_world;
    // The cameras' thread, when images have come, each with its own time. Here a ball comes for a second, and goes.
    if (k % 17 == 0) {
      const Vector3d ball_world = start_world + Vector3d(0, 0.40 + 0.9 * std::abs(now_s - 1.0), 0);
      const DepthImage first = image(rig.cameras[0], loop.parts_world(), ball_world);
      const DepthImage second = image(rig.cameras[1], loop.parts_world(), ball_world);
      const std::array<Frame, 2> seen{Frame{depth_view(first), {}, now_s}, {depth_view(second), {}, now_s}};
      working = update_all(evaluator, intake.frames(seen)).taken() && working;
    }
    arm.advance();
  }
  return working ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  // YOURS: where meshes are that the URDF calls package://NAME/...: load_urdf(file, {.packages = {{"NAME", "/path"}}}).
  if (argc == 2 || argc > 3) throw std::runtime_error("usage: avoidance_quickstart [ROBOT.urdf TIP_LINK]");
  return argc == 3 ? run(robot::RobotModel(robot::load_urdf(argv[1])), argv[2]) : run(robot::kuka_lwr4(), "lwr_7_link");
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
