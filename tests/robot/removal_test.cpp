// The robot's interval in an image: against the slow twin and the simulator, in every instruction set, without
// allocating.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <bit>
#include <cmath>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_at_exposure.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "robot/removal_twin.hpp"
#include "robot/robot_support.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::robot {
namespace {

const RobotModel& kuka() {
  static const RobotModel model = kuka_lwr4();
  return model;
}

/// One random view: the arm in most cases, else a heap of capsules, spheres and slender ones among them.
struct View {
  PinholeCamera camera;
  Pose T_world_camera;
  std::vector<LinkCapsule> capsules;
  std::vector<Pose> T_world_link;
  std::vector<double> motion_m;
  RemovalSettings settings;

  View(Random& random, int width_px, int height_px)
      : camera{width_px,
               height_px,
               0.82 * width_px,
               0.82 * width_px,
               random.uniform(0.4, 0.6) * width_px,
               random.uniform(0.4, 0.6) * height_px} {
    const bool arm = random.integer(0, 3) > 0;
    T_world_camera = random_camera_pose(random, arm ? 0.7 : 0.2, 3.5);
    settings.padding_m = random.integer(0, 3) == 0 ? 0.0 : random.uniform(0, 0.1);
    settings.whole_pixels = false;
    if (arm) {
      capsules = link_capsules(kuka());
      T_world_link = link_poses(kuka(), random.positions(kuka()));
    } else {
      for (int i = random.integer(1, 20); i > 0; --i) {
        const Eigen::Vector3d a = Eigen::Vector3d(0, 0, 0.4) + random.in_cube(0.6);
        const double length = random.integer(0, 3) == 0 ? 0.0 : random.uniform(0, 1);
        capsules.push_back({0, {a, a + length * random.unit(), random.uniform(0.005, 0.15)}});
      }
      T_world_link = {Pose::Identity()};
    }
    for (std::size_t i = 0; i < capsules.size() && random.integer(0, 1) == 0; ++i) {
      motion_m.resize(capsules.size());
      motion_m[i] = random.uniform(0, 0.05);
    }
  }

