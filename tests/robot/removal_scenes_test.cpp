// The robot taken out of rendered images: which pixels it may and may not take along, hands near it, and wrong clocks.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/motion_padding.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "robot/robot_support.hpp"
#include "support/random_run.hpp"

namespace depthgrid::robot {
namespace {

using Eigen::Vector3d;

const RobotModel& kuka() {
  static const RobotModel model = kuka_lwr4();
  return model;
}
const std::vector<LinkCapsule>& links() {
  static const std::vector<LinkCapsule> capsules = link_capsules(kuka());
  return capsules;
}

PinholeCamera small_camera() { return {160, 120, 131.25, 131.25, 80, 60}; }

std::vector<Capsule> placed(const std::vector<Pose>& T_world_link) {
  std::vector<Capsule> capsules(links().size());
  place(links(), T_world_link, capsules);
  return capsules;
}

simulation::Scene room() {
  simulation::Scene scene;
  scene.add(simulation::Plane{Vector3d::UnitZ(), -0.1});
  for (const double side : {-1.0, 1.0}) {
    scene.add(simulation::Plane{side * Vector3d::UnitX(), -4.0});
    scene.add(simulation::Plane{side * Vector3d::UnitY(), -4.0});
  }
  return scene;
}

/// Depth images of the obstacles alone, of the robot alone and of both.
struct Images {
  DepthImage obstacle_m;
  DepthImage robot_m;
  std::vector<float> reading_m;

