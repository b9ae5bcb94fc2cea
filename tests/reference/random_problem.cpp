#include "reference/random_problem.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace depthgrid::reference {
namespace {

using Eigen::Vector3d;

/// Cameras stay outside this radius around the cell's middle, obstacles inside it.
constexpr double kObstacleRadiusM = 1.0;
constexpr double kFloorM = -0.7;

Pose random_pose(Random& random, const Vector3d& position) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(random.uniform(-3.1, 3.1), random.direction()).toRotationMatrix();
  pose.translation() = position;
  return pose;
}

void add_obstacles(Random& random, bool thin, simulation::Scene& scene) {
  if (random.chance(0.8)) {
    scene.add(simulation::Plane{Vector3d::UnitZ(), kFloorM});
  }
  if (random.chance(0.8)) {
    const double wall_m = random.uniform(2.8, 4.0);
    for (const Vector3d& normal : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
      scene.add(simulation::Plane{normal, -wall_m});
    }
    scene.add(simulation::Plane{Vector3d(0, 0, -1), -3.5});
  }
  const int count = random.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    const Vector3d centre = random.in_cube(0.4);
    const int kind = thin ? 2 : random.integer(0, 2);
    if (kind == 0) {
      const Vector3d half_size = Vector3d::Constant(0.16) + random.in_cube(0.14);
      scene.add(simulation::Box{random_pose(random, centre), half_size});
    } else if (kind == 1) {
      scene.add(simulation::Sphere{centre, random.uniform(0.02, 0.25)});
    } else {
      const double radius_m = thin ? random.uniform(0.005, 0.02) : random.uniform(0.005, 0.1);
      scene.add(Capsule{centre, centre + random.in_cube(0.3), radius_m});
    }
  }
}

/// Returns the first link's middle.
Vector3d add_robot(Random& random, simulation::Scene& scene) {
  const int links = random.integer(1, 3);
  Vector3d joint = random.in_cube(0.35);
  Vector3d middle = joint;
  for (int i = 0; i < links; ++i) {
    const Vector3d next = joint + 0.35 * random.direction();
    scene.add(Capsule{joint, next, random.uniform(0.03, 0.08)}, simulation::Body::robot);
    middle = i == 0 ? (0.5 * (joint + next)).eval() : middle;
    joint = next;
  }
  return middle;
}

/// Something small between the robot and a camera, so that the camera sees it and not the robot there.
void add_hand(Random& random, const Vector3d& robot, const Vector3d& camera, simulation::Scene& scene) {
  const Vector3d towards = (camera - robot).normalized();
  scene.add(simulation::Sphere{robot + random.uniform(0.15, 0.3) * towards, random.uniform(0.02, 0.06)});
}

RigCamera random_camera(Random& random, std::size_t index, std::optional<int> width_px) {
  RigCamera camera;
  camera.id = "camera" + std::to_string(index);
  camera.intrinsics.width_px = width_px ? *width_px : 4 * random.integer(4, 24);
  camera.intrinsics.height_px = camera.intrinsics.width_px * 3 / 4;
  const double half_view = random.uniform(25, 38) * std::numbers::pi / 180;
  const double f_px = 0.5 * camera.intrinsics.width_px / std::tan(half_view);
  camera.intrinsics.fx_px = f_px;
  camera.intrinsics.fy_px = f_px * random.uniform(0.95, 1.05);
  camera.intrinsics.cx_px = 0.5 * camera.intrinsics.width_px + random.uniform(-1, 1);
  camera.intrinsics.cy_px = 0.5 * camera.intrinsics.height_px + random.uniform(-1, 1);
  // Half-way between two millimetres, so that no reading lies on a limit.
  camera.rule.near_m = random.integer(0, 3) * 0.1 + 0.0005;
  camera.rule.far_m = random.integer(5, 9) + 0.0005;
  camera.rule.clamp_beyond_far = random.chance(0.2);
  Vector3d position = random.uniform(kObstacleRadiusM + 0.3, 2.5) * random.direction();
  position.z() = std::max(position.z(), kFloorM + 0.05);
  if (position.norm() < kObstacleRadiusM + 0.2) {
    position *= (kObstacleRadiusM + 0.2) / position.norm();
    position.z() = std::max(position.z(), kFloorM + 0.05);
  }
  const Vector3d up = random.direction();
  camera.T_world_camera = look_at(position, random.in_cube(0.2), up);
  return camera;
}

void make_images(Random& random, bool invalid, bool units, double padding_m, RandomProblem& problem) {
  for (RigCamera& camera : problem.rig.cameras) {
    problem.views.push_back(problem.scene.render(camera.intrinsics, camera.T_world_camera, padding_m));
    DepthImage& depth_m = problem.views.back().depth_m;
    const double share = invalid ? std::pow(10.0, random.uniform(-3, -0.7)) : 0.0;
    for (int v = 0; v < depth_m.height_px(); ++v) {
      for (int u = 0; u < depth_m.width_px(); ++u) {
        if (invalid && random.chance(share)) {
          depth_m.at(u, v) = 0;
        }
      }
    }
    std::vector<std::uint16_t> stored;
    if (units) {
      for (std::size_t i = 0; i < depth_m.index(0, depth_m.height_px()); ++i) {
        stored.push_back(static_cast<std::uint16_t>(std::min(65534.0, std::round(depth_m.data()[i] * 1000.0))));
      }
    }
    problem.units.push_back(std::move(stored));
  }
  problem.refer_frames();
}

