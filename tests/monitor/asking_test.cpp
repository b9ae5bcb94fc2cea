// One question by hand: what it says, that it is never too far, and that it allocates nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/monitor/asking_line.hpp"
#include "depthgrid/monitor/camera_line.hpp"
#include "depthgrid/monitor/joint_line.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/simulated_camera.hpp"
#include "depthgrid/sensors/simulated_joints.hpp"
#include "monitor/small_cell.hpp"
#include "support/allocation_guard.hpp"

namespace depthgrid::monitor {
namespace {

using avoidance::MotionLimit;

/// What a monitor consists of, but that nobody asks by itself.
struct Cell {
  /// As long as nothing else is said no image and no joint state gets too old, however slow the machine is.
  explicit Cell(double ages_s = 30, double time_error_s = 0.005)
      : setup(cell::setup(cell::parse_cell(test::small_cell(), "small.yaml"))) {
    setup.exposure.time_error_s = time_error_s;
    setup.options.max_image_age_s = ages_s;
    sensors::SimulatedCellSettings scene;
    scene.robot = setup.robot;
    simulated = std::make_shared<const sensors::SimulatedCell>(scene);
    history.emplace(7, 2000, ages_s, ages_s);
    intake.emplace(setup.rig, *setup.robot, *history, setup.exposure);
    evaluator.emplace(setup.rig, setup.settings, setup.options);
    joints.emplace(std::make_unique<sensors::SimulatedJoints>(simulated, 100), *history, ages_s);
    for (std::size_t k = 0; k < 2; ++k) {
      CameraLineSettings settings;
      settings.camera = k;
      settings.max_image_age_s = setup.options.max_image_age_s;
      lines.push_back(std::make_unique<CameraLine>(
          std::make_unique<sensors::SimulatedCamera>(simulated, setup.rig.cameras[k], 20, k), setup.rig.cameras[k],
          settings, *evaluator, &*intake));
    }
    asking.emplace(setup, StopRule{.stop_m = 0.1, .hold_s = 0}, *evaluator, &*history, lines);
  }

  /// Every source in a thread of its own, for so long.
  void run(double seconds) {
    std::vector<std::jthread> threads;
    threads.emplace_back([this](const std::stop_token& stop) { joints->run(stop); });
    for (const auto& line : lines) {
      threads.emplace_back([&line = *line](const std::stop_token& stop) { line.run(stop); });
    }
    (void)sensors::wait_until(sensors::clock_now_s() + seconds, seconds);
  }

