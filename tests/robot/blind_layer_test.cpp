// Answer::blind_m: what is farther from the robot than this is in the answer, what is nearer may be missing from it.
#include "depthgrid/core/blind_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "robot/robot_support.hpp"
#include "support/random_run.hpp"

namespace depthgrid::robot {
namespace {

using Eigen::Vector3d;

constexpr double kRho = 0.4;
constexpr double kResolution = 0.01;

const RobotModel& kuka() {
  static const RobotModel model = kuka_lwr4();
  return model;
}
const std::vector<LinkCapsule>& links() {
  static const std::vector<LinkCapsule> capsules = link_capsules(kuka());
  return capsules;
}
std::vector<Capsule> placed(const std::vector<Pose>& T_world_link) {
  std::vector<Capsule> capsules(links().size());
  place(links(), T_world_link, capsules);
  return capsules;
}

double gap_m(const Capsule& link, const simulation::Sphere& ball) {
  return distance_to_axis(link, ball.centre_world) - link.radius_m - ball.radius_m;
}

Rig random_rig(Random& random, int cameras, int pixels = 1) {
  Rig rig{.name = "cell", .cameras = {}, .T_floor_world = {}};
  for (int k = 0; k < cameras; ++k) {
    RigCamera& camera = rig.cameras.emplace_back();
    camera.id = std::to_string(k);
    camera.intrinsics = {160 * pixels, 120 * pixels, 131.25 * pixels, 131.25 * pixels, 80.0 * pixels, 60.0 * pixels};
    camera.T_world_camera = random_camera_pose(random, 1.2, 2.2);
    camera.margins = CameraMargins{.sensor = {}, .smallest_obstacle_m = 0};  // lateral_px 1: an edge is seen by one of
                                                                             // nine pixels
  }
  return rig;
}

views::Settings settings_of(const Rig& rig, views::Policy pockets) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.3, -1.3, -0.05}, {1.3, 1.3, 1.8}};
  settings.policies = {views::Policy::ignored, views::Policy::ignored, pockets,
                       pockets == views::Policy::ignored ? 5.0 : 0.0};
  settings.margins = camera_margins(rig);
  settings.v_max_m_s = 0;
  settings.rho_m = kRho;
  settings.resolution_m = kResolution;
  return settings;
}

/// An arm whose joints stand a little elsewhere than the history says, and a ball.
struct Cell {
  std::vector<double> q;
  std::vector<Capsule> believed;  ///< the links where they are taken to stand
  simulation::Scene scene;
  ExposureSettings exposure;
  JointHistory history{7, 8, 0.1, 0.0};

  Cell(Random& random, double padding_m, double time_error_s, double speed) : q(random.positions(kuka())) {
    exposure.removal.padding_m = padding_m;
    exposure.time_error_s = time_error_s;
    exposure.joint_speeds.assign(7, speed);
    std::vector<double> true_q = q;
    for (double& angle : true_q) {
      angle += random.uniform(-1, 1) * speed * time_error_s;
    }
    (void)history.add(0.9, q);
    (void)history.add(1.0, q);
    believed = placed(link_poses(kuka(), q));
    for (const Capsule& link : placed(link_poses(kuka(), true_q))) {
      scene.add(link, simulation::Body::robot);
    }
    for (const double side : {-1.0, 1.0}) {
      scene.add(simulation::Plane{side * Vector3d::UnitX(), -4.0});
      scene.add(simulation::Plane{side * Vector3d::UnitY(), -4.0});
      scene.add(simulation::Plane{side * Vector3d::UnitZ(), -4.0});
    }
  }

  [[nodiscard]] double to_ball_m(const simulation::Sphere& ball) const {
    double least_m = 10;
    for (const Capsule& link : believed) {
      least_m = std::min(least_m, gap_m(link, ball));
    }
    return least_m;
  }

