#include "memory/memory_twin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/memory/seeds.hpp"
#include "depthgrid/views/prepared_image.hpp"

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Closer to a ball's radius than this nothing is asked of the exact test.
constexpr double kBrink = 1e-7;
/// Nearer to a voxel's side, in voxels, a reading may lie on either.
constexpr double kBesideVoxel = 1e-3;

struct Part {
  double begin_m, end_m;
};

/// The depths of a pixel that are not known free, the robot taken out.
std::vector<Part> not_free(const views::PreparedImage& image, double blind_m, int u, int v) {
  std::vector<Part> parts{{std::max(static_cast<double>(image.free_m.at(u, v)), blind_m), kInfinity}};
  if (blind_m > 0) {
    parts.push_back({0, blind_m});
  }
  if (!image.has_islands || !(image.island_near_m.at(u, v) <= image.island_far_m.at(u, v))) {
    return parts;
  }
  const auto low_m = static_cast<double>(image.island_near_m.at(u, v));
  const auto high_m = static_cast<double>(image.island_far_m.at(u, v));
  std::vector<Part> rest;
  for (const Part& part : parts) {
    if (part.begin_m < low_m) {
      rest.push_back({part.begin_m, std::min(part.end_m, low_m)});
    }
    if (part.end_m > high_m) {
      rest.push_back({std::max(part.begin_m, high_m), part.end_m});
    }
  }
  return rest;
}

Vector3d in_camera(const Pose& T_world_camera, const Vector3d& x_world) {
  return T_world_camera.linear().transpose() * (x_world - T_world_camera.translation());
}

}  // namespace

double distance_to_not_free_m(const views::View& view, const RigCamera& camera, const Vector3d& p) {
  const PinholeCamera& c = camera.intrinsics;
  if (!(p.z() > 0)) {
    return 0;
  }
  double inside_m = kInfinity;
  for (const auto& [x, slope] :
       {std::pair{p.x(), -c.cx_px / c.fx_px}, std::pair{-p.x(), (c.cx_px - c.width_px) / c.fx_px},
        std::pair{p.y(), -c.cy_px / c.fy_px}, std::pair{-p.y(), (c.cy_px - c.height_px) / c.fy_px}}) {
    inside_m = std::min(inside_m, (x - slope * p.z()) / std::hypot(1, slope));
  }
  if (!(inside_m > 0)) {
    return 0;
  }
  double square = inside_m * inside_m;
  for (int v = 0; v < c.height_px; ++v) {
    for (int u = 0; u < c.width_px; ++u) {
      for (const Part& part : not_free(views::prepared(view), camera.rule.near_m, u, v)) {
        square = std::min(square, squared_distance(pixel_frustum(c, u, v, part.begin_m, part.end_m), p));
      }
    }
  }
  return std::sqrt(square);
}

MemoryTwin::MemoryTwin(const views::Settings& settings, const MemorySettings& memory, const VoxelSet& first)
    : settings_(settings),
      memory_(memory),
      low_(first.low_world()),
      nx_(first.voxels()[0]),
      ny_(first.voxels()[1]),
      nz_(first.voxels()[2]),
      bits_(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) * static_cast<std::size_t>(nz_)),
      time_s_(std::numeric_limits<double>::quiet_NaN()) {
  for (int z = 0; z < nz_; ++z) {
    for (int y = 0; y < ny_; ++y) {
      for (int x = 0; x < nx_; ++x) {
        bits_[index(x, y, z)] = first.contains(x, y, z) ? 1 : 0;
        everything_ = everything_ && first.contains(x, y, z);
      }
    }
  }
  steps_.push_back({time_s_, false, bits_});
}

std::size_t MemoryTwin::index(int x, int y, int z) const {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(nx_) +
         static_cast<std::size_t>(x);
}

bool MemoryTwin::before(const std::vector<std::uint8_t>& bits, int x, int y, int z) const {
  return x < 0 || y < 0 || z < 0 || x >= nx_ || y >= ny_ || z >= nz_ || bits[index(x, y, z)] != 0;
}