  Images(const simulation::Scene& obstacles, const std::vector<Capsule>& robot, const PinholeCamera& camera,
         const Pose& T_world_camera) {
    simulation::Scene arm;
    for (const Capsule& c : robot) {
      arm.add(Capsule{c.a, c.b, c.radius_m}, simulation::Body::robot);
    }
    obstacle_m = obstacles.render(camera, T_world_camera).depth_m;
    robot_m = arm.render(camera, T_world_camera).depth_m;
    for (int v = 0; v < camera.height_px; ++v) {
      for (int u = 0; u < camera.width_px; ++u) {
        reading_m.push_back(shows_robot(u, v) ? robot_m.at(u, v) : obstacle_m.at(u, v));
      }
    }
  }
  [[nodiscard]] bool shows_robot(int u, int v) const {
    return robot_m.at(u, v) > 0 && (obstacle_m.at(u, v) == 0 || robot_m.at(u, v) < obstacle_m.at(u, v));
  }
};

bool taken_for_robot(const RobotView& view, int u, int v, float reading_m) {
  const std::ptrdiff_t at = v * view.stride_px + u;
  return view.near_m[at] > 0 && view.near_m[at] <= reading_m && reading_m <= view.far_m[at];
}

double distance_m(const std::vector<Capsule>& robot, const Vector3d& p_world) {
  double least = std::numeric_limits<double>::infinity();
  for (const Capsule& c : robot) {
    least = std::min(least, distance_to_axis(c, p_world) - c.radius_m);
  }
  return least;
}

Vector3d point_of(const PinholeCamera& camera, const Pose& T_world_camera, int u, int v, double depth_m) {
  return T_world_camera * deproject(camera, {u + 0.5, v + 0.5, depth_m});
}

/// A hand about so far in front of the surface that a random robot pixel shows; false where there is none.
bool add_hand(simulation::Scene& scene, const Images& robot_only, const PinholeCamera& camera,
              const Pose& T_world_camera, double gap_m, Random& random, Vector3d& centre_world) {
  for (int attempt = 0; attempt < 200; ++attempt) {
    const int u = random.integer(0, camera.width_px - 1);
    const int v = random.integer(0, camera.height_px - 1);
    if (robot_only.shows_robot(u, v)) {
      constexpr double kRadius = 0.03;
      const double depth_m = robot_only.robot_m.at(u, v) - gap_m - kRadius;
      centre_world = point_of(camera, T_world_camera, u, v, depth_m);
      scene.add(Capsule{centre_world, centre_world + 0.08 * random.unit(), kRadius});
      return depth_m > 0.2;
    }
  }
  return false;
}

// Exact joint positions: every robot pixel is robot. An obstacle's pixel is taken for robot only where the obstacle is
// within the padding of the robot.
TEST(RemovalScenes, TakesTheRobotAndNothingBeyondThePadding) {
  const PinholeCamera camera = small_camera();
  const test::RandomRun run = test::random_run(150);
  long robot_pixels = 0;
  long hand_pixels = 0;
  long blind_pixels = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::vector<Pose> poses = link_poses(kuka(), random.positions(kuka()));
    const std::vector<Capsule> robot = placed(poses);
    const Pose T_world_camera = random_camera_pose(random, 1.0, 3.0);
    simulation::Scene scene = room();
    const Images before(scene, robot, camera, T_world_camera);
    for (int k = random.integer(0, 4); k > 0; --k) {  // in front, resting on it, or reaching into it
      Vector3d unused;
      (void)add_hand(scene, before, camera, T_world_camera, random.uniform(-0.05, 0.3), random, unused);
    }
    for (int k = random.integer(0, 3); k > 0; --k) {  // anywhere
      const Vector3d a = Vector3d(0, 0, 0.4) + random.in_cube(1);
      scene.add(Capsule{a, a + random.in_cube(0.5), random.uniform(0.02, 0.2)});
    }
    const Images images(scene, robot, camera, T_world_camera);
    const double padding_m = random.uniform(0.0, 0.08);
    const bool with_reading = random.integer(0, 1) == 0;
    RobotRemoval removal(camera, links(), {padding_m, random.integer(0, 1) == 0});
    const DepthView depth = depth_view(images.reading_m, camera.width_px, camera.height_px);
    const RobotView found = removal.find(poses, T_world_camera, {}, with_reading ? &depth : nullptr);
    const double half_pixel = 0.5 * std::hypot(1 / camera.fx_px, 1 / camera.fy_px);
    for (int v = 0; v < camera.height_px; ++v) {
      for (int u = 0; u < camera.width_px; ++u) {
        const float reading = images.reading_m[static_cast<std::size_t>(v * camera.width_px + u)];
        const bool taken = taken_for_robot(found, u, v, reading);
        if (images.shows_robot(u, v)) {
          ++robot_pixels;
          ASSERT_TRUE(taken) << "case " << i << "; " << run.reproduce() << ": robot pixel " << u << ", " << v;
        } else if (reading > 0) {
          const Vector3d p_world = point_of(camera, T_world_camera, u, v, reading);
          const double away_m = distance_m(robot, p_world);
          const double layer_m = padding_m + 1e-4 + half_pixel * 4.5;
          hand_pixels += images.robot_m.at(u, v) > 0 ? 1 : 0;
          blind_pixels += taken ? 1 : 0;
          ASSERT_TRUE(!taken || away_m <= layer_m) << "case " << i << "; " << run.reproduce() << ": obstacle pixel "
                                                   << u << ", " << v << ", " << away_m << " m from the robot";
        }
      }
    }
  }
  std::cout << robot_pixels << " robot pixels, " << hand_pixels << " of obstacles before the robot, " << blind_pixels
            << " of obstacles within the padding\n";
}

// A hand in the robot's image, farther from the robot than the padding: every pixel of it stays.
TEST(RemovalScenes, AHandBeforeTheRobotStaysWhole) {
  const PinholeCamera camera = small_camera();
  const test::RandomRun run = test::random_run(60);
  constexpr double kPadding = 0.03;
  long hands = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::vector<Pose> poses = link_poses(kuka(), random.positions(kuka()));
    const std::vector<Capsule> robot = placed(poses);
    const Pose T_world_camera = random_camera_pose(random, 1.0, 2.0);
    const Images before(simulation::Scene{}, robot, camera, T_world_camera);
    simulation::Scene scene;
    Vector3d centre_world;
    if (!add_hand(scene, before, camera, T_world_camera, random.uniform(0.04, 0.2), random, centre_world)) {
      continue;
    }
    const Images images(scene, robot, camera, T_world_camera);
    RobotRemoval removal(camera, links(), {kPadding, false});
    const DepthView depth = depth_view(images.reading_m, camera.width_px, camera.height_px);
    const RobotView found = removal.find(poses, T_world_camera, {}, &depth);
    for (int v = 0; v < camera.height_px; ++v) {
      for (int u = 0; u < camera.width_px; ++u) {
        const float reading = images.reading_m[static_cast<std::size_t>(v * camera.width_px + u)];
        if (images.obstacle_m.at(u, v) > 0 && !images.shows_robot(u, v) &&
            distance_m(robot, point_of(camera, T_world_camera, u, v, reading)) > kPadding + 1e-4) {
          ++hands;
          ASSERT_FALSE(taken_for_robot(found, u, v, reading)) << "case " << i << "; " << run.reproduce();
        }
      }
    }
  }
  EXPECT_GT(hands, 100);
}

