// Quick start of the avoidance loop: your arm's URDF, your cameras, your driver. Here the arm and the cameras are
// stand-ins, so that the program runs as it is; what is yours is marked YOURS.
//
//   avoidance_quickstart                      the built-in KUKA LWR 4+
//   avoidance_quickstart arm.urdf tool0       your arm, and the link whose origin is moved along the task
//
//   find_package(depthgrid 0.1 REQUIRED COMPONENTS avoidance)
//   target_link_libraries(avoidance_quickstart PRIVATE depthgrid::avoidance)     brings search, robot and control along
//
// Frames   All positions are in one world frame: that in which the cameras were calibrated. T_world_base places the
//          robot in it, and is given twice: to the loop, and to what takes the robot out of the images.
// Threads  cycle() belongs to the robot's thread, frames() and take() to one other thread, that of the cameras. Here
//          they take turns in simulated time.
// Errors   construction throws depthgrid::Error; the loop afterwards throws nothing, allocates nothing, takes no lock.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <numbers>
#include <string>
#include <vector>

#include "depthgrid/avoidance/avoidance_loop.hpp"
#include "depthgrid/avoidance/search_distances.hpp"
#include "depthgrid/control/simulated_arm.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/urdf.hpp"

namespace avoidance = depthgrid::avoidance;
namespace control = depthgrid::control;
namespace robot = depthgrid::robot;
namespace search = depthgrid::search;
namespace views = depthgrid::views;
using depthgrid::Pose;

namespace {

constexpr double kPeriod_s = 0.002;           // between two commands
constexpr double kFrameTime_s = 1.0 / 30;     // between two images of a camera
constexpr double kImageLatency_s = 0.02;      // from the exposure until the image is here
constexpr double kRho_m = 0.4;                // nearer obstacles change the motion
constexpr double kFastestObstacle_m_s = 1.6;  // a person who walks
constexpr int kWidth = 320;
constexpr int kHeight = 288;

// YOURS: where the base link of the URDF stands in the cameras' world frame. Here the world is a mark on the floor, z
// up; the base stands on a table of 0.7 m and is turned by 90 degrees. From a calibration: pose_from_matrix().
Pose base_in_world() {
  Pose T_world_base = Pose::Identity();
  T_world_base.translation() = Eigen::Vector3d(0.3, 0.2, 0.7);
  T_world_base.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T_world_base;
}

// YOURS: the cameras. Intrinsics as OpenCV or ROS give them; T_world_camera maps camera (x right, y down, z forward) to
// world coordinates.
depthgrid::Rig two_cameras() {
  const depthgrid::SensorModel& sensor = depthgrid::sensor_model("azure_kinect_nfov_binned");
  depthgrid::Rig rig;
  rig.name = "cell";
  const std::array<Eigen::Vector3d, 2> places = {{{2.3, 1.6, 2.0}, {-1.9, 1.5, 2.0}}};
  for (const Eigen::Vector3d& place : places) {
    depthgrid::RigCamera& camera = rig.cameras.emplace_back();
    camera.id = "camera " + std::to_string(rig.cameras.size());
    camera.intrinsics = depthgrid::from_opencv(kWidth, kHeight, 252.0, 252.0, 159.5, 143.5);
    camera.T_world_camera = depthgrid::look_at(place, {0.3, 0.2, 1.1});
    camera.metres_per_unit = 0.001;
    camera.rule = sensor.rule;
    camera.margins = depthgrid::sensor_margins(sensor, camera.intrinsics, camera.metres_per_unit);
    camera.margins->translation_m = 0.005;  // calibration: where the camera stands
    camera.margins->rotation_rad = 0.002;   // and looks
  }
  return rig;
}

// YOURS: a camera's driver. This one draws a wall 4 m before the camera, the arm, and a ball of 0.3 m.
class MyCamera {
 public:
  MyCamera(const depthgrid::RigCamera& camera, const robot::RobotModel& model, const robot::JointHistory& history)
      : camera_(camera),
        arm_(model, history, camera.intrinsics, robot::link_capsules(model), drawn_arm()),
        pixels_(std::size_t{kWidth} * kHeight) {}