void MemoryTwin::grow(double motion_m, double until_s) {
  if (everything_) {
    return;
  }
  const double before_m = pending_m_;
  pending_m_ += motion_m;
  if (pending_m_ >= memory_.voxel_m * (0.5 * std::min({nx_, ny_, nz_}) + 2)) {
    std::fill(bits_.begin(), bits_.end(), std::uint8_t{1});
    pending_m_ = 0;
    everything_ = true;
    steps_.push_back({until_s, false, bits_});
  }
  int done = 0;
  for (; pending_m_ >= memory_.voxel_m; pending_m_ -= memory_.voxel_m) {
    const std::vector<std::uint8_t> old = bits_;
    for (int z = 0; z < nz_; ++z) {
      for (int y = 0; y < ny_; ++y) {
        for (int x = 0; x < nx_; ++x) {
          for (int i = 0; i < 27; ++i) {
            if (before(old, x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1)) {
              bits_[index(x, y, z)] = 1;
            }
          }
        }
      }
    }
    // Due when everything had moved by this many voxels.
    const double share = (++done * memory_.voxel_m - before_m) / motion_m;
    steps_.push_back({time_s_ + share * (until_s - time_s_), true, bits_});
  }
}

void MemoryTwin::carve(const views::Snapshot& snapshot, std::size_t camera, double late_s, const VoxelSet& other) {
  const views::View& view = snapshot.view(camera);
  const CameraMargins& margins = settings_.margins[camera];
  const double around_m =
      std::max(0.0, memory_.voxel_m * std::sqrt(3.0) / 2 + pending_m_ - memory_.thinnest_hidden_m / 2);
  const double moved_m = settings_.v_max_m_s * (margins.half_exposure_s + margins.time_uncertainty_s + late_s) *
                         (1 + margins.rotation_rad);
  for (int z = 0; z < nz_; ++z) {
    for (int y = 0; y < ny_; ++y) {
      for (int x = 0; x < nx_; ++x) {
        std::uint8_t& bit = bits_[index(x, y, z)];
        if (bit == 0) {
          continue;
        }
        const Vector3d p =
            in_camera(view.T_world_camera(), low_ + memory_.voxel_m * Vector3d(x + 0.5, y + 0.5, z + 0.5));
        // e at the farthest point of the ball.
        const double radius_m =
            around_m + margins.translation_m + margins.rotation_rad * (p.norm() + around_m) + moved_m;
        const double free_m = distance_to_not_free_m(view, snapshot.camera(camera), p);
        if (std::abs(free_m - radius_m) < kBrink) {
          ++brinks_;
          bit = other.contains(x, y, z) ? 1 : 0;
        } else if (free_m > radius_m) {
          bit = 0;
          ++carved_;
        }
        everything_ = everything_ && bit != 0;
      }
    }
  }
}

void MemoryTwin::clear_robot(const views::Snapshot& snapshot, std::size_t camera, double late_s,
                             const VoxelSet& other) {
  const double moved_m = settings_.v_max_m_s * (settings_.margins[camera].time_uncertainty_s + late_s);
  const double half_m = memory_.voxel_m * std::sqrt(3.0) / 2;
  for (const Capsule& link : views::prepared(snapshot.view(camera)).links_world) {
    for (int z = 0; z < nz_; ++z) {
      for (int y = 0; y < ny_; ++y) {
        for (int x = 0; x < nx_; ++x) {
          std::uint8_t& bit = bits_[index(x, y, z)];
          const Vector3d centre = low_ + memory_.voxel_m * Vector3d(x + 0.5, y + 0.5, z + 0.5);
          const Vector3d axis = link.b - link.a;
          const double square = axis.squaredNorm();
          const double along = square > 0 ? std::clamp((centre - link.a).dot(axis) / square, 0.0, 1.0) : 0.0;
          // What the voxel stands for, farthest from the axis; of centres, half a ball nearer than its points.
          const double farthest_m =
              (centre - link.a - along * axis).norm() + half_m + pending_m_ - memory_.thinnest_hidden_m / 2 + moved_m;
          if (bit != 0 && std::abs(farthest_m - link.radius_m) < kBrink) {
            ++brinks_;
            bit = other.contains(x, y, z) ? 1 : 0;
          } else if (bit != 0 && farthest_m < link.radius_m) {
            bit = 0;
            ++robots_;
          }
          everything_ = everything_ && bit != 0;
        }
      }
    }
  }
}

bool MemoryTwin::is_freed(const views::Snapshot& snapshot, std::size_t camera, const Vector3d& centre_world) const {
  const views::View& view = snapshot.view(camera);
  if (!view.present()) {
    return false;
  }
  const CameraMargins& margins = settings_.margins[camera];
  const Vector3d p = in_camera(view.T_world_camera(), centre_world);
  const double half_m = memory_.voxel_m * std::sqrt(3.0) / 2;
  const double e_m = margins.translation_m + margins.rotation_rad * (p.norm() + half_m) +
                     settings_.v_max_m_s *
                         (std::abs(view.time_s() - time_s_) + margins.half_exposure_s + margins.time_uncertainty_s) *
                         (1 + margins.rotation_rad);
  return distance_to_not_free_m(view, snapshot.camera(camera), p) > half_m + e_m;
}