  void show(const Rig& rig, FrameIntake& intake, std::span<DistanceEvaluator* const> evaluators) const {
    std::vector<simulation::View> views;
    std::vector<Frame> seen;
    for (const RigCamera& camera : rig.cameras) {
      views.push_back(scene.render(camera.intrinsics, camera.T_world_camera));
    }
    for (const simulation::View& view : views) {
      seen.push_back({depth_view(view.depth_m), {}, 1.0});
    }
    const auto frames = intake.frames(seen);
    for (DistanceEvaluator* evaluator : evaluators) {
      ASSERT_TRUE(update_all(*evaluator, frames).taken());
    }
  }
};

/// A ball so far from a random place on a random link.
simulation::Sphere ball_beside(Random& random, const std::vector<Capsule>& believed, double gap, double radius_m) {
  const Capsule& link = believed[static_cast<std::size_t>(random.integer(2, static_cast<int>(believed.size()) - 1))];
  const Vector3d at = link.a + random.uniform(0, 1) * (link.b - link.a);
  return {at + (link.radius_m + gap + radius_m) * random.unit(), radius_m};
}

// World-sound: every ball that is farther from all links than blind_m is in every link's answer.
TEST(BlindLayer, WhatIsFartherThanItIsNeverMissing) {
  const test::RandomRun run = test::random_run(250);
  long outside = 0;
  long inside = 0;
  long missing_inside = 0;
  long near_the_layer = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    const Rig rig = random_rig(random, random.integer(1, 3));
    Cell cell(random, random.uniform(0.02, 0.15), 0.02, random.integer(0, 1) == 0 ? 0.0 : random.uniform(0, 1));
    const simulation::Sphere ball =
        ball_beside(random, cell.believed, random.uniform(0, 0.35), random.uniform(0.03, 0.08));
    cell.scene.add(ball);
    search::SearchEvaluator search(rig, settings_of(rig, views::Policy::obstacle));
    grid::EvaluationSettings corrected;
    corrected.rho_m = kRho;
    grid::GridEvaluator grid(rig, 0, {0.3, 0.02, 0.0, 200}, corrected);
    FrameIntake intake(rig, {kuka()}, cell.history, cell.exposure);
    const std::array<DistanceEvaluator*, 2> evaluators{&search, &grid};
    cell.show(rig, intake, evaluators);

    const double truth_m = cell.to_ball_m(ball);
    for (DistanceEvaluator* evaluator : evaluators) {
      std::vector<Capsule> asked = cell.believed;
      for (Capsule& capsule : asked) {
        capsule = evaluator == &grid ? Capsule::point(capsule.a) : capsule;
      }
      std::vector<Answer> answers(asked.size());
      evaluator->evaluate(asked, 1.0, answers);
      for (std::size_t k = 0; k < asked.size(); ++k) {
        const Answer& answer = answers[k];
        EXPECT_EQ(answer.blind_m, answers[0].blind_m) << what;
        if (!has_distance(answer.nearest)) {
          continue;
        }
        const double link_truth_m = std::max(0.0, std::min(kRho, gap_m(asked[k], ball)));
        // Where the space of interest ends nearer than the ball, it is not asked for.
        const bool known = !(answer.nearest.known_to_m < link_truth_m);
        if (truth_m > answer.blind_m && known) {
          ++outside;
          near_the_layer += truth_m < answer.blind_m + 0.03 && gap_m(asked[k], ball) < truth_m + 1e-9 ? 1 : 0;
          EXPECT_LE(answer.nearest.distance_m, link_truth_m + 1e-4)
              << what << ", " << evaluator->name() << ", link " << k;
        } else if (known) {
          ++inside;
          missing_inside += answer.nearest.distance_m > link_truth_m + 2 * kResolution ? 1 : 0;
        }
      }
      // Everything that removal adds is in it.
      for (const IntakeReport& report : intake.report()) {
        EXPECT_TRUE(report.robot_removed) << what;
        EXPECT_GE(answers[0].blind_m, report.blind_m) << what;
      }
      EXPECT_GE(answers[0].blind_m, cell.exposure.removal.padding_m) << what;
    }
  }
  EXPECT_GT(outside, 2 * run.count);
  EXPECT_GT(near_the_layer, run.count / 50) << "the bound was put to the test";
  EXPECT_GT(missing_inside, run.count / 50) << "what is in the layer is really missed";
  std::cout << outside << " answers with the ball outside the layer, " << near_the_layer
            << " of them within 3 cm of it; " << missing_inside << " of " << inside << " with it inside are too far\n";
}

