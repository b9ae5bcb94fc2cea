// A task of your own. AvoidanceLoop moves the tip along a polygon and nothing else; for any other task make the period
// yourself from the same parts. Here the tip follows a circle and keeps its orientation: a task of six rows.
//
//   find_package(depthgrid 0.1 REQUIRED COMPONENTS avoidance)
//   target_link_libraries(own_task PRIVATE depthgrid::avoidance)
//
// examples/avoidance_quickstart.cpp says where your arm, your cameras and the base's place go; here nothing is near.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <span>
#include <vector>

#include "depthgrid/avoidance/distance_source.hpp"
#include "depthgrid/control/controller.hpp"
#include "depthgrid/control/simulated_arm.hpp"
#include "depthgrid/robot/joint_history.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/robot_parts.hpp"

namespace avoidance = depthgrid::avoidance;
namespace control = depthgrid::control;
namespace robot = depthgrid::robot;
using depthgrid::Pose;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

constexpr double kPeriod_s = 0.002;

// Where the tip shall be at a time, and how fast it goes there.
struct Circle {
  Pose T_world_start;
  double radius_m = 0.1;
  double rad_s = 2.0;

  // In the plane y = const through the start, which is its highest point.
  Eigen::Vector3d place(double time_s) const {
    const double angle = rad_s * time_s;
    return T_world_start.translation() + radius_m * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle) - 1);
  }
  Eigen::Vector3d velocity(double time_s) const {
    const double angle = rad_s * time_s;
    return radius_m * rad_s * Eigen::Vector3d(std::cos(angle), 0, -std::sin(angle));
  }
};

// The rotation vector that turns the tip to how it stood at the start, world frame.
Eigen::Vector3d turn_left(const Circle& circle, const Pose& T_world_tip) {
  const Eigen::AngleAxisd turn(circle.T_world_start.linear() * T_world_tip.linear().transpose());
  return turn.angle() * turn.axis();
}

// What the task wants: velocity of the tip's point above the link's angular velocity, world frame. The point goes along
// with the circle and, where it has been driven away, returns to it no faster than 0.2 m/s; the orientation likewise.
Vector6 wanted_velocity(const Circle& circle, double time_s, const Pose& T_world_tip) {
  const Eigen::Vector3d back = 5.0 * (circle.place(time_s) - T_world_tip.translation());
  const Eigen::Vector3d turn = 5.0 * turn_left(circle, T_world_tip);
  Vector6 velocity;
  velocity << circle.velocity(time_s) + back / std::max(1.0, back.norm() / 0.2), turn / std::max(1.0, turn.norm());
  return velocity;
}

control::JointLimits limits_of_lwr() {
  constexpr double kDegree = std::numbers::pi / 180;
  control::JointLimits limits;
  limits.highest_rad.resize(7);
  limits.highest_rad << 170, 120, 170, 120, 170, 120, 170;
  limits.highest_rad *= kDegree;
  limits.lowest_rad = -limits.highest_rad;
  limits.velocity_rad_s = control::JointVector::Constant(7, kDegree * 110);
  limits.acceleration_rad_s2 = control::JointVector::Constant(7, kDegree * 300);
  return limits;
}

int run() {
  const robot::RobotModel model = robot::kuka_lwr4();
  const Pose T_world_base = Pose::Identity();  // the base is the world
  const std::size_t tip = model.link_index("lwr_7_link");
  const std::vector<robot::LinkCapsule> parts = robot::moving_capsules(model);  // the first is of the tip's link

  control::ControllerSettings settings;
  settings.limits = limits_of_lwr();
  settings.period_s = kPeriod_s;
  settings.body.law = control::BodyLaw::approach_row;
  control::JointVector q_start(7);
  q_start << 1.57, 0.1, 0.0, -1.55, 0.0, 1.2, 0.0;
  settings.posture_rad = q_start;
  control::Controller controller(settings);
  control::SimulatedArm arm(settings.limits, kPeriod_s, q_start);  // YOURS: a RobotPort
  robot::JointHistory history(7, 1000, 0.02, 0.01);                // for FrameIntake: where the arm was
  avoidance::NoDistances source;                                   // YOURS: SearchDistances, fed by FrameIntake

  // All that a period needs, allocated here.
  control::JointState state;
  std::vector<Pose> T_world_link(model.links().size(), Pose::Identity());
  std::vector<depthgrid::Capsule> parts_world(parts.size());
  std::vector<avoidance::PartAnswer> answers(parts.size());
  std::vector<control::BodyPoint> body(parts.size());
  robot::Jacobian jacobian(6, 7);
  control::Task task;
  Circle circle;

  if (!arm.read(state) || !controller.start(state)) {
    std::fprintf(stderr, "the robot gives no state\n");
    return 1;
  }
  for (int k = 0; k <= 1000; ++k) {
    const double now_s = k * kPeriod_s;
    // 1. Where the robot is. Without a state: what shall happen then is yours.
    if (!arm.read(state)) {
      std::fprintf(stderr, "%.3f s: the robot gives no state\n", now_s);
      return 1;
    }
    const std::span<const double> q(state.position_rad.data(), model.joints().size());
    (void)history.add(now_s, q);
    (void)model.link_poses(q, T_world_base, T_world_link);
    if (k == 0) {
      circle.T_world_start = T_world_link[tip];
    }
    // 2. How far its parts are from obstacles, and how each of the points in question moves with the joints.
    robot::place(parts, T_world_link, parts_world);
    source.evaluate(parts_world, now_s, answers);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      (void)model.jacobian(q, T_world_link, parts[i].link, answers[i].at_world, jacobian);
      body[i] = {jacobian.topRows<3>(), answers[i].obstacle};
    }
    // 3. The task. The controller adds the repulsion to its first three rows: these have to be the velocity of a point.
    (void)model.jacobian(q, T_world_link, tip, T_world_link[tip].translation(), jacobian);
    task.jacobian = jacobian;
    task.velocity = wanted_velocity(circle, now_s, T_world_link[tip]);
    // 4. The command. Tasks of lower priority go into further_tasks.
    const control::CycleOutput output =
        controller.cycle({.task = task, .end_effector = answers[0].obstacle, .body = body, .further_tasks = {}});
    if (!arm.write(output.command)) {
      std::fprintf(stderr, "%.3f s: the robot did not take the command\n", now_s);
    }
    if (k % 250 == 0) {
      std::printf("%.1f s  tip %.1f mm from its place on the circle, turned by %.2f degrees\n", now_s,
                  1000 * (T_world_link[tip].translation() - circle.place(now_s)).norm(),
                  turn_left(circle, T_world_link[tip]).norm() * 180 / std::numbers::pi);
    }
    arm.advance();
  }
  return 0;
}

}  // namespace

int main() try { return run(); } catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
