// Depth images to points in the world frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lab/peers/masked_image.hpp"
#include "lab/peers/peer.hpp"

namespace depthgrid::lab {

/// Which points of the clouds a peer keeps.
enum class Crop : std::uint8_t {
  full,    ///< all of them
  cell,    ///< those in the space of interest
  region,  ///< those in the box that contains the arm, and rho around it
};

/// Deprojects images through a table of rays, one row at a time. Buffers are allocated once.
class Deprojector {
 public:
  explicit Deprojector(const Rig& rig);

  /// Calls append(x, y, z) (floats, world frame, metres) for every measured point that is not the robot and lies in the
  /// box; `box` null: all points.
  template <class Append>
  void run(std::span<const Frame> frames, const Region* box, Append append);

 private:
  struct Camera {
    MeasurementRule rule;
    std::vector<float> slope_x, slope_y;  ///< x/z of each column, y/z of each row
    Eigen::Matrix3f rotation;
    Eigen::Vector3f translation;
  };
  /// World coordinates of row v into x_, y_, z_; keep_ says which of them count.
  void row(const Camera& camera, int v, const Region* box);

  std::vector<Camera> cameras_;
  DepthImage depth_m_;
  std::vector<float> x_, y_, z_, keep_;
};

/// Keeps the first point of every voxel of a box.
class VoxelFilter {
 public:
  VoxelFilter(const Region& box, double side_m);
  void clear();
  /// True for the first point in its voxel since clear(). The point must lie in the box.
  bool first(float x, float y, float z);

 private:
  Eigen::Vector3f low_;
  float per_side_;
  std::array<std::size_t, 3> count_;
  std::vector<std::uint64_t> seen_;
};

[[nodiscard]] inline const Region* crop_box(Crop crop, const Region& cell, const Region& region) {
  return crop == Crop::full ? nullptr : crop == Crop::cell ? &cell : &region;
}

template <class Append>
void Deprojector::run(std::span<const Frame> frames, const Region* box, Append append) {
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    if (depth_m_.width_px() != frames[k].depth.width_px || depth_m_.height_px() != frames[k].depth.height_px) {
      depth_m_ = DepthImage(frames[k].depth.width_px, frames[k].depth.height_px);
    }
    robot_removed(frames[k], cameras_[k].rule, depth_m_);
    for (int v = 0; v < depth_m_.height_px(); ++v) {
      row(cameras_[k], v, box);
      for (std::size_t u = 0; u < static_cast<std::size_t>(depth_m_.width_px()); ++u) {
        if (keep_[u] != 0.0F) {
          append(x_[u], y_[u], z_[u]);
        }
      }
    }
  }
}

}  // namespace depthgrid::lab