void MemoryTwin::seed(const views::Snapshot& snapshot, std::size_t camera, const VoxelSet& other) {
  const views::View& view = snapshot.view(camera);
  const views::PreparedImage& image = views::prepared(view);
  const PinholeCamera& c = snapshot.camera(camera).intrinsics;
  const int stride = seed_stride_px(c, view.T_world_camera(), other);
  std::vector<int> surely(bits_.size());
  std::vector<int> perhaps(bits_.size());
  std::vector<bool> robot(bits_.size());
  std::vector<bool> perhaps_robot(bits_.size());
  for (int v = stride / 2; v < c.height_px; v += stride) {
    for (int u = stride / 2; u < c.width_px; u += stride) {
      const float depth_m = view.measured_m(u, v);
      if (!(depth_m > 0)) {
        continue;
      }
      const double margin_m = image.within_margin ? depth_margin_m(settings_.margins[camera].sensor, depth_m) : 0.0;
      const bool free = depth_m - margin_m < image.free_m.at(u, v) ||
                        (image.has_islands && depth_m + margin_m >= image.island_near_m.at(u, v) &&
                         depth_m - margin_m <= image.island_far_m.at(u, v));
      const Vector3d x_world = view.T_world_camera() * deproject(c, {u + 0.5, v + 0.5, static_cast<double>(depth_m)});
      const Vector3d cell = (x_world - low_) / memory_.voxel_m;
      const Vector3d least = (cell.array() - kBesideVoxel).floor();
      const Vector3d most = (cell.array() + kBesideVoxel).floor();
      for (int z = static_cast<int>(least.z()); z <= static_cast<int>(most.z()); ++z) {
        for (int y = static_cast<int>(least.y()); y <= static_cast<int>(most.y()); ++y) {
          for (int x = static_cast<int>(least.x()); x <= static_cast<int>(most.x()); ++x) {
            if (x >= 0 && y >= 0 && z >= 0 && x < nx_ && y < ny_ && z < nz_) {
              const std::size_t n = index(x, y, z);
              surely[n] += least == most ? 1 : 0;
              ++perhaps[n];
              robot[n] = robot[n] || (free && least == most);
              perhaps_robot[n] = perhaps_robot[n] || free;
            }
          }
        }
      }
    }
  }
  for (int z = 0; z < nz_; ++z) {
    for (int y = 0; y < ny_; ++y) {
      for (int x = 0; x < nx_; ++x) {
        const std::size_t n = index(x, y, z);
        const Vector3d centre = low_ + memory_.voxel_m * Vector3d(x + 0.5, y + 0.5, z + 0.5);
        const double across = memory_.voxel_m / in_camera(view.T_world_camera(), centre).z();
        const double enough = std::max(2.0, 0.3 * c.fx_px * c.fy_px * across * across / (stride * stride));
        if (bits_[n] != 0 || perhaps[n] < enough || robot[n]) {
          continue;
        }
        bool freed = false;
        for (std::size_t k = 0; k < snapshot.camera_count() && !freed; ++k) {
          freed = k != camera && is_freed(snapshot, k, centre);
        }
        if (freed) {
          continue;
        }
        if (surely[n] < enough || perhaps_robot[n]) {
          bits_[n] = other.contains(x, y, z) ? 1 : 0;
          ++brinks_;
        } else {
          bits_[n] = 1;
          ++put_back_;
        }
      }
    }
  }
}

void MemoryTwin::take(const views::Snapshot& snapshot, std::size_t camera, const VoxelSet& other) {
  const double time_s = snapshot.view(camera).time_s();
  if (time_s > time_s_) {
    grow(settings_.v_max_m_s * (time_s - time_s_), time_s);
  }
  if (everything_ && time_s < time_s_) {
    steps_.assign(1, {time_s, false, bits_});
  }
  if (everything_ || !(time_s <= time_s_)) {
    time_s_ = time_s;
  }
  carve(snapshot, camera, time_s_ - time_s, other);
  clear_robot(snapshot, camera, time_s_ - time_s, other);
  steps_.push_back({time_s_, false, bits_});
  seed(snapshot, camera, other);
  steps_.push_back({time_s_, false, bits_});
}

}  // namespace depthgrid::memory