/// Points in the principal camera's view, most of them near a surface.
void draw_points(Random& random, RandomProblem& problem) {
  const RigCamera& camera = problem.rig.cameras[problem.principal];
  const double d_max_m = problem.d_min_m + problem.step_m * problem.cell_count;
  const Pose T_camera_world = camera.T_world_camera.inverse(Eigen::Isometry);
  for (int attempt = 0; attempt < 1000 && problem.points_world.size() < 3; ++attempt) {
    const Vector3d p_world = random.in_cube(0.6);
    const Vector3d p = T_camera_world * p_world;
    const double limit_m = problem.points_world.size() < 2 ? problem.rho_m : 10.0;
    if (p.z() < problem.d_min_m || p.z() > d_max_m ||
        (attempt < 500 && problem.scene.distance(p_world).distance_m > limit_m)) {
      continue;
    }
    const DepthPoint at = project(camera.intrinsics, p);
    if (at.x_px > 0 && at.y_px > 0 && at.x_px < camera.intrinsics.width_px && at.y_px < camera.intrinsics.height_px) {
      problem.points_world.push_back(p_world);
    }
  }
}

}  // namespace

Vector3d Random::direction() {
  for (;;) {
    const Vector3d v = in_cube(1.0);
    if (v.norm() > 0.1 && v.norm() < 1.0) {
      return v.normalized();
    }
  }
}

void RandomProblem::refer_frames() {
  frames.clear();
  for (std::size_t k = 0; k < views.size(); ++k) {
    const int width_px = views[k].depth_m.width_px();
    const int height_px = views[k].depth_m.height_px();
    const std::size_t pixels = views[k].depth_m.index(0, height_px);
    Frame frame;
    frame.depth = units[k].empty() ? depth_view(std::span(views[k].depth_m.data(), pixels), width_px, height_px)
                                   : depth_view(units[k], width_px, height_px, 0.001);
    frame.robot = {views[k].robot_near_m.data(), views[k].robot_far_m.data(), width_px};
    frame.robot.within_margin = within_margin;
    frames.push_back(frame);
  }
}

Problem RandomProblem::problem() const {
  Problem result;
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    const RigCamera& camera = rig.cameras[k];
    result.cameras.push_back({camera.intrinsics, camera.T_world_camera, camera.rule, frames[k], sensor, pose});
  }
  result.space = FrustumSpace{principal, d_min_m, d_min_m + step_m * cell_count};
  result.outside = outside_is_obstacle ? Policy::obstacle : Policy::ignored;
  result.rho_m = rho_m;
  return result;
}

RandomProblem make_random_problem(const RandomOptions& options) {
  Random random(options.seed * 0x9E3779B97F4A7C15U + 1);
  // Every choice is drawn, whether it is used or not, so that setting one option leaves the others as they were.
  const auto choose = [&random](const std::optional<bool>& set, double probability) {
    const bool drawn = random.chance(probability);
    return set.value_or(drawn);
  };
  RandomProblem problem;
  problem.options = options;
  const bool margins = choose(options.margins, 0.4);
  const bool lateral = choose(options.lateral, 0.4);
  const bool invalid = choose(options.invalid, 0.3);
  const bool robot = choose(options.robot, 0.3);
  const bool units = choose(options.units, 0.5);
  const bool thin = choose(options.thin, 0.15);
  problem.outside_is_obstacle = choose(options.outside, 0.2);
  const int drawn_cameras = random.integer(1, 4);
  const int cameras = options.cameras.value_or(drawn_cameras);
  const double drawn_rho_m = random.uniform(0.2, 0.4);
  problem.rho_m = options.rho_m.value_or(drawn_rho_m);
  const double drawn_step_m = random.uniform(0.01, 0.03);
  problem.step_m = options.step_m.value_or(drawn_step_m);
  problem.sensor.lateral_px = lateral ? random.integer(1, 2) : 0;
  if (margins) {
    problem.sensor.constant_m = random.uniform(0, 0.01);
    problem.sensor.quadratic_per_m = random.uniform(0, 0.002);
    problem.pose.translation_m = random.uniform(0, 0.01);
    problem.pose.rotation_rad = random.uniform(0, 0.003);
    problem.pose.time_m = random.chance(0.5) ? random.uniform(0, 0.01) : 0.0;
  }
  add_obstacles(random, thin, problem.scene);
  const Vector3d link = robot ? add_robot(random, problem.scene) : Vector3d::Zero();
  problem.rig.name = "random " + std::to_string(options.seed);
  for (int k = 0; k < cameras; ++k) {
    problem.rig.cameras.push_back(random_camera(random, static_cast<std::size_t>(k), options.width_px));
  }
  if (robot && options.hand.value_or(false)) {
    Random extra(options.seed * 0x9E3779B97F4A7C15U + 2);  // leaves the draws of problems without a hand as they are
    add_hand(extra, link, problem.rig.cameras.front().T_world_camera.translation(), problem.scene);
  }
  problem.principal = static_cast<std::size_t>(random.integer(0, cameras - 1));
  problem.d_min_m = random.uniform(0.2, 0.5);
  problem.cell_count = static_cast<int>((4.0 - problem.d_min_m) / problem.step_m);
  // More than margins and quantisation, so that the robot's own surface lies well inside its padded model.
  const double padding_m = 0.03 + random.uniform(0, 0.03);
  make_images(random, invalid, units, padding_m, problem);
  draw_points(random, problem);
  return problem;
}

}  // namespace depthgrid::reference