  // The image exposed at a time, in millimetres; good until the next call.
  depthgrid::DepthView image(double exposed_s, const Eigen::Vector3d& ball_world) {
    constexpr double kBallRadius_m = 0.15;
    const Eigen::Vector3d c = camera_.T_world_camera.inverse(Eigen::Isometry) * ball_world;
    const depthgrid::RobotView arm = arm_.find(exposed_s, camera_.T_world_camera).view;
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        double depth_m = 4.0;
        const Eigen::Vector3d ray = depthgrid::deproject(camera_.intrinsics, {u + 0.5, v + 0.5, 1.0});
        const double b = ray.dot(c) / ray.squaredNorm();
        const double root = b * b - (c.squaredNorm() - kBallRadius_m * kBallRadius_m) / ray.squaredNorm();
        if (root > 0) {
          depth_m = b - std::sqrt(root);
        }
        const double arm_m = arm.near_m != nullptr ? double{arm.near_m[v * arm.stride_px + u]} : 0.0;
        if (arm_m > 0) {
          depth_m = std::min(depth_m, arm_m);
        }
        pixels_[static_cast<std::size_t>(v * kWidth + u)] = static_cast<std::uint16_t>(std::lround(1000 * depth_m));
      }
    }
    return depthgrid::depth_view(pixels_, kWidth, kHeight, camera_.metres_per_unit);
  }

 private:
  static robot::ExposureSettings drawn_arm() {
    robot::ExposureSettings settings;
    settings.T_world_base = base_in_world();
    settings.removal.whole_pixels = false;
    return settings;
  }

  depthgrid::RigCamera camera_;
  robot::RobotAtExposure arm_;
  std::vector<std::uint16_t> pixels_;
};

// YOURS: the arm's driver goes in here. Both functions are called once a period, by the thread that calls cycle();
// neither may throw or wait. The order of the joints is that of model.joints().
class MyArm final : public control::RobotPort {
 public:
  MyArm(const control::JointLimits& limits, const control::JointVector& q) : arm_(limits, kPeriod_s, q) {}

  // Joint positions (rad) and velocities (rad/s) as measured now. False when there are none: `state` stays untouched.
  bool read(control::JointState& state) noexcept override { return arm_.read(state); }

  // Where the joints shall be one period from now, within all limits. False when the robot did not take it.
  bool write(const control::JointCommand& command) noexcept override { return arm_.write(command); }

  void wait_for_next_period() noexcept { arm_.advance(); }

 private:
  control::SimulatedArm arm_;
};

// Ranges and speeds stand in the URDF. YOURS: accelerations, which no URDF has: what each joint can always brake with.
control::JointLimits joint_limits(const robot::RobotModel& model) {
  const std::vector<robot::Joint>& joints = model.joints();
  if (joints.size() > control::kMostJoints) {
    depthgrid::fail(model.source(), ": ", joints.size(), " joints, the controller takes ", control::kMostJoints);
  }
  control::JointLimits limits;
  const auto count = static_cast<Eigen::Index>(joints.size());
  limits.lowest_rad.resize(count);
  limits.highest_rad.resize(count);
  limits.velocity_rad_s.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const robot::Joint& joint = joints[static_cast<std::size_t>(i)];
    if (!std::isfinite(joint.max_speed)) {
      depthgrid::fail(model.source(), ": joint ", joint.name, " has no speed limit; add velocity to its <limit>");
    }
    limits.lowest_rad[i] = std::max(joint.lower, -1000.0);  // continuous joints have no end, the controller wants one
    limits.highest_rad[i] = std::min(joint.upper, 1000.0);
    limits.velocity_rad_s[i] = joint.max_speed;
  }
  limits.acceleration_rad_s2 = control::JointVector::Constant(count, 5.0);
  return limits;
}