// A ball is taken nearer until it is no longer answered: blind_m covers the place, and is not much more.
TEST(BlindLayer, CoversWhatVanishesAndIsNoMoreThanHalfAgain) {
  const test::RandomRun run = test::random_run(20);
  constexpr double kBall = 0.03;
  int vanished = 0;
  double loosest = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    const Rig rig = random_rig(random, 1, 2);
    const Cell empty(random, random.uniform(0.08, 0.2), 0.0, 0.0);
    // On the side of the last link that the camera sees.
    const Capsule& tip = empty.believed.back();
    const Vector3d to_camera = (rig.cameras[0].T_world_camera.translation() - tip.b).normalized();
    double hidden_to_m = -1;
    double blind_m = 0;
    for (double gap = 0.25; gap > 0 && hidden_to_m < 0; gap -= 0.01) {
      Random again(run.seed + static_cast<std::uint64_t>(i));
      (void)random_rig(again, 1, 2);
      Cell cell(again, again.uniform(0.08, 0.2), 0.0, 0.0);
      const simulation::Sphere ball{tip.b + (tip.radius_m + gap + kBall) * to_camera, kBall};
      cell.scene.add(ball);
      const double truth_m = cell.to_ball_m(ball);
      search::SearchEvaluator search(rig, settings_of(rig, views::Policy::ignored));
      FrameIntake intake(rig, {kuka()}, cell.history, cell.exposure);
      const std::array<DistanceEvaluator*, 1> evaluators{&search};
      cell.show(rig, intake, evaluators);
      const Answer answer = search.distance(tip);
      blind_m = answer.blind_m;
      if (has_distance(answer.nearest) && answer.nearest.distance_m > truth_m + 0.05) {
        hidden_to_m = truth_m;
        EXPECT_LE(truth_m, blind_m) << what;
      }
    }
    if (hidden_to_m >= 0) {
      ++vanished;
      // All of the ball that the camera sees has to be in the layer.
      loosest = std::max(loosest, blind_m / (hidden_to_m + 2 * kBall));
    }
  }
  EXPECT_GT(vanished, 8 * run.count / 20);
  EXPECT_LT(loosest, 1.5);
  std::cout << vanished << " balls vanished; the layer is at most " << loosest << " times as thick as where they did\n";
}