  [[nodiscard]] std::vector<Capsule> in_camera() const {
    std::vector<Capsule> placed(capsules.size());
    std::vector<Pose> T_camera_link = T_world_link;
    for (Pose& pose : T_camera_link) {
      pose = T_world_camera.inverse(Eigen::Isometry) * pose;
    }
    place(capsules, T_camera_link, placed);
    return placed;
  }
  [[nodiscard]] std::vector<double> padding_m(double more_m) const {
    std::vector<double> padding(capsules.size(), settings.padding_m + more_m);
    for (std::size_t i = 0; i < motion_m.size(); ++i) {
      padding[i] += motion_m[i];
    }
    return padding;
  }
};

struct Tally {
  long robot = 0;     ///< pixels with robot
  long disputed = 0;  ///< where rounding decides which part is meant
};

// Twice the thickness that find() may add for rounding, at the largest distance of these views.
constexpr double kGuard = 2 * (1e-5 + 4e-6 * 1.8 * 5);
constexpr double kRounding = 2e-6;

/// Each pixel holds the twin's part and is held by that of capsules a little thicker.
void compare(const View& view, const RobotView& found, const std::vector<float>& reading_m, Tally& tally,
             const std::string& what) {
  const std::vector<Capsule> capsules = view.in_camera();
  for (int v = 0; v < view.camera.height_px; ++v) {
    for (int u = 0; u < view.camera.width_px; ++u) {
      const double near_m = found.near_m[v * found.stride_px + u];
      const double far_m = found.far_m[v * found.stride_px + u];
      const double reading =
          reading_m.empty() ? 0.0 : reading_m[static_cast<std::size_t>(v * view.camera.width_px + u)];
      const TwinRay thin(capsules, view.padding_m(0), view.camera, u, v);
      const TwinRay thick(capsules, view.padding_m(kGuard), view.camera, u, v);
      const TwinPart* inner = thin.answer(reading);
      const TwinPart* outer = thick.answer(reading);
      tally.robot += inner != nullptr ? 1 : 0;
      const bool holds = inner == nullptr || (near_m > 0 && near_m <= std::max(inner->near_m, 1e-30) + kRounding &&
                                              far_m >= inner->far_m - kRounding);
      const bool held =
          near_m == 0 || (outer != nullptr && near_m >= outer->near_m - kRounding && far_m <= outer->far_m + kRounding);
      if (holds && held) {
        continue;
      }
      // Only where rounding may decide: another part of the twin's, on a ray that hardly touches something.
      ++tally.disputed;
      const TwinPart* other = near_m > 0 ? thick.part_at(0.5 * (near_m + far_m)) : nullptr;
      ASSERT_TRUE(near_m == 0
                      ? outer != nullptr && inner == nullptr
                      : other != nullptr && near_m >= other->near_m - kRounding && far_m <= other->far_m + kRounding)
          << what << ", pixel " << u << ", " << v << ": [" << near_m << ", " << far_m << "]";
    }
  }
}

std::vector<float> random_readings(const View& view, Random& random) {
  const std::vector<Capsule> capsules = view.in_camera();
  std::vector<float> readings;
  for (int v = 0; v < view.camera.height_px; ++v) {
    for (int u = 0; u < view.camera.width_px; ++u) {
      const TwinRay ray(capsules, view.padding_m(0), view.camera, u, v);
      double depth_m = random.integer(0, 4) == 0 ? 0.0 : random.uniform(0.1, 4);
      if (!ray.parts.empty() && random.integer(0, 2) > 0) {
        const TwinPart& part =
            ray.parts[static_cast<std::size_t>(random.integer(0, static_cast<int>(ray.parts.size()) - 1))];
        depth_m = random.uniform(part.near_m, part.far_m);
      }
      readings.push_back(static_cast<float>(std::max(0.0, depth_m)));
    }
  }
  return readings;
}

TEST(Removal, AgreesWithTheSlowTwin) {
  const test::RandomRun run = test::random_run(60);
  Tally tally;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    const View view(random, random.integer(40, 130), random.integer(30, 90));
    RobotRemoval removal(view.camera, view.capsules, view.settings);
    compare(view, removal.find(view.T_world_link, view.T_world_camera, view.motion_m), {}, tally, what);
    const std::vector<float> readings = random_readings(view, random);
    const DepthView depth = depth_view(readings, view.camera.width_px, view.camera.height_px);
    compare(view, removal.find(view.T_world_link, view.T_world_camera, view.motion_m, &depth), readings, tally, what);
  }
  EXPECT_LT(static_cast<double>(tally.disputed), 1 + 2e-3 * static_cast<double>(tally.robot));
  std::cout << tally.robot << " robot pixels, " << tally.disputed << " where rounding decides\n";
}

// The simulator's own rendering, at the size of a real image.
TEST(Removal, AgreesWithTheSimulator) {
  const test::RandomRun run = test::random_run(4);
  for (std::int64_t i = 0; i < std::min<std::int64_t>(run.count, 20); ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    View view(random, 640, 480);
    view.motion_m.clear();
    simulation::Scene scene;
    std::vector<Capsule> placed(view.capsules.size());
    place(view.capsules, view.T_world_link, placed);
    for (const Capsule& c : placed) {
      scene.add(Capsule{c.a, c.b, c.radius_m}, simulation::Body::robot);
    }
    const simulation::View slow = scene.render(view.camera, view.T_world_camera, view.settings.padding_m);
    RobotRemoval removal(view.camera, view.capsules, view.settings);
    const RobotView fast = removal.find(view.T_world_link, view.T_world_camera);
    long robot = 0;
    long different = 0;
    for (int v = 0; v < 480; ++v) {
      for (int u = 0; u < 640; ++u) {
        const float near_m = fast.near_m[v * fast.stride_px + u];
        const float far_m = fast.far_m[v * fast.stride_px + u];
        robot += slow.robot_near_m.at(u, v) > 0 ? 1 : 0;
        const double off =
            std::max(std::abs(near_m - slow.robot_near_m.at(u, v)), std::abs(far_m - slow.robot_far_m.at(u, v)));
        // A ray that just touches is in the capsule for 2 sqrt(2 r d), where d is how deep.
        different += off > 5e-3 ? 1 : 0;
      }
    }
    EXPECT_LT(static_cast<double>(different), 2 + 2e-3 * static_cast<double>(robot))
        << "case " << i << "; " << run.reproduce();
  }
}

