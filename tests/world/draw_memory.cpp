#include <algorithm>
#include <cmath>

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

/// How far a place is from everything at the first image, for all that clocks may err.
double empty_at_first_m(const World& world, const Vector3d& at) {
  return empty_around_m(world, {Capsule::point(at)}, world.exposures.front().mid_s);
}

/// Some worlds keep a small region in which nothing is at the first image, whatever cameras see of it then.
void draw_empty_region(World& world) {
  Random random(world.options.seed, 11);  // leaves the other draws as they were
  if (world.exposures.empty() || !random.chance(0.2)) {
    return;
  }
  constexpr int kTried = 20;
  Vector3d best = Vector3d::Zero();
  double best_m = 0;
  for (int i = 0; i < kTried; ++i) {
    const Vector3d at = random.in_box(world.box().low_world, world.box().high_world);
    if (const double empty_m = empty_at_first_m(world, at); empty_m > best_m) {
      best = at;
      best_m = empty_m;
    }
  }
  // The region is enlarged to whole blocks of four voxels.
  const double half_m = best_m / std::sqrt(3.0) - 4 * world.memory->voxel_m - 0.01;
  if (half_m < 0.05) {
    return;
  }
  world.memory->low_world = best - Vector3d::Constant(half_m);
  world.memory->high_world = best + Vector3d::Constant(half_m);
  world.memory->start = memory::StartEmpty{};
}

/// In some worlds a ball is let go, of which the memory is told.
void draw_release(World& world) {
  Random random(world.options.seed, 12);
  if (world.robot.empty() || !random.chance(0.5)) {
    return;
  }
  const double speed_m_s = true_speed_m_s(world);
  Solid ball;
  ball.from_s = random.uniform(0.2, 0.8) * world.duration_s;
  ball.a.path = random_path(random, world.box().low_world, world.box().high_world, random.uniform(0, 1) * speed_m_s,
                            world.duration_s, {});
  ball.b = ball.a;
  ball.radius_m = std::max(least_radius_m(world), 0.5 * world.memory->thinnest_hidden_m) * random.uniform(1, 3);
  double late_s = 0;
  for (const CameraMargins& margins : world.settings.margins) {
    late_s = std::max(late_s, margins.half_exposure_s + margins.time_uncertainty_s);
  }
  late_s += 0.001;
  world.solids.push_back(ball);
  world.release = Release{ball.at(ball.from_s), 0.001 + speed_m_s * late_s, ball.from_s - 0.05, ball.from_s + late_s};
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
  draw_empty_region(world);
  draw_release(world);
}

}  // namespace depthgrid::world
