#include <algorithm>

#include "world/draw.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

/// How long before and after the first image a declaration about it has to be true, for all that clocks may err.
constexpr double kAround_s = 0.05;

/// What is true of the surroundings of the robot at the first image: nothing is nearer than this.
double empty_around_m(const World& world, const std::vector<Capsule>& robot, double first_s) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Capsule& link : robot) {
    for (int i = -4; i <= 4; ++i) {
      least_m = std::min(least_m, true_distance_m(world, link, first_s + i * kAround_s / 4));
    }
  }
  return least_m - 0.25 * kAround_s * world.settings.v_max_m_s;
}

double thinnest_m(const World& world) {
  double least_m = 0.3;
  for (const Solid& solid : world.solids) {
    least_m = std::min(least_m, 2 * solid.radius_m);
  }
  return least_m;
}

}  // namespace

void draw_memory(World& world) {
  Random random(world.options.seed, 7);
  memory::MemorySettings& settings = world.memory.emplace();
  settings.low_world = world.box().low_world;
  settings.high_world = world.box().high_world;
  if (random.chance(0.4)) {
    settings.low_world += random.in_box(Vector3d::Constant(-0.3), Vector3d::Constant(0.4));
    settings.high_world += random.in_box(Vector3d::Constant(-0.4), Vector3d::Constant(0.3));
  }
  settings.voxel_m = random.chance(0.5) ? 0.025 : random.uniform(0.02, 0.06);
  const bool thin = world.options.broken == Broken::thinner || world.options.broken == Broken::black;
  if (random.chance(0.5)) {
    // Where things are thinner than declared, what is declared is what they would have been.
    settings.thinnest_hidden_m = (thin ? 2 * least_radius_m(world) : thinnest_m(world)) * random.uniform(0.2, 1);
  }
  settings.start = memory::StartUnknown{};
  if (!world.robot.empty() && !world.exposures.empty() && random.chance(0.4)) {
    const double first_s = world.exposures.front().stamp_s;
    const std::vector<Capsule> robot = robot_at(world, first_s);
    const double empty_m = empty_around_m(world, robot, world.exposures.front().mid_s);
    if (empty_m > 0.01) {
      settings.start = memory::StartEmptyAroundRobot{robot, random.uniform(0.5, 1) * empty_m};
    }
  }
}

}  // namespace depthgrid::world
