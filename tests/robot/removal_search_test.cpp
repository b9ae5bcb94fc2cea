// The search with the robot taken out of the images: its own links are no obstacle to it, a hand before it is one.
#include <gtest/gtest.h>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/search/search.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "robot/robot_support.hpp"
#include "support/random_run.hpp"

namespace depthgrid::robot {
namespace {

using Eigen::Vector3d;

views::Settings settings() {
  views::Settings result;
  result.space = views::BoxSpace{{-0.8, -0.8, 0}, {0.8, 0.8, 1.4}};
  result.policies = {views::Policy::ignored, views::Policy::ignored, views::Policy::ignored, 3.0};
  result.margins = {CameraMargins{.sensor = {}, .smallest_obstacle_m = 0}};
  result.v_max_m_s = 0;
  result.rho_m = 0.25;
  return result;
}

TEST(RemovalSearch, LinksAreNoObstacleAndAHandIs) {
  const RobotModel model = kuka_lwr4();
  const std::vector<LinkCapsule> links = link_capsules(model);
  Rig rig{.name = "cell", .cameras = std::vector<RigCamera>(1), .T_floor_world = {}};
  RigCamera& camera = rig.cameras[0];
  camera.id = "front";
  camera.intrinsics = {320, 240, 262.5, 262.5, 160, 120};
  camera.T_world_camera = look_at({2.3, 0.2, 0.9}, {0, 0, 0.6});
  const test::RandomRun run = test::random_run(5);
  long links_asked = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::vector<Pose> poses = link_poses(model, random.positions(model));
    std::vector<Capsule> placed(links.size());
    place(links, poses, placed);
    const bool with_hand = random.integer(0, 1) == 0;
    simulation::Scene scene;
    scene.add(simulation::Plane{Vector3d::UnitX(), -2.0});
    for (const Capsule& c : placed) {
      scene.add(Capsule{c.a, c.b, c.radius_m}, simulation::Body::robot);
    }
    // Its surface is 0.1 m from that of the wrist, towards the camera.
    const Capsule& wrist = placed[6];
    const Vector3d toward = (camera.T_world_camera.translation() - wrist.a).normalized();
    const Vector3d hand_world = wrist.a + (wrist.radius_m + 0.1 + 0.04) * toward;
    if (with_hand) {
      scene.add(simulation::Sphere{hand_world, 0.04});
    }
    const simulation::View view = scene.render(camera.intrinsics, camera.T_world_camera);
    // It may be outside the space of interest, or in the shadow of another link: these policies ignore both.
    const Vector3d hand_camera = camera.T_world_camera.inverse(Eigen::Isometry) * hand_world;
    const DepthPoint seen = project(camera.intrinsics, hand_camera);
    bool hand_shows =
        camera.intrinsics.contains(static_cast<int>(seen.x_px), static_cast<int>(seen.y_px)) &&
        view.depth_m.at(static_cast<int>(seen.x_px), static_cast<int>(seen.y_px)) > hand_camera.z() - 0.045 &&
        hand_world.z() > 0.05 && hand_world.z() < 1.35;
    for (const Capsule& c : placed) {  // nor is it within the padding of one
      hand_shows = hand_shows && distance_to_axis(c, hand_world) > c.radius_m + 0.04 + 0.04;
    }
    RobotRemoval removal(camera.intrinsics, links, {0.02, true});
    Frame frame;
    frame.depth = {view.depth_m.data(), DepthFormat::float32_metres, 320, 240, 320 * sizeof(float), 1.0};
    std::vector<Capsule> primitives;
    bool wrist_asked = false;
    for (std::size_t k = 2; k < placed.size(); ++k) {
      if (std::max(placed[k].a.cwiseAbs().head<2>().maxCoeff(), placed[k].b.cwiseAbs().head<2>().maxCoeff()) < 0.5) {
        primitives.push_back(Capsule{placed[k].a, placed[k].b, placed[k].radius_m});
        wrist_asked = wrist_asked || k == 6;
      }
    }
    links_asked += static_cast<long>(primitives.size());
    const auto nearest_m = [&](const RobotView& robot) {
      frame.robot = robot;
      views::ViewStore store(rig, settings());
      EXPECT_EQ(store.update(0, frame).result, UpdateResult::taken);
      std::vector<Answer> answers(primitives.size());
      search::Search().distances(store.snapshot(), primitives, answers);
      double least = 1;
      for (const Answer& answer : answers) {
        least = std::min(least, answer.nearest.distance_m);
      }
      return least;
    };
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    if (primitives.empty()) {
      continue;
    }
    const double without = nearest_m({});
    const double with = nearest_m(removal.find(poses, camera.T_world_camera, {}, &frame.depth));
    EXPECT_LT(without, 0.02) << what;  // the robot's own surface
    if (with_hand && hand_shows && wrist_asked) {
      EXPECT_LT(with, 0.1 + 0.01) << what;  // a pixel is 9 mm there
    } else if (!with_hand) {
      EXPECT_GT(with, 0.25 - 1e-4) << what;  // nothing within rho
    }
  }
  EXPECT_GT(links_asked, 0);
}

}  // namespace
}  // namespace depthgrid::robot
