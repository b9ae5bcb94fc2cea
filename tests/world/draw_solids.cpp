#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/draw.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

const Vector3d kLow{-1.6, -1.6, 0.05};
const Vector3d kHigh{1.6, 1.6, 1.7};

Bar random_bar(Random& random, double length_m, double speed_m_s) {
  Bar bar;
  bar.length_m = length_m;
  bar.u = random.direction();
  bar.w = bar.u.cross(random.direction()).normalized();
  bar.rest_rad = random.uniform(-0.5, 0.5);
  bar.swing_rad = random.uniform(0.2, 1.2);
  bar.rate_rad_s = speed_m_s / (length_m * bar.swing_rad);
  bar.phase_rad = random.uniform(0, 2 * std::numbers::pi);
  return bar;
}

Solid furniture(Random& random, double least_radius_m) {
  const Vector3d a = random.in_box(kLow, kHigh);
  const Vector3d b = random.chance(0.3) ? a : random.in_box(kLow, kHigh);
  return {{standing(a)},
          {standing(a + std::min(1.0, (b - a).norm()) * (b - a).normalized())},
          std::max(least_radius_m, random.uniform(0.01, 0.1))};
}

/// A ball, or a capsule whose other end swings about its first.
Solid free_mover(Random& random, double least_radius_m, double speed_m_s, double duration_s,
                 const std::vector<Vector3d>& targets) {
  const bool ball = random.chance(0.5);
  const double path_m_s = ball ? speed_m_s : random.uniform(0, 1) * speed_m_s;
  Place a{random_path(random, kLow, kHigh, path_m_s, duration_s, targets)};
  Place b = a;
  if (!ball) {
    b.bars.push_back(random_bar(random, random.uniform(0.05, 0.6), speed_m_s - path_m_s));
  }
  return {a, b, std::max(least_radius_m, random.uniform(0.01, 0.15))};
}

std::vector<Vector3d> places_of_robot(const World& world) {
  std::vector<Vector3d> places;
  places.reserve(world.robot.size());
  for (const Solid& link : world.robot) {
    places.push_back(link.b.at(0.5 * world.duration_s));
  }
  return places;
}

void break_a_solid(World& world) {
  Random random(world.options.seed, 92);
  for (Solid& solid : world.solids) {
    const bool thin = world.options.broken == Broken::thinner || world.options.broken == Broken::black;
    solid.radius_m *= thin ? random.uniform(0.05, 0.4) : 1.0;
    solid.black = solid.black || (world.options.broken == Broken::black && random.chance(0.5));
    solid.clear = world.options.broken == Broken::clear && random.chance(0.5);
    if (world.options.broken == Broken::dropped && random.chance(0.5)) {
      solid.from_s = random.uniform(0.3, 0.9) * world.duration_s;
    }
  }
}

}  // namespace

std::shared_ptr<const Path> standing(const Vector3d& at_world) {
  return std::make_shared<const Path>(std::vector<Path::Stop>{{0.0, at_world}});
}

std::shared_ptr<const Path> random_path(Random& random, const Vector3d& low, const Vector3d& high, double speed_m_s,
                                        double duration_s, const std::vector<Vector3d>& targets) {
  std::vector<Path::Stop> stops{{0.0, random.in_box(low, high)}};
  stops.reserve(256);
  while (speed_m_s > 0 && stops.back().time_s < duration_s + 1 && stops.size() < 200) {
    if (random.chance(0.2)) {
      stops.push_back({stops.back().time_s + random.uniform(0.1, 1), stops.back().at_world});
    }
    Vector3d to = random.in_box(low, high);
    if (!targets.empty() && random.chance(0.5)) {
      to = targets[static_cast<std::size_t>(random.integer(0, static_cast<int>(targets.size()) - 1))] +
           random.uniform(0, 0.4) * random.direction();
    }
    const double share = random.chance(0.6) ? 1.0 : random.uniform(0.2, 1);
    // A touch longer than it takes, so that rounding does not make it faster.
    const double time_s = (to - stops.back().at_world).norm() / (share * speed_m_s) * (1 + 1e-9) + 1e-9;
    stops.push_back({stops.back().time_s + time_s, to});
  }
  return std::make_shared<const Path>(std::move(stops));
}

void draw_robot(World& world) {
  Random random(world.options.seed, 3);
  if (random.chance(0.2)) {
    return;
  }
  const int links = random.integer(2, 4);
  world.robot_speed_m_s = random.chance(0.2) ? 0.0 : random.uniform(0.1, 1.5);
  Place place{standing(random.in_box({-0.3, -0.3, 0.2}, {0.3, 0.3, 0.7}))};
  for (int i = 0; i < links; ++i) {
    Solid link;
    link.a = place;
    place.bars.push_back(random_bar(random, random.uniform(0.2, 0.4), world.robot_speed_m_s / links));
    link.b = place;
    link.radius_m = random.uniform(0.04, 0.09);
    world.robot.push_back(link);
  }
  Random test(world.options.seed, 10);  // leaves the other draws as they were
  world.margin_in_test = test.chance(0.5);
  double margin_m = 0;
  for (std::size_t k = 0; k < world.cameras.size(); ++k) {
    const RigCamera& camera = world.rig.cameras[k];
    constexpr double kUsualDepth_m = 1.7;
    const double pixel_m = world.cameras[k].whole_pixels ? 2 * half_diagonal(camera.intrinsics) * kUsualDepth_m : 0.0;
    const double depth_m = world.margin_in_test ? 0.0 : 1.3 * depth_margin_m(camera.margins->sensor, kUsualDepth_m);
    margin_m = std::max(
        margin_m, depth_m + pixel_m + camera.margins->translation_m + camera.margins->rotation_rad * kUsualDepth_m);
  }
  // Sometimes too little, and then the robot is its own obstacle.
  world.robot_padding_m = margin_m * random.uniform(0.7, 1.4) + random.uniform(0.005, 0.03);
}

void draw_solids(World& world) {
  Random random(world.options.seed, 4);
  const double radius_m = least_radius_m(world);
  const double speed_m_s = true_speed_m_s(world);
  const std::vector<Vector3d> targets = places_of_robot(world);
  for (int i = random.integer(0, 5); i > 0; --i) {
    world.solids.push_back(furniture(random, radius_m));
  }
  for (int i = random.integer(1, 4); i > 0; --i) {
    world.solids.push_back(free_mover(random, radius_m, speed_m_s, world.duration_s, targets));
  }
  if (random.chance(0.5)) {
    const double path_m_s = random.uniform(0.2, 0.8) * speed_m_s;
    std::vector<Vector3d> feet = targets;
    for (Vector3d& target : feet) {
      target.z() = 0;
    }
    const auto path = random_path(random, {-1.6, -1.6, 0}, {1.6, 1.6, 0}, path_m_s, world.duration_s, feet);
    for (Solid& solid : random_person(random, path, path_m_s, speed_m_s, radius_m)) {
      world.solids.push_back(std::move(solid));
    }
  }
  const double black = random.chance(0.7) ? 0.0 : random.uniform(0, 1);
  for (Solid& solid : world.solids) {
    solid.black = random.chance(black);
  }
  break_a_solid(world);
}

}  // namespace depthgrid::world
