// The robot along one ray, slowly: each capsule's interval by the simulator's solids, sorted and merged.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::robot {

struct TwinPart {
  double near_m;
  double far_m;
};

/// Contiguous parts of the padded capsules along the ray through a pixel's centre, in front of the camera, nearest
/// first; and the first surface of the capsules themselves (infinity: none).
struct TwinRay {
  std::vector<TwinPart> parts;
  double surface_m = std::numeric_limits<double>::infinity();

  /// padding_m: one a capsule.
  TwinRay(const std::vector<Capsule>& capsules_camera, const std::vector<double>& padding_m,
          const PinholeCamera& camera, int u, int v) {
    const simulation::Line ray{Eigen::Vector3d::Zero(), deproject(camera, {u + 0.5, v + 0.5, 1.0})};
    std::vector<TwinPart> all;
    for (std::size_t i = 0; i < capsules_camera.size(); ++i) {
      const Capsule body{capsules_camera[i].a, capsules_camera[i].b, capsules_camera[i].radius_m};
      const simulation::Interval padded = intersect(simulation::grown(body, padding_m[i]), ray);
      if (!padded.empty() && padded.exit > 0) {
        all.push_back({padded.entry, padded.exit});
      }
      const simulation::Interval bare = intersect(body, ray);
      if (!bare.empty() && bare.exit > 0) {
        surface_m = std::min(surface_m, bare.entry);
      }
    }
    std::sort(all.begin(), all.end(), [](const TwinPart& a, const TwinPart& b) { return a.near_m < b.near_m; });
    for (const TwinPart& part : all) {
      if (!parts.empty() && part.near_m <= parts.back().far_m) {
        parts.back().far_m = std::max(parts.back().far_m, part.far_m);
      } else {
        parts.push_back(part);
      }
    }
  }

  /// The part that holds the depth, or null.
  [[nodiscard]] const TwinPart* part_at(double depth_m) const {
    for (const TwinPart& part : parts) {
      if (part.near_m <= depth_m && depth_m <= part.far_m) {
        return &part;
      }
    }
    return nullptr;
  }

  /// The part that the removal answers for this reading (0: none), or null where there is no robot.
  [[nodiscard]] const TwinPart* answer(double reading_m) const {
    if (const TwinPart* read = reading_m > 0 ? part_at(reading_m) : nullptr) {
      return read;
    }
    if (const TwinPart* seen = part_at(surface_m)) {
      return seen;
    }
    return parts.empty() ? nullptr : parts.data();
  }
};

}  // namespace depthgrid::robot