// What a pixel of a real camera shows may come from anywhere in it.
TEST(Removal, WholePixelsHoldWhatAnyRayOfThePixelMeets) {
  const test::RandomRun run = test::random_run(40);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    View view(random, 80, 60);
    view.settings.whole_pixels = true;
    const std::vector<Capsule> capsules = view.in_camera();
    // Surfaces of the robot along random rays of the pixels are the readings.
    std::vector<float> readings;
    for (int v = 0; v < 60; ++v) {
      for (int u = 0; u < 80; ++u) {
        const simulation::Line ray{Eigen::Vector3d::Zero(),
                                   deproject(view.camera, {u + random.uniform(0, 1), v + random.uniform(0, 1), 1.0})};
        double depth_m = 1e9;
        for (const Capsule& c : capsules) {
          const simulation::Interval z = intersect(Capsule{c.a, c.b, c.radius_m}, ray);
          depth_m = !z.empty() && z.entry > 0 ? std::min(depth_m, z.entry) : depth_m;
        }
        readings.push_back(depth_m < 1e8 ? static_cast<float>(depth_m) : 0.0F);
      }
    }
    RobotRemoval removal(view.camera, view.capsules, view.settings);
    const DepthView depth = depth_view(readings, 80, 60);
    const RobotView found = removal.find(view.T_world_link, view.T_world_camera, view.motion_m, &depth);
    for (int k = 0; k < 80 * 60; ++k) {
      const float reading = readings[static_cast<std::size_t>(k)];
      if (reading > 0) {
        const auto at = k / 80 * found.stride_px + k % 80;
        ASSERT_TRUE(found.near_m[at] <= reading && reading <= found.far_m[at])
            << "case " << i << "; " << run.reproduce() << ": pixel " << k % 80 << ", " << k / 80;
      }
    }
  }
}

TEST(Removal, ForgetsTheImageBefore) {
  Random random(3);
  const View view(random, 100, 70);
  const View other(random, 100, 70);
  RobotRemoval used(view.camera, view.capsules, view.settings);
  RobotRemoval fresh(view.camera, view.capsules, view.settings);
  for (int k = 0; k < 20; ++k) {
    const Pose elsewhere = random_camera_pose(random, 0.5, 2);
    (void)used.find(view.T_world_link, elsewhere);
  }
  const RobotView a = used.find(view.T_world_link, view.T_world_camera);
  const RobotView b = fresh.find(view.T_world_link, view.T_world_camera);
  for (int k = 0; k < 70 * a.stride_px; ++k) {
    if (k % a.stride_px < 100) {
      ASSERT_EQ(a.near_m[k], b.near_m[k]);
      ASSERT_EQ(a.far_m[k], b.far_m[k]);
    }
  }
}