// What distances are asked for: the capsules of all links that two joints or more move. The first part is the end
// effector: the origin of its link is what follows the task and is repelled. A tip link without a shape gets a point.
std::vector<robot::LinkCapsule> parts_of(const robot::RobotModel& model, std::size_t tip_link) {
  std::vector<robot::LinkCapsule> parts = robot::moving_capsules(model);
  const auto tip = std::find_if(parts.begin(), parts.end(), [&](const auto& part) { return part.link == tip_link; });
  if (tip == parts.end()) {
    parts.insert(parts.begin(), {tip_link, {}});
  } else {
    std::rotate(parts.begin(), tip, tip + 1);
  }
  return parts;
}

void print(double time_s, const robot::RobotModel& model, const avoidance::LoopSettings& settings,
           const avoidance::AvoidanceLoop& loop, double tip_m_s) {
  // Where it is unknown the control laws count it as 0.
  const auto distance_m = [&](std::size_t i) { return loop.answers()[i].obstacle.distance_m.value_or(0); };
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < loop.answers().size(); ++i) {
    nearest = distance_m(i) < distance_m(nearest) ? i : nearest;
  }
  if (!loop.answers()[nearest].obstacle.distance_m) {
    std::printf("%.1f s  no images yet, distances are unknown", time_s);
  } else if (distance_m(nearest) < kRho_m) {
    // "measured" is a surface; "occluded", "unobserved" and the like are space that nobody has seen free.
    const auto state = depthgrid::to_string(loop.answers()[nearest].nearest.state);
    std::printf("%.1f s  %s is %.3f m from the nearest obstacle (%.*s)", time_s,
                model.links()[settings.parts[nearest].link].name.c_str(), distance_m(nearest),
                static_cast<int>(state.size()), state.data());
  } else {
    std::printf("%.1f s  nothing is nearer than %.1f m", time_s, kRho_m);
  }
  const control::CycleOutput& output = loop.report().output;
  std::printf("; tip moves at %.3f m/s, repulsion asks for %.3f m/s; fastest joint %.2f rad/s\n", tip_m_s,
              output.repulsion_m_s.norm(), output.command.velocity_rad_s.cwiseAbs().maxCoeff());
}

