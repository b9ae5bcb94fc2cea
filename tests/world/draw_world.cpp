#include <algorithm>
#include <cmath>

#include "world/draw.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

void draw_room(Random& random, World& world) {
  const double half_m = random.uniform(1.8, 2.6);
  world.walls.push_back({Vector3d::UnitZ(), 0.0});
  world.walls.push_back({-Vector3d::UnitZ(), -random.uniform(2.3, 3.0)});
  for (const Vector3d& normal : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
    if (random.chance(0.9)) {
      world.walls.push_back({normal, -half_m});
    }
  }
  world.black_walls = random.chance(0.05);
}

void draw_settings(Random& random, World& world) {
  views::Settings& settings = world.settings;
  const double x_m = random.uniform(0.6, 1.2);
  const double y_m = random.uniform(0.6, 1.2);
  const double floor_m = random.chance(0.3) ? -0.1 : random.uniform(0.01, 0.2);
  settings.space = views::BoxSpace{{-x_m, -y_m, floor_m}, {x_m, y_m, random.uniform(1.0, 1.8)}};
  settings.policies = {views::Policy::obstacle, views::Policy::obstacle, views::Policy::obstacle, 0.0};
  settings.rho_m = random.uniform(0.2, 0.5);
  settings.resolution_m = random.chance(0.5) ? 0.01 : random.uniform(0.005, 0.02);
  settings.v_max_m_s = random.chance(0.15)  ? 0.0
                       : random.chance(0.5) ? random.uniform(0.05, 0.5)
                                            : random.uniform(0.5, 2.5);
}

}  // namespace

double half_diagonal(const PinholeCamera& camera) { return 0.5 * std::hypot(1 / camera.fx_px, 1 / camera.fy_px); }

double true_speed_m_s(const World& world) {
  Random random(world.options.seed, 90);
  const double factor = random.uniform(1.5, 4);
  return world.settings.v_max_m_s * (world.options.broken == Broken::faster ? factor : 1.0);
}

World make_world(const WorldOptions& options) {
  World world;
  world.options = options;
  Random random(options.seed, 1);
  world.duration_s = random.uniform(2, 10);
  draw_room(random, world);
  draw_settings(random, world);
  draw_cameras(world);
  draw_robot(world);
  draw_solids(world);
  draw_exposures(world);
  if (options.memory) {
    draw_memory(world);
  }
  return world;
}

Pose stated_pose(const World& world, const Exposure& exposure) {
  Pose pose = world.rig.cameras[exposure.camera].T_world_camera;
  if (world.cameras[exposure.camera].moves) {
    Random random(world.options.seed, 1000000 * (exposure.camera + 1) + static_cast<std::uint64_t>(exposure.number));
    pose.rotate(Eigen::AngleAxisd(random.uniform(0, 0.1), random.direction()));
    pose.pretranslate(random.uniform(0, 0.08) * random.direction());
  }
  return pose;
}

Pose true_pose(const World& world, const Exposure& exposure) {
  return stated_pose(world, exposure) * world.cameras[exposure.camera].T_stated_true;
}

std::vector<Capsule> robot_at(const World& world, double time_s) {
  std::vector<Capsule> links;
  links.reserve(world.robot.size());
  for (const Solid& link : world.robot) {
    links.push_back(link.at(time_s));
  }
  return links;
}

double true_distance_m(const World& world, const Capsule& capsule, double time_s) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Solid& solid : world.solids) {
    if (solid.exists(time_s)) {
      least_m = std::min(least_m, gap_m(capsule, solid.at(time_s)));
    }
  }
  for (const HalfSpace& wall : world.walls) {
    least_m = std::min(least_m, gap_m(capsule, wall));
  }
  return std::max(0.0, least_m);
}

}  // namespace depthgrid::world