TEST(Removal, EveryInstructionSetGivesTheSameBits) {
  const test::RandomRun run = test::random_run(20);
  const auto images = [&run] {
    std::vector<std::uint32_t> bits;
    for (std::int64_t i = 0; i < run.count; ++i) {
      Random random(run.seed + static_cast<std::uint64_t>(i));
      const View view(random, random.integer(30, 150), 40);
      RobotRemoval removal(view.camera, view.capsules, view.settings);
      const std::vector<float> readings = random_readings(view, random);
      const DepthView depth = depth_view(readings, view.camera.width_px, view.camera.height_px);
      const RobotView found = removal.find(view.T_world_link, view.T_world_camera, view.motion_m, &depth);
      for (int k = 0; k < view.camera.height_px * found.stride_px; ++k) {
        if (k % found.stride_px >= view.camera.width_px) {
          continue;  // beyond the image
        }
        bits.push_back(std::bit_cast<std::uint32_t>(found.near_m[k]));
        bits.push_back(std::bit_cast<std::uint32_t>(found.far_m[k]));
      }
    }
    return bits;
  };
  const std::vector<std::uint32_t> expected = images();
  const std::int64_t all = hwy::SupportedTargets();
  for (std::int64_t left = all; left != 0; left &= left - 1) {
    const std::int64_t target = left & -left;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const std::vector<std::uint32_t> found = images();
    ASSERT_EQ(found.size(), expected.size());
    const auto [a, b] = std::mismatch(found.begin(), found.end(), expected.begin());
    EXPECT_EQ(a, found.end()) << hwy::TargetName(target) << ": number " << a - found.begin() << " is "
                              << std::bit_cast<float>(*a) << " instead of " << std::bit_cast<float>(*b);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(Removal, SaysWhichLinksAreInTheImageAndHowThickTheyCount) {
  const PinholeCamera camera{64, 48, 60, 60, 32, 24};
  const std::vector<LinkCapsule> capsules{{0, {{0, 0, 2}, {0, 0.1, 2}, 0.05}}, {1, {{0, 0, 0}, {0, 0, 0}, 0.05}}};
  RobotRemoval removal(camera, capsules, {0.03, true, true});
  std::vector<Pose> T_world_link(2, Pose::Identity());
  T_world_link[0].translation() = Eigen::Vector3d(0.1, 0, 0);
  T_world_link[1].translation() = Eigen::Vector3d(0, 0, -2);  // behind the camera
  const RobotView one = removal.find(T_world_link, Pose::Identity(), std::vector<double>{0.01, 0.02});
  EXPECT_TRUE(one.within_margin);
  ASSERT_EQ(one.links_world.size(), 1U);
  EXPECT_TRUE(one.links_world[0].a.isApprox(Eigen::Vector3d(0.1, 0, 2)));
  EXPECT_TRUE(one.links_world[0].b.isApprox(Eigen::Vector3d(0.1, 0.1, 2)));
  EXPECT_NEAR(one.links_world[0].radius_m, 0.05 + 0.03 + 0.01, 1e-12);
  EXPECT_GE(one.blind_m, 0.04) << "the layer holds them";
  T_world_link[1].translation() = Eigen::Vector3d(0, 0, 3);
  EXPECT_EQ(removal.find(T_world_link, Pose::Identity()).links_world.size(), 2U);
  EXPECT_FALSE(RobotRemoval(camera, capsules, {0.03}).find(T_world_link, Pose::Identity()).within_margin);
}

TEST(Removal, WithoutUsableNumbersThereIsNoRobot) {
  Random random(1);
  View view(random, 40, 30);
  RobotRemoval removal(view.camera, view.capsules, view.settings);
  EXPECT_NE(removal.find(view.T_world_link, view.T_world_camera).near_m, nullptr);
  EXPECT_EQ(removal.find({}, view.T_world_camera).near_m, nullptr);
  EXPECT_EQ(removal.find(view.T_world_link, view.T_world_camera, std::vector<double>(99, 0.0)).near_m, nullptr);
  std::vector<double> motion_m(view.capsules.size(), 0.0);
  for (const double none : {std::nan(""), -1.0, HUGE_VAL}) {
    motion_m.back() = none;
    EXPECT_EQ(removal.find(view.T_world_link, view.T_world_camera, motion_m).near_m, nullptr);
  }
  view.T_world_link[0].translation().x() = std::nan("");
  EXPECT_EQ(removal.find(view.T_world_link, view.T_world_camera).near_m, nullptr);
  const auto refused = [&](std::vector<LinkCapsule> capsules, double padding_m) {
    return !test::thrown_message([&] { RobotRemoval(view.camera, capsules, {padding_m, true}); }).empty();
  };
  EXPECT_TRUE(refused({}, 0));
  EXPECT_TRUE(refused({{0, {{0, 0, 0}, {0, 0, 1}, 0}}}, 0));
  EXPECT_TRUE(refused({{0, {{0, 0, std::nan("")}, {0, 0, 1}, 1}}}, 0));
  EXPECT_TRUE(refused(view.capsules, -1));
  EXPECT_TRUE(refused(view.capsules, std::nan("")));
}

TEST(RobotAtExposure, FromTheTimeToTheImage) {
  JointHistory history(7, 100, 0.01, 0.02);
  Random random(2);
  std::vector<double> q = random.positions(kuka());
  for (int k = 0; k < 50; ++k) {
    history.add(0.002 * k, q);
    q[0] += 0.002;
  }
  const View view(random, 64, 48);
  ExposureSettings settings;
  settings.time_error_s = 0.02;
  RobotAtExposure robot({kuka()}, history, view.camera, link_capsules(kuka()), settings);
  const ExposedRobot exposed = robot.find(0.0471, view.T_world_camera);
  EXPECT_EQ(exposed.joints.answer, JointAnswer::interpolated);
  ASSERT_NE(exposed.view.near_m, nullptr);
  const double tip_m = robot.motion_m().back();
  EXPECT_GT(tip_m, 0.01);
  EXPECT_EQ(robot.find(0.11, view.T_world_camera).joints.answer, JointAnswer::held);
  EXPECT_GT(robot.motion_m().back(), tip_m);  // the newest sample is old
  EXPECT_EQ(robot.find(0.2, view.T_world_camera).view.near_m, nullptr);
  settings.joint_accelerations = {10};
  EXPECT_NE(test::thrown_message(
                [&] { const RobotAtExposure unused({kuka()}, history, view.camera, link_capsules(kuka()), settings); }),
            "");
  settings.joint_accelerations.assign(7, -10);
  EXPECT_NE(test::thrown_message(
                [&] { const RobotAtExposure unused({kuka()}, history, view.camera, link_capsules(kuka()), settings); }),
            "");
  settings.joint_accelerations.clear();
  settings.joint_speeds = {1, 2};
  EXPECT_NE(test::thrown_message(
                [&] { const RobotAtExposure unused({kuka()}, history, view.camera, link_capsules(kuka()), settings); }),
            "");
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const std::vector<std::uint16_t> units(64 * 48, 1500);
  const DepthView depth = depth_view(units, 64, 48, 0.001);
  const test::AllocationGuard guard;
  const ExposedRobot again = robot.find(0.05, view.T_world_camera, &depth);
  const auto allocations = guard.allocations();
  EXPECT_EQ(allocations, 0);
  EXPECT_NE(again.view.near_m, nullptr);
}

// A standing arm is not padded for motion, a slow one for as much as it moved, and both make a thinner blind layer.
TEST(RobotAtExposure, PadsForTheMotionThatWasMeasured) {
  std::vector<double> layers_m;  // of each find
  const auto found = [&](double speed, std::vector<double> accelerations, bool later_samples) {
    JointHistory history(7, 200, 0.01, 0.02);
    Random random(2);
    const std::vector<double> q = random.positions(kuka());
    for (int k = 0; 0.002 * k < (later_samples ? 0.2 : 0.1); ++k) {
      std::vector<double> at = q;
      for (double& angle : at) {
        angle += speed * 0.002 * k;
      }
      EXPECT_TRUE(history.add(0.002 * k, at));
    }
    const View view(random, 64, 48);
    ExposureSettings settings;
    settings.time_error_s = 0.02;
    settings.joint_accelerations = std::move(accelerations);
    RobotAtExposure robot({kuka()}, history, view.camera, link_capsules(kuka()), settings);
    const ExposedRobot exposed = robot.find(0.098, view.T_world_camera);
    EXPECT_TRUE(exposed.measured_motion);
    layers_m.push_back(exposed.view.blind_m);
    return robot.motion_m().back();
  };
  const std::vector<double> stated(7, 10.0);
  const double limits_m = found(0.0, {}, false);  // no sample after, no acceleration: the greatest speeds
  EXPECT_GT(limits_m, 0.05);
  EXPECT_LT(found(0.0, stated, true), 1e-4) << "standing";
  EXPECT_LT(found(0.0, {}, true), 0.1 * limits_m) << "standing, what it does between samples is not known";
  EXPECT_LT(found(0.0, stated, false), 0.2 * limits_m) << "it may have set off";
  const double slow_m = found(0.1, stated, true);
  EXPECT_GT(slow_m, 0.002);
  EXPECT_LT(slow_m, 0.1 * limits_m);
  EXPECT_LT(slow_m, found(0.3, stated, true));
  // The layer follows: the greatest speeds, standing, ..., slow, less slow.
  ASSERT_EQ(layers_m.size(), 6U);
  EXPECT_LT(layers_m[1], layers_m[4]);
  EXPECT_LT(layers_m[4], layers_m[5]);
  EXPECT_LT(layers_m[5], layers_m[0]);
}

TEST(RobotAtExposure, ADropoutOfSamplesIsNoMotion) {
  // Samples for a while, none for ten seconds, then again: the arm stands.
  JointHistory history(7, 400, 0.01, 0.02);
  Random random(2);
  const std::vector<double> q = random.positions(kuka());
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(history.add(0.002 * k, q));
  }
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(history.add(10 + 0.002 * k, q));
  }
  const View view(random, 64, 48);
  ExposureSettings settings;
  settings.time_error_s = 0.02;
  settings.joint_accelerations.assign(7, 10.0);
  RobotAtExposure robot({kuka()}, history, view.camera, link_capsules(kuka()), settings);
  EXPECT_FALSE(robot.find(10.01, view.T_world_camera).measured_motion);
  const double soon_m = robot.motion_m().back();
  EXPECT_TRUE(robot.find(10.05, view.T_world_camera).measured_motion);
  EXPECT_LT(robot.motion_m().back(), 1e-4);
  EXPECT_GT(soon_m, 0.02);
  EXPECT_LT(soon_m, 0.5) << "at most what the joints can within the time error";
}

}  // namespace
}  // namespace depthgrid::robot
