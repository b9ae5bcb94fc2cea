#include "world/sensor.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

/// Instants of a rolling or long exposure.
constexpr int kInstantsOfRays = 5;
/// Of a rolling one each row reads the instants that are no farther from its own, in instants: so whatever moves from
/// row to row, but not faster than a few at a time, is met by one of them.
constexpr double kRowReads = 1.2;

struct Window {
  int first, last;
};

/// The pixels on which [low, high] at depths [z_low, z_high] may project; z_low > 0.
Window window(double f_px, double c_px, int size_px, double low, double high, double z_low, double z_high) {
  const double least = low / (low < 0 ? z_low : z_high);
  const double most = high / (high < 0 ? z_high : z_low);
  return {std::max(0, static_cast<int>(std::floor(std::clamp(f_px * least + c_px, -1.0, size_px + 1.0)))),
          std::min(size_px - 1, static_cast<int>(std::floor(std::clamp(f_px * most + c_px, -1.0, size_px + 1.0))))};
}

PinholeCamera with_a_rim(PinholeCamera camera) {
  camera.width_px += 2;
  camera.height_px += 2;
  camera.cx_px += 1;
  camera.cy_px += 1;
  return camera;
}

}  // namespace

Sensor::Sensor(const World& world, std::size_t camera)
    : world_(world),
      camera_(world.cameras[camera]),
      intrinsics_(world.rig.cameras[camera].intrinsics),
      margins_(world.settings.margins[camera]),
      metres_per_unit_(world.rig.cameras[camera].metres_per_unit),
      eye_(with_a_rim(intrinsics_)),
      stream_(1000 * (camera + 1)) {
  const auto rays = static_cast<std::size_t>(eye_.width_px) * static_cast<std::size_t>(eye_.height_px);
  rays_.reserve(rays);
  for (int v = 0; v < eye_.height_px; ++v) {
    for (int u = 0; u < eye_.width_px; ++u) {
      rays_.push_back(deproject(eye_, {u + 0.5, v + 0.5, 1.0}));
    }
  }
  met_.resize(rays);
  const auto pixels = static_cast<std::size_t>(intrinsics_.width_px) * static_cast<std::size_t>(intrinsics_.height_px);
  metres_.resize(pixels);
  units_.resize(pixels);
}

DepthView Sensor::take(const Exposure& exposure) {
  Random random(world_.options.seed, stream_ * 100000 + static_cast<std::uint64_t>(exposure.number));
  std::fill(met_.begin(), met_.end(), Met{});
  T_world_camera_ = true_pose(world_, exposure);
  T_camera_world_ = T_world_camera_.inverse(Eigen::Isometry);
  const double half_s = margins_.half_exposure_s;
  const int last_row = eye_.height_px - 1;
  if (camera_.shutter == Shutter::instant || half_s == 0) {
    const double part = random.chance(0.5) ? random.uniform(-1, 1) : random.chance(0.5) ? 1.0 : -1.0;
    look(exposure.mid_s + part * half_s, 0, last_row);
  } else {
    for (int i = 0; i < kInstantsOfRays; ++i) {
      const double time_s = exposure.mid_s + half_s * (2.0 * i / (kInstantsOfRays - 1) - 1);
      const double rows = camera_.shutter == Shutter::rolling ? last_row / (kInstantsOfRays - 1.0) : 0.0;
      const int first = rows > 0 ? std::max(0, static_cast<int>(std::floor((i - kRowReads) * rows))) : 0;
      const int last = rows > 0 ? std::min(last_row, static_cast<int>(std::ceil((i + kRowReads) * rows))) : last_row;
      look(time_s, first, last);
    }
  }
  read(random);
  punch_holes(random);
  if (!camera_.units) {
    return depth_view(std::span<const float>(metres_), intrinsics_.width_px, intrinsics_.height_px);
  }
  std::transform(metres_.begin(), metres_.end(), units_.begin(), [this](float depth_m) {
    return static_cast<std::uint16_t>(std::lround(std::min(65534.0, static_cast<double>(depth_m) / metres_per_unit_)));
  });
  return depth_view(std::span<const std::uint16_t>(units_), intrinsics_.width_px, intrinsics_.height_px,
                    metres_per_unit_);
}

void Sensor::look(double time_s, int first_row, int last_row) {
  look_at_walls(first_row, last_row);
  const auto all = [&](const std::vector<Solid>& solids) {
    for (const Solid& solid : solids) {
      if (!solid.clear && solid.exists(time_s)) {
        const Capsule at = solid.at(time_s);
        look_at({{T_camera_world_ * at.a, T_camera_world_ * at.b, at.radius_m}, solid.black}, first_row, last_row);
      }
    }
  };
  all(world_.solids);
  all(world_.robot);
}

void Sensor::look_at_walls(int first_row, int last_row) {
  for (const HalfSpace& wall : world_.walls) {
    const Vector3d normal = T_camera_world_.linear() * wall.normal;
    const double offset_m = wall.offset_m - wall.normal.dot(T_world_camera_.translation());
    for (int v = first_row; v <= last_row; ++v) {
      for (int u = 0; u < eye_.width_px; ++u) {
        const auto i = static_cast<std::size_t>(v * eye_.width_px + u);
        const double slope = normal.dot(rays_[i]);
        if (offset_m >= 0 || slope < 0) {
          meet(i, offset_m >= 0 ? 0.0 : offset_m / slope, world_.black_walls);
        }
      }
    }
  }
}