int run(const robot::RobotModel& model, const std::string& tip_name) {
  const Pose T_world_base = base_in_world();
  const std::size_t tip_link = model.link_index(tip_name);
  const control::JointLimits limits = joint_limits(model);

  // Where the arm stands when it starts: posture and task are made from it. YOURS: as your arm says.
  const control::JointVector q_start = 0.4 * limits.lowest_rad + 0.6 * limits.highest_rad;
  std::vector<Pose> T_world_link(model.links().size(), Pose::Identity());
  (void)model.link_poses({q_start.data(), model.joints().size()}, T_world_base, T_world_link);
  const Eigen::Vector3d tip_start_world = T_world_link[tip_link].translation();

  // 1. The loop's settings.
  avoidance::LoopSettings settings;
  settings.T_world_base = T_world_base;
  settings.parts = parts_of(model, tip_link);
  settings.end_effector_limits = true;  // the tip also approaches nothing faster than it may
  settings.evaluate_every = 5;          // periods; in between obstacles stand where they did
  settings.controller.limits = limits;
  settings.controller.period_s = kPeriod_s;
  settings.controller.posture_rad = q_start;  // where joints drift that the task leaves free
  settings.controller.repulsion.rho_m = kRho_m;
  settings.controller.body.rho_m = kRho_m;
  settings.controller.body.law = control::BodyLaw::approach_row;
  // YOURS: the task, two or more points that the tip visits in turn, for ever. Other tasks: examples/own_task.cpp.
  settings.task.vertices_world = {tip_start_world, tip_start_world + Eigen::Vector3d(0, 0, -0.2)};
  settings.task.speed_m_s = 0.2;

  // 2. Where distances come from. What counts as an obstacle has no default (docs/search.md).
  const depthgrid::Rig rig = two_cameras();
  views::Settings what;
  what.space = views::BoxSpace{{-1.5, -1.6, 0.2}, {2.1, 2.0, 2.6}};  // YOURS: the arm's reach and rho around it; world
  what.policies.unobserved = views::Policy::obstacle;
  what.policies.outside = views::Policy::obstacle;
  what.policies.robot_pockets = views::Policy::ignored;
  what.policies.ignored_pocket_m = 0.10;
  what.margins = depthgrid::camera_margins(rig);
  what.v_max_m_s = kFastestObstacle_m_s;
  what.resolution_m = 0.01;
  // The loop subtracts what may have come nearer since the exposure: with this much more, kRho_m is left.
  what.rho_m = kRho_m + kFastestObstacle_m_s * (kImageLatency_s + kFrameTime_s + settings.evaluate_every * kPeriod_s);
  // YOURS: on a real arm end an evaluation within the period, {.nodes = 0, .time_s = 0.0012}. Here time waits.
  avoidance::SearchDistances source(rig, what, settings.parts.size(), {.nodes = 0, .time_s = 0});

  // 3. Joint positions of the last moments, on the cameras' clock: how many joints, how many samples are kept (2 s),
  //    the longest gap to interpolate over, and how long the newest sample may stand for later exposures, seconds.
  robot::JointHistory history(model.joints().size(), 1000, 0.02, 0.01);

  // 4. What takes the arm out of the images.
  robot::ExposureSettings exposure;
  exposure.T_world_base = T_world_base;
  // YOURS: no less than the sensor's margin (64 mm here) and the errors of calibration and model, or the arm is taken
  // for an obstacle and stops; what is nearer to it than this is not seen (docs/robot.md).
  exposure.removal.padding_m = 0.085;
  exposure.time_error_s = 0.005;  // between the clocks of joints and cameras, half the exposure included
  robot::FrameIntake intake(rig, model, history, exposure);

  avoidance::AvoidanceLoop loop(model, history, source, settings);
  MyArm arm(limits, q_start);
  if (!loop.start(arm)) {
    std::fprintf(stderr, "the robot gives no state\n");
    return 1;
  }
  std::array<MyCamera, 2> cameras = {MyCamera(rig.cameras[0], model, history),
                                     MyCamera(rig.cameras[1], model, history)};
  Eigen::Vector3d tip_before_world = tip_start_world;
  for (int k = 0; k <= 1000; ++k) {
    const double now_s = k * kPeriod_s;  // YOURS: the cameras' clock

    // The cameras' thread: all images of one instant, when they have come. Before the first ones nothing is known, and
    // the arm stands still.
    const double exposed_s = now_s - kImageLatency_s;
    const bool new_images = std::floor(exposed_s / kFrameTime_s) > std::floor((exposed_s - kPeriod_s) / kFrameTime_s);
    if (exposed_s >= 0 && new_images) {
      // The ball comes towards the arm for a second, and goes away again.
      const Eigen::Vector3d ball_world =
          tip_start_world + Eigen::Vector3d(0, 0.40 + 0.7 * std::abs(exposed_s - 1.0), 0);
      const std::array<depthgrid::DepthView, 2> images = {cameras[0].image(exposed_s, ball_world),
                                                          cameras[1].image(exposed_s, ball_world)};
      if (!source.take(intake.frames(images, exposed_s))) {
        std::fprintf(stderr, "%.3f s: an image could not be used\n", now_s);
      }
    }

    // The robot's thread, every period. False: no state, a command that was not taken, or a clock that went back. The
    // loop goes on, from the last state; what the robot shall do then is yours.
    if (!loop.cycle(arm, now_s)) {
      std::fprintf(stderr, "%.3f s: the robot did not answer\n", now_s);
    }
    const Eigen::Vector3d tip_world = loop.report().end_effector_world;
    if (k % 250 == 0) {
      print(now_s, model, settings, loop, (tip_world - tip_before_world).norm() / kPeriod_s);
    }
    tip_before_world = tip_world;
    arm.wait_for_next_period();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 1 && argc != 3) {
    std::fprintf(stderr, "usage: avoidance_quickstart [URDF TIP_LINK]\n");
    return 2;
  }
  // YOURS: where the meshes are, if the URDF says package://NAME/... and stands in no folder of that name:
  // load_urdf(file, {.packages = {{"NAME", "/path/of/NAME"}}}).
  return argc == 3 ? run(robot::RobotModel(robot::load_urdf(argv[1])), argv[2]) : run(robot::kuka_lwr4(), "lwr_7_link");
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