// Readings that err by as much as they may: with the margin in the test the robot is not its own obstacle, whatever the
// margin, but where an erring reading lies in the padding of a link before the one that was seen; without, the padding
// has to hold the margin twice.
TEST(BlindLayer, NeedNotHoldAMarginThatIsInTheTest) {
  const test::RandomRun run = test::random_run(40);
  long robot = 0;
  std::array<long, 2> own_obstacle{};
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    Rig rig = random_rig(random, 1);
    const double margin_m = random.uniform(0.01, 0.08);
    rig.cameras[0].margins->sensor = {margin_m, 0, 0, 0};
    const Cell cell(random, random.uniform(0.001, 0.01), 0.0, 0.0);
    const simulation::View seen = cell.scene.render(rig.cameras[0].intrinsics, rig.cameras[0].T_world_camera);
    DepthImage measured_m = seen.depth_m;
    for (int v = 0; v < measured_m.height_px(); ++v) {
      for (int u = 0; u < measured_m.width_px(); ++u) {
        measured_m.at(u, v) += static_cast<float>((random.integer(0, 1) == 0 ? -1 : 1) * (margin_m - 1e-6));
      }
    }
    for (const bool in_test : {false, true}) {
      ExposureSettings exposure = cell.exposure;
      exposure.removal.margin_in_test = in_test;
      FrameIntake intake(rig, {kuka()}, cell.history, exposure);
      search::SearchEvaluator search(rig, settings_of(rig, views::Policy::obstacle));
      ASSERT_TRUE(search.update(0, intake.frame(0, {depth_view(measured_m), {}, 1.0})).taken());
      const views::Snapshot snapshot = search.store().snapshot();
      for (int v = 0; v < measured_m.height_px(); ++v) {
        for (int u = 0; u < measured_m.width_px(); ++u) {
          const bool is_robot = seen.robot_near_m.at(u, v) > 0 && seen.depth_m.at(u, v) < 3.5F;
          const bool own = is_robot && snapshot.view(0).free_m(u, v) < seen.depth_m.at(u, v);
          robot += is_robot && in_test ? 1 : 0;
          own_obstacle[in_test ? 1 : 0] += own ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(own_obstacle[0], robot / 3) << run.reproduce();
  EXPECT_LT(own_obstacle[1], robot / 100) << run.reproduce();
  std::cout << robot << " pixels of the robot: " << own_obstacle[0] << " are its own obstacle without, "
            << own_obstacle[1] << " with the margin in the test\n";
}

TEST(BlindLayer, IsZeroWithoutRemovalAndUnknownWhereNotStated) {
  Random random(1);
  const Rig rig = random_rig(random, 2);
  Cell cell(random, 0.05, 0.0, 0.0);
  std::vector<simulation::View> views;
  for (const RigCamera& camera : rig.cameras) {
    views.push_back(cell.scene.render(camera.intrinsics, camera.T_world_camera, 0.05));
  }
  search::SearchEvaluator search(rig, settings_of(rig, views::Policy::obstacle));
  grid::GridEvaluator grid(rig, 0, {0.3, 0.02, 0.0, 200}, {});
  const Capsule point = Capsule::point({0, 0, 0.9});
  const auto blind_m = [&](const std::array<RobotView, 2>& robots) {
    for (DistanceEvaluator* evaluator :
         {static_cast<DistanceEvaluator*>(&search), static_cast<DistanceEvaluator*>(&grid)}) {
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_TRUE(evaluator->update(k, {depth_view(views[k].depth_m), robots[k], 1.0}).taken());
      }
    }
    std::vector<Answer> a(1);
    std::vector<Answer> b(1);
    search.evaluate({&point, 1}, 1.0, a);
    grid.evaluate({&point, 1}, 1.0, b);
    EXPECT_EQ(std::isnan(a[0].blind_m), std::isnan(b[0].blind_m));
    if (!std::isnan(a[0].blind_m)) {
      EXPECT_NEAR(a[0].blind_m, b[0].blind_m, 1e-12);
    }
    // Level 2 says the same.
    std::vector<Answer> c(1);
    search::Search().distances(search.store().snapshot(), {&point, 1}, c);
    EXPECT_EQ(std::isnan(a[0].blind_m), std::isnan(c[0].blind_m));
    return c[0].blind_m;
  };
  std::array<RobotView, 2> unstated;
  std::array<RobotView, 2> stated;
  for (std::size_t k = 0; k < 2; ++k) {
    unstated[k] = {views[k].robot_near_m.data(), views[k].robot_far_m.data(), 160};
    stated[k] = with_layer(unstated[k], rig.cameras[k].intrinsics, 0.05);
  }
  EXPECT_EQ(blind_m({}), 0);
  EXPECT_TRUE(std::isnan(blind_m(unstated)));
  EXPECT_TRUE(std::isnan(blind_m({stated[0], unstated[1]})));
  const double one_m = blind_m({stated[0], RobotView{}});
  const double other_m = blind_m({RobotView{}, stated[1]});
  EXPECT_GT(one_m, 0.05);
  EXPECT_EQ(blind_m(stated), std::max(one_m, other_m));
  // What was not evaluated says nothing.
  const Capsule nowhere = Capsule::point(Vector3d::Constant(std::nan("")));
  EXPECT_TRUE(std::isnan(search.distance(nowhere).blind_m));
  EXPECT_TRUE(std::isnan(grid.distance(nowhere).blind_m));
}

}  // namespace
}  // namespace depthgrid::robot
