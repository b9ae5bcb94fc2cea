#include "depthgrid/memory/seeds.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/views/ball_query.hpp"
#include "depthgrid/views/local_camera.hpp"

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;

/// A reading in a voxel that is not in the set: 21 bits for each of z, y, x, then whether the image shows it free.
constexpr int kBits = 21;
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
constexpr std::uint64_t kFree = std::uint64_t{1} << (3 * kBits);

struct Voxel {
  int x, y, z;
};

Voxel voxel_of(std::uint64_t key) noexcept {
  return {static_cast<int>(key & kMask), static_cast<int>((key >> kBits) & kMask),
          static_cast<int>((key >> (2 * kBits)) & kMask)};
}

/// Whether a reading lies in what the image shows free: it is the robot's, or stands before it.
bool shows_free(const views::PreparedImage& image, const SensorMargin& sensor, int u, int v, float depth_m) noexcept {
  const double margin_m = image.within_margin ? depth_margin_m(sensor, depth_m) : 0.0;
  return depth_m - margin_m < image.free_m.at(u, v) ||
         (image.has_islands && depth_m + margin_m >= image.island_near_m.at(u, v) &&
          depth_m - margin_m <= image.island_far_m.at(u, v));
}

/// The pixels in which the region is seen, or all of them where it begins behind the camera or right before it.
struct Seen {
  int first_u, end_u, first_v, end_v;
};

Seen pixels_of(const VoxelSet& voxels, const PinholeCamera& c, const Pose& T_world_camera) noexcept {
  constexpr double kNearest_m = 0.05;
  constexpr double kBeside_px = 2;
  double low_u = c.width_px;
  double high_u = 0;
  double low_v = c.height_px;
  double high_v = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d x((corner & 1) != 0 ? voxels.high_world().x() : voxels.low_world().x(),
                     (corner & 2) != 0 ? voxels.high_world().y() : voxels.low_world().y(),
                     (corner & 4) != 0 ? voxels.high_world().z() : voxels.low_world().z());
    const Vector3d p = T_world_camera.linear().transpose() * (x - T_world_camera.translation());
    if (!(p.z() > kNearest_m)) {
      return {0, c.width_px, 0, c.height_px};
    }
    const double u = c.fx_px * p.x() / p.z() + c.cx_px;
    const double v = c.fy_px * p.y() / p.z() + c.cy_px;
    low_u = std::min(low_u, u - kBeside_px);
    high_u = std::max(high_u, u + kBeside_px);
    low_v = std::min(low_v, v - kBeside_px);
    high_v = std::max(high_v, v + kBeside_px);
  }
  const auto pixel = [](double at, int end) { return static_cast<int>(std::clamp(at, 0.0, double{1} * end)); };
  return {pixel(low_u, c.width_px), pixel(high_u + 1, c.width_px), pixel(low_v, c.height_px),
          pixel(high_v + 1, c.height_px)};
}

/// The first of every n-th pixel that is not before this one.
int first_from(int pixel, int stride_px) noexcept {
  const int begin = stride_px / 2;
  return pixel <= begin ? begin : begin + (pixel - begin + stride_px - 1) / stride_px * stride_px;
}

/// Readings of an image that lie in voxels which are not in the set.
void gather(const views::View& view, const PinholeCamera& c, const SensorMargin& sensor, int stride_px,
            const VoxelSet& voxels, SeedScratch& scratch) noexcept {
  const views::PreparedImage& image = views::prepared(view);
  const Pose& T = view.T_world_camera();
  // In voxels from the region's corner.
  const Eigen::Vector3f origin = ((T.translation() - voxels.low_world()) / voxels.voxel_m()).cast<float>();
  const Eigen::Matrix3d axes = T.linear() / voxels.voxel_m();
  const Seen seen = pixels_of(voxels, c, T);
  std::vector<std::uint64_t>& found = scratch.readings;
  for (int v = first_from(seen.first_v, stride_px); v < seen.end_v; v += stride_px) {
    DepthImage& row_m = scratch.row_m;
    view.measured_row(v, row_m);
    const Eigen::Vector3f begin =
        (axes.col(2) + axes.col(1) * ((v + 0.5 - c.cy_px) / c.fy_px) + axes.col(0) * ((0.5 - c.cx_px) / c.fx_px))
            .cast<float>();
    const Eigen::Vector3f step = (axes.col(0) / c.fx_px).cast<float>();
    const RowOfReadings row{row_m.data(),
                            first_from(seen.first_u, stride_px),
                            seen.end_u,
                            stride_px,
                            {origin.x(), origin.y(), origin.z()},
                            {begin.x(), begin.y(), begin.z()},
                            {step.x(), step.y(), step.z()}};
    const std::size_t count = readings_outside(row, voxels, scratch.in_row.data());
    for (std::size_t n = 0; n < count && found.size() < found.capacity(); ++n) {
      const ReadingOutside& at = scratch.in_row[n];
      const std::uint64_t key = static_cast<std::uint64_t>(at.x) | static_cast<std::uint64_t>(at.y) << kBits |
                                static_cast<std::uint64_t>(at.z) << (2 * kBits);
      found.push_back(key | (shows_free(image, sensor, at.u, v, row_m.at(at.u, 0)) ? kFree : 0));
    }
  }
}

