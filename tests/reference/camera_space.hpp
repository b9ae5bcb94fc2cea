// What one camera has not seen free: exact membership, an exact ball test, and for boxes the pixels that matter. Double
// precision and written for obviousness; shares no geometry with the product (own projection, own minimum filter).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/pose.hpp"
#include "reference/primitive.hpp"
#include "reference/pyramid_piece.hpp"

namespace depthgrid::reference {

/// Everything the oracle knows of one camera. The frame's buffers are read by the constructor only.
struct CameraInput {
  PinholeCamera camera;
  Pose T_world_camera = Pose::Identity();
  MeasurementRule rule;  ///< near_m is also the blind zone: nothing nearer is known free
  Frame frame;
  SensorMargin sensor;
  PoseMargin pose;
  double robot_pocket_m = 0;       ///< a robot pixel frees this much beyond the robot's exit
  double smallest_obstacle_m = 0;  ///< s of hole_readings.hpp; 0: a pixel without reading frees nothing
  /// Readings less their margin are lower by this share of the reading: one that shows the robot by less does not.
  double tie_share = 0;
};

/// The part of the camera's own view that counts, when it is the principal camera: space outside it is of no interest.
struct ViewLimits {
  double d_min_m, d_max_m;
};

class CameraSpace {
 public:
  explicit CameraSpace(const CameraInput& input);

  /// x is not known free and not the robot: x in N_k minus R_k, N_k = complement of { x projects inside the image and
  /// near_k < z < g_k(pixel of x) }.
  [[nodiscard]] bool not_free(const Eigen::Vector3d& p_world) const;

  /// The closed ball around p_world meets (the closure of) N_k minus R_k. Exact up to rounding.
  [[nodiscard]] bool ball_meets_not_free(const Eigen::Vector3d& p_world, double radius_m) const;

  /// Membership of the camera's factor of O: some y in N_k minus R_k with |x - y| <= e_k(x).
  [[nodiscard]] bool blocks(const Eigen::Vector3d& p_world) const;

  /// x projects inside the image with z > near_k, whatever was measured.
  [[nodiscard]] bool covers(const Eigen::Vector3d& p_world) const;
  /// The depths beyond near_k.
  [[nodiscard]] ViewLimits view_limits() const;
  /// True only if the camera covers no point of the box.
  [[nodiscard]] bool covers_nothing_of(const WorldBox& box) const;

  /// x lies in the view between the two depths.
  [[nodiscard]] bool in_view(const Eigen::Vector3d& p_world, const ViewLimits& limits) const;
  /// True only if no point of the box lies in the view between the two depths.
  [[nodiscard]] bool outside_view(const WorldBox& box, const ViewLimits& limits) const;
  /// Nearest point outside the view between the two depths, for a point inside it.
  [[nodiscard]] Eigen::Vector3d nearest_border_point(const Eigen::Vector3d& p_world, const ViewLimits& limits) const;

  /// g of a pixel of the image, metres; 0 = nothing is free.
  [[nodiscard]] double free_depth_m(int u, int v) const { return pixels_[index(u, v)].free_m; }

  /// Some pixels of the image plane, inclusive; may lie outside the image.
  struct PixelWindow {
    int u_first, v_first, u_last, v_last;
  };
  /// Up to four depth intervals [near, far] of one pixel, far may be infinite; those with near >= far hold nothing.
  using Depths = std::array<std::array<double, 2>, 4>;

