#include "avoidance/post_cell.hpp"

#include <algorithm>
#include <array>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/placed_robot.hpp"
#include "depthgrid/robot/urdf.hpp"
#include "depthgrid/simulation/scene.hpp"

namespace depthgrid::avoidance::test {

using Eigen::Vector3d;

namespace {

constexpr const char* kUrdf = R"(<robot name="posts">
  <link name="root"/>
  <link name="post"><collision><origin xyz="0 0 0.4"/>
    <geometry><capsule radius="0.05" length="0.4"/></geometry></collision></link>
  <link name="other"><collision><origin xyz="0 0 0.4"/>
    <geometry><capsule radius="0.05" length="0.4"/></geometry></collision></link>
  <joint name="a" type="revolute"><parent link="root"/><child link="post"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1"/></joint>
  <joint name="b" type="revolute"><origin xyz="0 0.8 0"/><parent link="root"/><child link="other"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1"/></joint>
</robot>)";

DepthImage image_of(const RigCamera& camera, const PostOptions& options, double nearer_m) {
  simulation::Scene scene;
  for (const double side : {-1.0, 1.0}) {
    scene.add(simulation::Plane{side * Vector3d::UnitX(), -3.0});
    scene.add(simulation::Plane{side * Vector3d::UnitY(), -3.0});
  }
  for (const Capsule& thing : options.things_world) {
    scene.add(thing);
  }
  for (const std::size_t link : {0U, 1U}) {
    Capsule post = post_world(link);
    const Vector3d way = (options.errs.at(link) ? nearer_m : 0.0) *
                         (camera.T_world_camera.translation() - 0.5 * (post.a + post.b)).normalized();
    post.a += way;
    post.b += way;
    scene.add(post, simulation::Body::robot);
  }
  return scene.render(camera.intrinsics, camera.T_world_camera).depth_m;
}

void punch(DepthImage& image_m, const RigCamera& camera, const Hole& hole) {
  const DepthPoint at = project(camera.intrinsics, camera.T_world_camera.inverse(Eigen::Isometry) * hole.at_world);
  for (int v = static_cast<int>(at.y_px) - hole.half_px; v <= static_cast<int>(at.y_px) + hole.half_px; ++v) {
    for (int u = static_cast<int>(at.x_px) - hole.half_px; u <= static_cast<int>(at.x_px) + hole.half_px; ++u) {
      if (camera.intrinsics.contains(u, v)) {
        image_m.at(u, v) = 0;
      }
    }
  }
}

Rig rig_of(const std::vector<Pose>& T_world_camera) {
  std::vector<Pose> poses = T_world_camera;
  if (poses.empty()) {
    poses = {look_at({-1.5, 0.4, 0.4}, {0, 0.4, 0.4}), look_at({1.5, 0.4, 0.4}, {0, 0.4, 0.4})};
  }
  constexpr std::array kNames{"left", "right", "third"};
  Rig rig{.name = "posts", .cameras = {}, .T_floor_world = {}};
  for (std::size_t k = 0; k < poses.size(); ++k) {
    RigCamera& camera = rig.cameras.emplace_back();
    camera.id = kNames.at(k);
    camera.intrinsics = {160, 120, 110, 110, 80, 60};
    camera.T_world_camera = poses[k];
    camera.margins = CameraMargins{.sensor = {0, 0, 0, 0}, .smallest_obstacle_m = 0};
  }
  return rig;
}

}  // namespace

const Capsule& post_world(std::size_t link) {
  static const std::array<Capsule, 2> kPosts{Capsule{{0, 0, 0.2}, {0, 0, 0.6}, 0.05},
                                             Capsule{{0, 0.8, 0.2}, {0, 0.8, 0.6}, 0.05}};
  return kPosts.at(link);
}

PostCell post_cell(const std::vector<PostOptions>& cells) {
  PostCell result{
      rig_of(cells.front().T_world_camera), robot::RobotModel(robot::parse_urdf(kUrdf, "posts.urdf")), {}, {}, {}, {}};
  const std::vector<Pose> T_world_link = robot::PlacedRobot{result.model}.link_poses(std::vector<double>{0, 0});
  const std::size_t cameras = result.rig.cameras.size();
  for (const PostOptions& options : cells) {
    result.things_world.insert(result.things_world.end(), options.things_world.begin(), options.things_world.end());
    for (std::size_t k = 0; k < cameras; ++k) {
      const double nearer_m = k < options.nearer_m.size() ? options.nearer_m[k] : 0;
      DepthImage& image_m = result.images_m.emplace_back(image_of(result.rig.cameras[k], options, nearer_m));
      for (const Hole& hole : options.holes) {
        if (hole.camera == k) {
          punch(image_m, result.rig.cameras[k], hole);
        }
      }
    }
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EmptyCell& cell = result.cells.emplace_back();
    cell.T_world_link = T_world_link;
    for (std::size_t k = 0; k < cameras; ++k) {
      cell.seen.push_back({depth_view(result.images_m[i * cameras + k]), {}, 0.03 * static_cast<double>(i)});
    }
  }
  views::Settings& search = result.settings.search;
  search.space = views::BoxSpace{{-0.8, -0.7, -0.4}, {0.8, 1.5, 1.2}};
  search.policies = {.unobserved = views::Policy::ignored,
                     .outside = views::Policy::ignored,
                     .robot_pockets = views::Policy::obstacle};
  search.margins = camera_margins(result.rig);
  search.v_max_m_s = 0;
  search.rho_m = 0.6;
  result.settings.least_joints = 1;
  result.settings.robot_within_m = 0.09;
  return result;
}

const LinkPadding& of_link(const LeastPadding& found, const std::string& name) {
  const auto link =
      std::find_if(found.links.begin(), found.links.end(), [&](const LinkPadding& item) { return item.name == name; });
  if (link == found.links.end()) {
    fail("no link ", name);
  }
  return *link;
}

}  // namespace depthgrid::avoidance::test