/// Whether another camera sees the whole voxel free, from when its image was taken to the space's time.
bool is_freed(const views::Snapshot& snapshot, std::size_t camera, const PossibleSpace& space,
              const Vector3d& centre_world) noexcept {
  const views::View& view = snapshot.view(camera);
  if (!view.present() || !std::isfinite(view.time_s())) {
    return false;
  }
  const CameraMargins& margins = snapshot.settings().margins[camera];
  const double moves_s = std::abs(view.time_s() - space.time_s) + margins.half_exposure_s + margins.time_uncertainty_s;
  const double voxel_m = kVoxelHalfDiagonal * space.voxels.voxel_m();
  views::LocalCamera local;
  make_local(snapshot, camera, centre_world, 1, local);
  const Vector3d p = local.to_camera(Vector3d::Zero());
  const double radius_m = voxel_m + margins.translation_m + margins.rotation_rad * (p.norm() + voxel_m) +
                          motion_margin_m(margins, snapshot.settings().v_max_m_s * moves_s);
  return !views::meets_not_known_free(local, views::Clip{}, p, radius_m);
}

}  // namespace

int seed_stride_px(const PinholeCamera& camera, const Pose& T_world_camera, const VoxelSet& voxels) noexcept {
  double farthest_m = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d x((corner & 1) != 0 ? voxels.high_world().x() : voxels.low_world().x(),
                     (corner & 2) != 0 ? voxels.high_world().y() : voxels.low_world().y(),
                     (corner & 4) != 0 ? voxels.high_world().z() : voxels.low_world().z());
    farthest_m = std::max(farthest_m, T_world_camera.linear().col(2).dot(x - T_world_camera.translation()));
  }
  const double across_px = std::min(camera.fx_px, camera.fy_px) * voxels.voxel_m() / farthest_m;
  return farthest_m > 0 ? static_cast<int>(std::clamp(across_px / 2, 1.0, 8.0)) : 1;
}

Seeded put_back(const views::Snapshot& snapshot, std::size_t camera, double thinnest_hidden_m, PossibleSpace& space,
                SeedScratch& scratch) noexcept {
  VoxelSet& voxels = space.voxels;
  const views::View& view = snapshot.view(camera);
  const PinholeCamera& pinhole = snapshot.camera(camera).intrinsics;
  const CameraMargins& margins = snapshot.settings().margins[camera];
  const int stride_px = seed_stride_px(pinhole, view.T_world_camera(), voxels);
  std::vector<std::uint64_t>& found = scratch.readings;
  found.clear();
  gather(view, pinhole, margins.sensor, stride_px, voxels, scratch);
  std::sort(found.begin(), found.end(), [](std::uint64_t a, std::uint64_t b) { return (a & ~kFree) < (b & ~kFree); });
  Seeded result;
  const double samples = 1.0 / (stride_px * stride_px);
  for (std::size_t first = 0; first < found.size();) {
    const std::uint64_t key = found[first] & ~kFree;
    std::size_t last = first;
    bool robot = false;
    for (; last < found.size() && (found[last] & ~kFree) == key; ++last) {
      robot = robot || (found[last] & kFree) != 0;
    }
    const auto readings = static_cast<double>(last - first);
    first = last;
    const Voxel voxel = voxel_of(key);
    const Vector3d centre = voxels.centre_world(voxel.x, voxel.y, voxel.z);
    const Vector3d p = view.T_world_camera().linear().transpose() * (centre - view.T_world_camera().translation());
    const double across = voxels.voxel_m() / p.z();
    const double possible = pinhole.fx_px * pinhole.fy_px * across * across * samples;
    if (robot || readings < std::max(static_cast<double>(kFewestReadings), kSeedShare * possible)) {
      continue;
    }
    bool freed = false;
    for (std::size_t k = 0; k < snapshot.camera_count() && !freed; ++k) {
      freed = k != camera && is_freed(snapshot, k, space, centre);
    }
    if (freed) {
      continue;
    }
    const Vector3d half = Vector3d::Constant(0.5 * voxels.voxel_m());
    const double error_m =
        depth_margin_m(margins.sensor, p.z()) + margins.translation_m + margins.rotation_rad * p.norm() +
        motion_margin_m(margins,
                        snapshot.settings().v_max_m_s * (margins.half_exposure_s + margins.time_uncertainty_s));
    const double within_m = space.pending_m + 0.5 * thinnest_hidden_m + error_m;
    if (!voxels.meets(centre - half, centre + half, within_m)) {
      ++result.impossible;
      result.impossible_at_world = centre;
    }
    found[static_cast<std::size_t>(result.voxels++)] = key;  // what was to be read there has been
  }
  // Not before all have been asked: each would explain its neighbours.
  for (std::int64_t n = 0; n < result.voxels; ++n) {
    const Voxel voxel = voxel_of(found[static_cast<std::size_t>(n)]);
    voxels.set(voxel.x, voxel.y, voxel.z);
  }
  return result;
}

}  // namespace depthgrid::memory