  /// The depths z > 0 of a pixel of the image that are not known free and not the robot.
  [[nodiscard]] Depths not_free_depths(int u, int v) const;
  /// Asks visit(u, v) about the window's pixels until it says true, and returns that. Leaves out pixels whose pyramids
  /// have nothing not known free between the depths z_low_m and z_high_m or whose not known free part is farther than
  /// radius_m from p_camera, but not all of them: whole blocks are passed over. The window lies in the image.
  template <class Visit>
  [[nodiscard]] bool any_pixel(const PixelWindow& window, double z_low_m, double z_high_m,
                               const Eigen::Vector3d& p_camera, double radius_m, const Visit& visit) const;
  /// The pixel's pyramid between two depths.
  [[nodiscard]] PyramidPiece piece(int u, int v, double d1_m, double d2_m) const;
  /// All pixels on which the hull of the corners projects, or nothing when it is not wholly before the camera.
  [[nodiscard]] std::optional<PixelWindow> window_of(const std::array<Eigen::Vector3d, 8>& corners) const;
  [[nodiscard]] std::array<Eigen::Vector3d, 8> corners_in_camera(const WorldBox& box) const;
  /// How far inside the image's left, right, top and bottom border plane a point lies, camera frame; negative outside.
  [[nodiscard]] std::array<double, 4> inside_m(const Eigen::Vector3d& p_camera) const;

  [[nodiscard]] const PinholeCamera& intrinsics() const { return camera_; }
  [[nodiscard]] Eigen::Vector3d to_camera(const Eigen::Vector3d& p_world) const {
    return R_camera_world_ * (p_world - centre_world_);
  }
  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& p_camera) const {
    return R_camera_world_.transpose() * p_camera + centre_world_;
  }
  /// e at a point, metres.
  [[nodiscard]] double pose_error_m(const Eigen::Vector3d& p_world) const {
    return pose_error_at_range_m((p_world - centre_world_).norm());
  }
  [[nodiscard]] double pose_error_at_range_m(double range_m) const {
    return pose_.translation_m + pose_.rotation_rad * range_m + pose_.time_m;
  }
  [[nodiscard]] bool has_pose_error() const {
    return pose_.translation_m > 0 || pose_.rotation_rad > 0 || pose_.time_m > 0;
  }

 private:
  static constexpr int kBlock = 16;
  void note_first_depths();
  /// Whether the block may hold something not known free between the depths and within the radius.
  [[nodiscard]] bool block_matters(int i, int j, double z_low_m, double z_high_m, const Eigen::Vector3d& p_camera,
                                   double radius_m) const;
  /// The same of a strip, by the depths alone.
  [[nodiscard]] bool strip_matters(int i, int v, double z_low_m, double z_high_m) const {
    return z_low_m <= near_m_ || strips_m_[static_cast<std::size_t>(v * blocks_a_row_ + i)] <= z_high_m;
  }

  struct Pixel {
    double free_m = 0;        ///< g
    double robot_near_m = 0;  ///< 0: no robot
    double robot_far_m = 0;
  };

  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(camera_.width_px) + static_cast<std::size_t>(u);
  }

  PinholeCamera camera_;
  Eigen::Matrix3d R_camera_world_;
  Eigen::Vector3d centre_world_;
  double near_m_;
  PoseMargin pose_;
  /// Of the borders left, right, top and bottom: slope x/z or y/z and the inverse length of the plane's normal.
  std::array<double, 4> border_slopes_{};
  std::array<double, 4> border_scales_{};
  std::vector<Pixel> pixels_;
  /// Least depth beyond the blind zone that is not known free and not the robot, row by row: of kBlock pixels side by
  /// side, and of kBlock such strips below each other.
  std::vector<double> strips_m_, blocks_m_;
  int blocks_a_row_ = 0;
};

template <class Visit>
bool CameraSpace::any_pixel(const PixelWindow& window, double z_low_m, double z_high_m, const Eigen::Vector3d& p_camera,
                            double radius_m, const Visit& visit) const {
  for (int j = window.v_first / kBlock; j <= window.v_last / kBlock; ++j) {
    for (int i = window.u_first / kBlock; i <= window.u_last / kBlock; ++i) {
      if (!block_matters(i, j, z_low_m, z_high_m, p_camera, radius_m)) {
        continue;
      }
      const int v_last = std::min(window.v_last, (j + 1) * kBlock - 1);
      const int u_last = std::min(window.u_last, (i + 1) * kBlock - 1);
      for (int v = std::max(window.v_first, j * kBlock); v <= v_last; ++v) {
        for (int u = std::max(window.u_first, i * kBlock); u <= u_last && strip_matters(i, v, z_low_m, z_high_m); ++u) {
          if (visit(u, v)) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

}  // namespace depthgrid::reference