  cell::CellSetup setup;
  std::shared_ptr<const sensors::SimulatedCell> simulated;
  std::optional<robot::JointHistory> history;
  std::optional<robot::FrameIntake> intake;
  std::optional<search::SearchEvaluator> evaluator;
  std::optional<JointLine> joints;
  std::vector<std::unique_ptr<CameraLine>> lines;
  std::optional<AskingLine> asking;
};

TEST(Asking, BeforeAnythingCameItSaysStopAndWhy) {
  Cell cell;
  const CellAnswer& answer = cell.asking->ask(sensors::clock_now_s());
  EXPECT_TRUE(answer.stop);
  EXPECT_EQ(answer.reason.limit, MotionLimit::no_joint_state);
  EXPECT_TRUE(std::isnan(answer.distance_m));
  EXPECT_TRUE(std::isnan(answer.joints_age_s));
  EXPECT_EQ(answer.sequence, 1U);
  EXPECT_TRUE(answer.cameras[0].late) << "without an image there is none that counts";
}

TEST(Asking, AllocatesNothing) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  Cell cell;
  cell.run(0.4);
  const test::AllocationGuard guard;
  for (int i = 0; i < 50; ++i) {
    (void)cell.asking->ask(sensors::clock_now_s());
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_GT(cell.asking->answers(), 0U);
}

TEST(Asking, AClockThatStandsStillSaysStop) {
  Cell cell;
  cell.run(0.4);
  const double now_s = sensors::clock_now_s();
  EXPECT_NE(cell.asking->ask(now_s).reason.limit, MotionLimit::clock);
  EXPECT_EQ(cell.asking->ask(now_s).reason.limit, MotionLimit::clock);
  EXPECT_TRUE(cell.asking->answer().stop);
  EXPECT_EQ(cell.asking->ask(now_s - 1).reason.limit, MotionLimit::clock);
}

TEST(Asking, NoAnswerIsFartherThanTheTruth) {
  Cell cell;
  for (int round = 0; round < 6; ++round) {
    cell.run(0.25);
    const CellAnswer& answer = cell.asking->ask(sensors::clock_now_s());
    const simulation::Scene truth = cell.simulated->scene_at(answer.time_s - cell.simulated->begin_s());
    ASSERT_TRUE(std::isfinite(answer.distance_m));
    for (std::size_t i = 0; i < answer.parts.size(); ++i) {
      // Points of the axis: the part is at least as near as any of them.
      const Capsule& part = answer.parts_world[i];
      double truth_m = std::numeric_limits<double>::infinity();
      for (int step = 0; step <= 10; ++step) {
        const Eigen::Vector3d at = part.a + 0.1 * step * (part.b - part.a);
        truth_m = std::min(truth_m, truth.distance(at).distance_m - part.radius_m);
      }
      // What is nearer than the layer is thick may have been taken for the robot.
      if (truth_m > answer.parts[i].blind_m) {
        EXPECT_LE(answer.parts[i].distance_now_m, truth_m) << "part " << i;
      }
    }
  }
}

// The joints' clock may be off by what the cell declares: the arm may be where it was, or will be, so much earlier or
// later.
TEST(Asking, PartsHoldTheArmHoweverItsClockIsOff) {
  constexpr double kTimeError_s = 0.02;
  Cell cell(30, kTimeError_s);
  const robot::RobotModel& model = cell.setup.robot->model;
  const auto q_at = [&](double time_s) {
    std::vector<double> q(model.joints().size());
    for (std::size_t j = 0; j < q.size(); ++j) {
      q[j] = 0.1 * static_cast<double>(j) + 0.8 * time_s;
    }
    return q;
  };
  for (int n = 0; n <= 100; ++n) {
    ASSERT_TRUE(cell.history->add(10 + 0.01 * n, q_at(0.01 * n)));
  }
  const CellAnswer& answer = cell.asking->ask(11);
  std::size_t compared = 0;
  for (const double off_s : {-kTimeError_s, 0.0, kTimeError_s}) {
    std::vector<Pose> T_world_link(model.links().size(), Pose::Identity());
    ASSERT_TRUE(cell.setup.robot->link_poses(q_at(1 + off_s), T_world_link));
    for (std::size_t i = 0; i < answer.parts_world.size(); ++i) {
      if (!cell.setup.parts[i].on_robot) {
        continue;
      }
      const robot::LinkCapsule& link = *cell.setup.parts[i].on_robot;
      for (const Eigen::Vector3d& end : {link.capsule.a, link.capsule.b}) {
        const Eigen::Vector3d at = T_world_link[link.link] * end;
        EXPECT_LE(distance_to_axis(answer.parts_world[i], at) + link.capsule.radius_m,
                  answer.parts_world[i].radius_m + 1e-9)
            << cell.setup.parts[i].name << " at " << off_s;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 12U);
}

TEST(Asking, AgesAndSkewAreThoseOfTheImages) {
  constexpr double kAges_s = 1.5;
  Cell cell(kAges_s);
  cell.run(0.4);
  (void)sensors::wait_until(sensors::clock_now_s() + 0.1, 1);
  const double now_s = sensors::clock_now_s();
  const CellAnswer& answer = cell.asking->ask(now_s);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(answer.cameras.at(k).age_s, now_s - cell.evaluator->image_time_s(k));
    EXPECT_GE(answer.cameras.at(k).age_s, 0.1);
    EXPECT_FALSE(answer.cameras.at(k).late);
  }
  // Joints are as old: the links are asked for where they can have gone meanwhile.
  EXPECT_GE(answer.joints_age_s, 0.1);
  std::vector<double> q(7);
  ASSERT_TRUE(cell.history->at(now_s, q).known());
  std::vector<Capsule> placed(1);
  const robot::LinkCapsule& link = *cell.setup.parts[0].on_robot;
  robot::place({&link, 1}, cell.setup.robot->link_poses(q), placed);
  EXPECT_GT(answer.parts_world[0].radius_m, placed[0].radius_m + 0.05);
  (void)sensors::wait_until(now_s + kAges_s, 2 * kAges_s);
  EXPECT_EQ(cell.asking->ask(sensors::clock_now_s()).reason.limit, MotionLimit::no_joint_state);
  EXPECT_TRUE(cell.asking->answer().cameras[0].late);
  EXPECT_TRUE(std::isnan(cell.asking->answer().skew_s));
}

}  // namespace
}  // namespace depthgrid::monitor