void Sensor::look_at(const Seen& seen, int first_row, int last_row) {
  const Capsule& capsule = seen.capsule;
  const double r = capsule.radius_m;
  if (std::max(capsule.a.z(), capsule.b.z()) + r <= 0) {
    return;
  }
  Window columns{eye_.width_px, -1};
  Window rows{last_row + 1, -1};
  for (const Vector3d& end : {capsule.a, capsule.b}) {
    if (end.z() - r < 0.01) {
      columns = {0, eye_.width_px - 1};
      rows = {first_row, last_row};
      break;
    }
    const Window u = window(eye_.fx_px, eye_.cx_px, eye_.width_px, end.x() - r, end.x() + r, end.z() - r, end.z() + r);
    const Window v = window(eye_.fy_px, eye_.cy_px, eye_.height_px, end.y() - r, end.y() + r, end.z() - r, end.z() + r);
    columns = {std::min(columns.first, u.first), std::max(columns.last, u.last)};
    rows = {std::min(rows.first, v.first), std::max(rows.last, v.last)};
  }
  for (int v = std::max(first_row, rows.first); v <= std::min(last_row, rows.last); ++v) {
    for (int u = columns.first; u <= columns.last; ++u) {
      const auto i = static_cast<std::size_t>(v * eye_.width_px + u);
      if (const auto depth_m = first_hit(capsule, rays_[i])) {
        meet(i, *depth_m, seen.black);
      }
    }
  }
}

Sensor::Met Sensor::met(int u, int v) const {
  const int reach_px = camera_.whole_pixels ? 1 : 0;
  Met nearest;
  for (int j = v + 1 - reach_px; j <= v + 1 + reach_px; ++j) {
    for (int i = u + 1 - reach_px; i <= u + 1 + reach_px; ++i) {
      const Met& met = met_[static_cast<std::size_t>(j * eye_.width_px + i)];
      nearest = met.depth_m < nearest.depth_m ? met : nearest;
    }
  }
  return nearest;
}

void Sensor::read(Random& random) {
  const double sign = random.chance(0.7) ? 1.0 : -1.0;
  std::size_t i = 0;
  for (int v = 0; v < intrinsics_.height_px; ++v) {
    for (int u = 0; u < intrinsics_.width_px; ++u) {
      metres_[i++] = reading_m(met(u, v), sign, random);
    }
  }
}

// A reading D of a true depth z keeps z - m(z) <= D <= z + m(z) with margins that grow with depth, so D - m(D) <= z.
float Sensor::reading_m(const Met& met, double sign, Random& random) const {
  if (met.black || !(met.depth_m > 0) || !std::isfinite(met.depth_m)) {
    return 0;
  }
  double depth_m = met.depth_m;
  const double part = camera_.extreme_noise ? sign : random.uniform(-1, 1);
  const double rounding_m = camera_.units ? 0.5 * metres_per_unit_ + 1e-6 : 0.0;
  const double most_m = depth_margin_m(camera_.noise, part > 0 ? met.depth_m : 0.8 * met.depth_m) - rounding_m;
  depth_m += part * std::max(0.0, most_m);
  depth_m *= 1 + camera_.too_far;
  if (camera_.near_specks > 0 && random.chance(camera_.near_specks)) {
    depth_m *= random.uniform(0.1, 1);
  }
  const auto rounded_m = static_cast<float>(std::max(0.0, depth_m));
  return static_cast<double>(rounded_m) > depth_m ? std::nextafter(rounded_m, 0.0F) : rounded_m;
}

void Sensor::punch_holes(Random& random) {
  if (camera_.lone_holes > 0) {
    for (float& depth_m : metres_) {
      depth_m = random.chance(camera_.lone_holes) ? 0.0F : depth_m;
    }
  }
  for (int hole = camera_.round_holes > 0 ? random.integer(0, camera_.round_holes) : 0; hole > 0; --hole) {
    const double u0 = random.uniform(0, intrinsics_.width_px);
    const double v0 = random.uniform(0, intrinsics_.height_px);
    const double radius_px = random.uniform(0.7, 0.05 * intrinsics_.width_px);
    const int reach_px = static_cast<int>(std::ceil(radius_px));
    for (int v = std::max(0, static_cast<int>(v0) - reach_px);
         v <= std::min(intrinsics_.height_px - 1, static_cast<int>(v0) + reach_px); ++v) {
      for (int u = std::max(0, static_cast<int>(u0) - reach_px);
           u <= std::min(intrinsics_.width_px - 1, static_cast<int>(u0) + reach_px); ++u) {
        if (std::hypot(u + 0.5 - u0, v + 0.5 - v0) <= radius_px) {
          metres_[static_cast<std::size_t>(v * intrinsics_.width_px + u)] = 0;
        }
      }
    }
  }
}

}  // namespace depthgrid::world