/// Robot pixels that do not count as robot when the clock errs.
struct ClockRow {
  long robot = 0;
  std::array<long, 3> missed{};  ///< with fixed paddings
  long missed_covered = 0;       ///< with the padding for motion
  double moved_m = 0;            ///< farthest that a point of the arm's axis moved
  double bound_m = 0;            ///< largest padding for motion
};
constexpr std::array<double, 3> kFixed{0.02, 0.05, 0.10};

ClockRow wrong_clock(double speed_part, double time_error_s, const test::RandomRun& run) {
  const PinholeCamera camera = small_camera();
  ClockRow row;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::vector<double> q = random.positions(kuka());
    std::vector<double> speeds;
    std::vector<double> true_q = q;
    for (std::size_t j = 0; j < q.size(); ++j) {
      speeds.push_back(speed_part * kuka().joints()[j].max_speed);
      true_q[j] += random.uniform(-1, 1) * speeds[j] * time_error_s;
    }
    const std::vector<Pose> believed = link_poses(kuka(), q);
    const std::vector<Capsule> robot = placed(link_poses(kuka(), true_q));
    const std::vector<Capsule> model = placed(believed);
    for (std::size_t k = 0; k < robot.size(); ++k) {
      row.moved_m = std::max({row.moved_m, (robot[k].a - model[k].a).norm(), (robot[k].b - model[k].b).norm()});
    }
    const Pose T_world_camera = random_camera_pose(random, 1.5, 2.5);
    const Images images(simulation::Scene{}, robot, camera, T_world_camera);
    const DepthView depth = depth_view(images.reading_m, camera.width_px, camera.height_px);
    std::vector<double> motion_m(links().size());
    motion_padding(kuka(), links(), believed, speeds, time_error_s, motion_m);
    row.bound_m = std::max(row.bound_m, motion_m.back());
    const auto missed = [&](double padding_m, std::span<const double> more_m) {
      RobotRemoval removal(camera, links(), {padding_m, false});
      const RobotView found = removal.find(believed, T_world_camera, more_m, &depth);
      long count = 0;
      for (int k = 0; k < camera.width_px * camera.height_px; ++k) {
        const float reading = images.reading_m[static_cast<std::size_t>(k)];
        const int u = k % camera.width_px;
        count += reading > 0 && !taken_for_robot(found, u, k / camera.width_px, reading) ? 1 : 0;
      }
      return count;
    };
    for (std::size_t k = 0; k < kFixed.size(); ++k) {
      row.missed[k] += missed(kFixed[k], {});
    }
    row.missed_covered += missed(0, motion_m);
    row.robot += std::count_if(images.reading_m.begin(), images.reading_m.end(), [](float z) { return z > 0; });
  }
  return row;
}

// Prints the table of docs/robot.md; that is with DEPTHGRID_TEST_COUNT=400.
TEST(RemovalScenes, AWrongClockIsCoveredByThePaddingForMotion) {
  const test::RandomRun run = test::random_run(12);
  std::printf(
      "| speed | time error | moved, most | missed at 2 cm | 5 cm | 10 cm | padding for motion, most | missed |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const double part : {0.1, 0.25, 0.5, 1.0}) {
    for (const double time_error_s : {0.02, 0.05}) {
      const ClockRow row = wrong_clock(part, time_error_s, run);
      EXPECT_EQ(row.missed_covered, 0) << run.reproduce();
      EXPECT_GE(row.bound_m, row.moved_m);
      EXPECT_GE(row.missed[0], row.missed[1]);
      EXPECT_GE(row.missed[1], row.missed[2]);
      if (row.moved_m <= kFixed[2]) {
        EXPECT_EQ(row.missed[2], 0) << run.reproduce();
      }
      std::printf("| %.0f %% | %.0f ms | %.0f mm |", 100 * part, 1e3 * time_error_s, 1e3 * row.moved_m);
      for (const long missed : row.missed) {
        std::printf(" %.2f %% |", 100.0 * static_cast<double>(missed) / static_cast<double>(row.robot));
      }
      std::printf(" %.0f mm | %ld |\n", 1e3 * row.bound_m, row.missed_covered);
      if (part == 1.0 && time_error_s == 0.05) {
        EXPECT_GT(row.missed[0], 0);  // a fast arm and a bad clock: a thin padding does not do
      }
    }
  }
}

}  // namespace
}  // namespace depthgrid::robot
