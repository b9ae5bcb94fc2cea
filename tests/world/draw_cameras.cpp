#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "world/draw.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

/// Half the field of view is at most this, so that what a pixel's own ray misses meets that of a neighbour.
constexpr double kWidestHalfView_deg = 35;

/// A camera turned and moved: of a point p in its frame it says p' with |p' - p| <= rotation |p| + translation.
Pose small_error(Random& random, double translation_m, double rotation_rad) {
  Pose error = Pose::Identity();
  error.linear() = Eigen::AngleAxisd(rotation_rad, random.direction()).toRotationMatrix();
  error.translation() = translation_m * random.direction();
  return error;
}

/// What a pixel's square may hold before what the rays of the pixel and its neighbours meet, over the square of the
/// depth, where all things are unions of balls of at least this radius R. Let a point of such a ball lie in the square
/// at depth z. The ball's section at depth z, seen from the camera, is a disc; with a radius of at least half a pixel's
/// diagonal h z it holds the centre of that pixel or of one beside it, whose ray then meets the ball no farther than z.
/// Else the same is true of the depth at which the section is that large. That is at most R - sqrt(R^2 - (h z)^2) more,
/// which for R >= 1.5 h z is less than 0.58 (h z)^2 / R.
double between_rays_per_m(const PinholeCamera& camera, double least_radius_m) {
  return 0.58 * half_diagonal(camera) * half_diagonal(camera) / least_radius_m;
}

RigCamera draw_optics(Random& random, const World& world, std::size_t number) {
  RigCamera camera;
  camera.id = "camera" + std::to_string(number);
  const int width_px = world.options.width_px > 0 ? world.options.width_px : 4 * random.integer(10, 24);
  const double f_px = 0.5 * width_px / std::tan(random.uniform(25, kWidestHalfView_deg) * std::numbers::pi / 180);
  camera.intrinsics = {width_px,
                       width_px * 3 / 4,
                       f_px,
                       f_px * random.uniform(0.97, 1.03),
                       0.5 * width_px + random.uniform(-1, 1),
                       0.375 * width_px + random.uniform(-1, 1)};
  camera.rule.near_m = random.integer(0, 3) * 0.1 + 0.0005;
  camera.rule.far_m = random.integer(4, 8) + 0.0005;
  camera.rule.clamp_beyond_far = random.chance(0.2);
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  const double away_m = random.uniform(1.3, 1.75);
  const Vector3d place(away_m * std::cos(turn), away_m * std::sin(turn), random.uniform(0.4, 2.2));
  camera.T_world_camera = look_at(place, random.in_box({-0.3, -0.3, 0.4}, {0.3, 0.3, 1.0}),
                                  random.chance(0.8) ? Vector3d::UnitZ() : random.direction());
  return camera;
}

/// The margins that are declared, and what is true within them.
void draw_errors(Random& random, const World& world, bool ideal, RigCamera& camera, TrueCamera& truth,
                 CameraMargins& margins) {
  truth.whole_pixels = world.options.broken != Broken::thinner && random.chance(0.5);
  truth.units = random.chance(0.3);
  if (!ideal && random.chance(0.8)) {
    truth.noise.constant_m = random.uniform(0, 0.015);
    truth.noise.quadratic_per_m = random.uniform(0, 0.008);
  }
  if (truth.units) {
    truth.noise.constant_m += 0.5 * camera.metres_per_unit + 1e-6;
  }
  truth.extreme_noise = random.chance(0.5);
  margins.sensor = truth.noise;
  margins.sensor.quadratic_per_m += between_rays_per_m(camera.intrinsics, least_radius_m(world));
  margins.sensor.lateral_px = truth.whole_pixels ? random.integer(0, 2) : random.integer(1, 2);
  if (!ideal && random.chance(0.6)) {
    const double translation_m = random.uniform(0, 0.01);
    margins.rotation_rad = random.uniform(0, 0.004);
    margins.translation_m = translation_m;
    truth.T_stated_true =
        small_error(random, random.uniform(0.5, 1) * translation_m, random.uniform(0.5, 1) * margins.rotation_rad);
  }
  if (ideal) {
    return;
  }
  truth.shutter = static_cast<Shutter>(random.integer(0, 2));
  margins.half_exposure_s = random.chance(0.3) ? 0.0 : random.uniform(0.001, 0.02);
  margins.time_uncertainty_s = random.chance(0.5) ? 0.0 : random.uniform(0, 0.01);
  truth.lone_holes = random.chance(0.5) ? 0.0 : random.uniform(0, 0.03);
  truth.round_holes = random.chance(0.5) ? 0 : random.integer(1, 5);
  truth.near_specks = random.chance(0.8) ? 0.0 : random.uniform(0, 0.003);
}

