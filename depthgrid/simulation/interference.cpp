#include "depthgrid/simulation/interference.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/pixel_random.hpp"

namespace depthgrid::simulation {

namespace {

constexpr std::uint64_t kSpots = 100;  ///< random stream of the first unit

/// Where a pixel's ray passes in another camera: point = depth * direction + origin.
struct Transfer {
  Transfer(const StructuredLightUnit& from, const StructuredLightUnit& to)
      : T_to_from(to.T_world_camera.inverse(Eigen::Isometry) * from.T_world_camera), source(from), target(to) {}

  /// Whether the surface in this pixel is what the other unit sees there.
  [[nodiscard]] bool lit(int u, int v) const {
    const float depth_m = source.ideal_m->at(u, v);
    if (!(depth_m > 0)) {
      return false;
    }
    const Eigen::Vector3d p = T_to_from * deproject(source.camera, {u + 0.5, v + 0.5, depth_m});
    if (p.z() <= 0) {
      return false;
    }
    const DepthPoint there = project(target.camera, p);
    if (!(there.x_px >= 0 && there.y_px >= 0 && there.x_px < target.camera.width_px &&
          there.y_px < target.camera.height_px)) {
      return false;
    }
    const float seen_m = target.ideal_m->at(static_cast<int>(there.x_px), static_cast<int>(there.y_px));
    return seen_m > 0 && p.z() < seen_m * 1.01 + 0.02;  // less than that apart: the same surface, seen at a slant
  }

  Pose T_to_from;
  const StructuredLightUnit& source;
  const StructuredLightUnit& target;
};

std::vector<std::pair<int, int>> disc(double radius_px) {
  std::vector<std::pair<int, int>> offsets;
  const int reach = static_cast<int>(std::floor(radius_px));
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (x * x + y * y <= radius_px * radius_px) {
        offsets.emplace_back(x, y);
      }
    }
  }
  return offsets;
}

void validate(std::span<const StructuredLightUnit> units, std::size_t self, const InterferenceModel& model,
              const DepthImage& measured_m) {
  for (const double share : {model.lost_share, model.lost_share_vibrating}) {
    if (!(share >= 0 && share < 1)) {
      fail("interference: lost share is ", share, ", must be in [0, 1)");
    }
  }
  if (!(model.spot_radius_px >= 0 && model.spot_radius_px <= 16)) {
    fail("interference: spot radius is ", model.spot_radius_px, " px, must be in [0, 16]");
  }
  const auto fits = [](const PinholeCamera& camera, const DepthImage& image) {
    return image.width_px() == camera.width_px && image.height_px() == camera.height_px;
  };
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (units[i].ideal_m == nullptr || !fits(units[i].camera, *units[i].ideal_m)) {
      fail("interference: unit ", i, " has no ideal image of its camera's size");
    }
  }
  if (self >= units.size() || !fits(units[self].camera, measured_m)) {
    fail("interference: unit ", self, " of ", units.size(), " has no measured image of its camera's size");
  }
}

}  // namespace

void apply_interference(std::span<const StructuredLightUnit> units, std::size_t self, const InterferenceModel& model,
                        std::uint64_t seed, std::uint64_t frame, DepthImage& measured_m) {
  validate(units, self, model, measured_m);
  const std::vector<std::pair<int, int>> spot = disc(model.spot_radius_px);
  const StructuredLightUnit& unit = units[self];
  for (std::size_t other = 0; other < units.size(); ++other) {
    if (other == self) {
      continue;
    }
    // A pixel is lost if any of the centres in reach of it is one: (1 - p)^n must be the share that is left.
    const double lost = unit.vibrating || units[other].vibrating ? model.lost_share_vibrating : model.lost_share;
    const double centre_share = 1 - std::pow(1 - lost, 1.0 / static_cast<double>(spot.size()));
    const PixelRandom random(seed, frame, kSpots + other);
    const Transfer transfer(unit, units[other]);
    const int reach = static_cast<int>(model.spot_radius_px);
    const int width = unit.camera.width_px;
    const int height = unit.camera.height_px;
    std::uint64_t number = 0;  // of the pixel, with a border as wide as a spot reaches
    for (int v = -reach; v < height + reach; ++v) {
      for (int u = -reach; u < width + reach; ++u) {
        if (random.uniform(number++) >= centre_share) {
          continue;
        }
        for (const auto& [x, y] : spot) {
          if (unit.camera.contains(u + x, v + y) && transfer.lit(u + x, v + y)) {
            measured_m.at(u + x, v + y) = 0;
          }
        }
      }
    }
  }
}

}  // namespace depthgrid::simulation
