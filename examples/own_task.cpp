// A task of your own: a class that says in every period how the tip shall move. Here the tip follows a circle and keeps
// its orientation: a task of six rows.
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

#include "depthgrid/avoidance/avoidance_loop.hpp"
#include "depthgrid/avoidance/model_limits.hpp"
#include "depthgrid/avoidance/nothing_near.hpp"
#include "depthgrid/control/simulated_arm.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"

using namespace depthgrid;
using Eigen::Vector3d;

namespace {

// A circle in the plane y = const through the start, which is its highest point.
class Circle final : public control::MotionTask {
 public:
  explicit Circle(Pose T_world_start) : T_world_start_(std::move(T_world_start)) {}

  // The repulsion is added to the first three rows: these have to be the velocity of the tip's origin. The tip goes
  // along with the circle and, where it has been driven away, returns to it no faster than 0.2 m/s; the orientation
  // likewise.
  control::Task rows(const control::EndEffector& tip) noexcept override {
    const double angle = kSpeed_rad_s * tip.time_s;
    const Vector3d along = kRadius_m * kSpeed_rad_s * Vector3d(std::cos(angle), 0, -std::sin(angle));
    const Vector3d back = 5.0 * away(tip.T_world_tip, tip.time_s);
    const Vector3d turn = 5.0 * turned(tip.T_world_tip);
    control::TaskVector velocity(6);
    velocity << along + back / std::max(1.0, back.norm() / 0.2), turn / std::max(1.0, turn.norm());
    return {tip.jacobian, velocity};
  }

  // From the tip to its place on the circle.
  Vector3d away(const Pose& T_world_tip, double time_s) const {
    const double angle = kSpeed_rad_s * time_s;
    const Vector3d place = T_world_start_.translation() + kRadius_m * Vector3d(std::sin(angle), 0, std::cos(angle) - 1);
    return place - T_world_tip.translation();
  }

  // The rotation vector that turns the tip to how it stood at the start, world frame.
  Vector3d turned(const Pose& T_world_tip) const {
    const Eigen::AngleAxisd turn(T_world_start_.linear() * T_world_tip.linear().transpose());
    return turn.angle() * turn.axis();
  }

 private:
  static constexpr double kRadius_m = 0.1;
  static constexpr double kSpeed_rad_s = 2.0;
  Pose T_world_start_;
};

int run() {
  const robot::PlacedRobot robot{robot::kuka_lwr4()};  // the base is the world
  const std::size_t tip = robot.model.link_index("lwr_7_link");
  avoidance::LoopSettings settings;
  settings.parts = moving_capsules(robot.model);  // the first is of the tip's link
  settings.end_effector_limits = true;
  settings.controller.limits = avoidance::joint_limits(robot.model, 5.0);
  settings.controller.body.law = control::BodyLaw::approach_row;
  control::JointVector q_start(7);
  q_start << 1.57, 0.1, 0.0, -1.55, 0.0, 1.2, 0.0;
  settings.controller.posture_rad = q_start;

  Circle circle(robot.link_poses({q_start.data(), 7})[tip]);
  avoidance::NothingNear evaluator;  // YOURS: search::SearchEvaluator, fed by a FrameIntake
  avoidance::AvoidanceLoop loop(robot, circle, evaluator, settings);
  control::SimulatedArm arm(settings.controller.limits, settings.controller.period_s, q_start);  // YOURS: a RobotPort
  bool working = loop.start(arm);
  for (int k = 0; k <= 1000; ++k) {
    const double now_s = k * settings.controller.period_s;
    working = loop.cycle(arm, now_s) && working;
    if (k % 250 == 0) {
      const Pose& T_world_tip = loop.T_world_link()[tip];
      std::printf("%.1f s  tip %.1f mm from its place on the circle, turned by %.2f degrees\n", now_s,
                  1000 * circle.away(T_world_tip, now_s).norm(),
                  circle.turned(T_world_tip).norm() * 180 / std::numbers::pi);
    }
    arm.advance();
  }
  return working ? 0 : 1;
}

}  // namespace

int main() try { return run(); } catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