/// Holes mean something where no obstacle is smaller than this, and then there are more of them. A rolling shutter
/// shows parts of a ball at times when the rest of it was elsewhere, which is not what is assumed of a hole.
void draw_smallest(Random& random, const World& world, TrueCamera& truth, CameraMargins& margins) {
  margins.smallest_obstacle_m = 2 * least_radius_m(world) * random.uniform(0.3, 1);
  truth.shutter = truth.shutter == Shutter::rolling ? Shutter::longest : truth.shutter;
  truth.lone_holes = random.chance(0.2) ? 0.0 : random.uniform(0, 0.1);
  truth.round_holes = random.integer(0, 10);
}

void break_one(World& world) {
  Random random(world.options.seed, 91);
  const auto one = static_cast<std::size_t>(random.integer(0, static_cast<int>(world.cameras.size()) - 1));
  if (world.options.broken == Broken::pose) {
    world.cameras[one].T_stated_true = small_error(random, random.uniform(0.05, 0.2), random.uniform(0.02, 0.1));
  }
  if (world.options.broken == Broken::readings) {
    for (TrueCamera& camera : world.cameras) {
      camera.too_far = random.uniform(0.05, 0.15);
    }
  }
}

}  // namespace

void draw_cameras(World& world) {
  Random random(world.options.seed, 2);
  Random holes(world.options.seed, 8);
  Random moving(world.options.seed, 9);
  const bool move = moving.chance(0.25);
  const int count = random.integer(1, 4);
  const bool ideal = random.chance(0.4);  // so that no margin hides an error
  world.rig.name = "world";
  for (int k = 0; k < count; ++k) {
    world.rig.cameras.push_back(draw_optics(random, world, static_cast<std::size_t>(k)));
  }
  for (RigCamera& camera : world.rig.cameras) {
    TrueCamera& truth = world.cameras.emplace_back();
    CameraMargins& margins = world.settings.margins.emplace_back();
    truth.moves = move && moving.chance(0.7);
    margins.smallest_obstacle_m = 0;
    draw_errors(random, world, ideal, camera, truth, margins);
    truth.moves = move && moving.chance(0.7);
    margins.smallest_obstacle_m = 0;
    if (world.options.smallest) {
      draw_smallest(holes, world, truth, margins);
    }
    camera.margins = margins;
  }
  break_one(world);
}

double least_radius_m(const World& world) {
  double least_m = 0.01;
  for (const RigCamera& camera : world.rig.cameras) {
    double farthest_m = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Vector3d at = world.box().low_world;
      for (unsigned axis = 0; axis < 3; ++axis) {
        at[axis] = (corner >> axis & 1U) != 0 ? world.box().high_world[axis] : at[axis];
      }
      farthest_m = std::max(farthest_m, (camera.T_world_camera.inverse(Eigen::Isometry) * at).z());
    }
    least_m = std::max(least_m, 1.55 * half_diagonal(camera.intrinsics) * (farthest_m + 0.2));
  }
  return least_m;
}

}  // namespace depthgrid::world
