// What one camera has not seen free: exact membership, an exact ball test and a sound proof for boxes. Double
// precision and written for obviousness; shares no geometry with the product (own projection, own minimum filter).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::reference {

/// Everything the oracle knows of one camera. The frame's buffers are read by the constructor only.
struct CameraInput {
  PinholeCamera camera;
  Pose T_world_camera = Pose::Identity();
  MeasurementRule rule;  ///< near_m is also the blind zone: nothing nearer is freed
  Frame frame;
  SensorMargin sensor;
  PoseMargin pose;
};

/// A box with axes along the world's, metres.
struct WorldBox {
  Eigen::Vector3d low, high;

  [[nodiscard]] Eigen::Vector3d centre() const { return 0.5 * (low + high); }
  [[nodiscard]] double half_diagonal_m() const { return 0.5 * (high - low).norm(); }
  [[nodiscard]] Eigen::Vector3d corner(int index) const {
    return {(index & 1) != 0 ? high.x() : low.x(), (index & 2) != 0 ? high.y() : low.y(),
            (index & 4) != 0 ? high.z() : low.z()};
  }
  [[nodiscard]] WorldBox grown(double by_m) const {
    return {low - Eigen::Vector3d::Constant(by_m), high + Eigen::Vector3d::Constant(by_m)};
  }
};

/// The part of the camera's own view that counts, when it is the principal camera: space outside it is of no interest.
struct ViewLimits {
  double d_min_m, d_max_m;
};

class CameraSpace {
 public:
  explicit CameraSpace(const CameraInput& input);

  /// x is not free and not the robot: x in N_k minus R_k, N_k = complement of { x projects inside the image and
  /// near_k < z < g_k(pixel of x) }.
  [[nodiscard]] bool not_free(const Eigen::Vector3d& p_world) const;

  /// The closed ball around p_world meets (the closure of) N_k minus R_k. Exact up to rounding.
  [[nodiscard]] bool ball_meets_not_free(const Eigen::Vector3d& p_world, double radius_m) const;

  /// Membership of the camera's factor of O: some y in N_k minus R_k with |x - y| <= e_k(x).
  [[nodiscard]] bool blocks(const Eigen::Vector3d& p_world) const;

  /// True only if no point of the box (or, with `limits`, no point of it in this camera's view between the two depths)
  /// is blocked by this camera. False proves nothing.
  [[nodiscard]] bool frees_box(const WorldBox& box, const std::optional<ViewLimits>& limits) const;

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

 private:
  struct Pixel {
    double free_m = 0;        ///< g
    double robot_near_m = 0;  ///< 0: no robot
    double robot_far_m = 0;
  };
  struct PixelWindow {
    int u_first, v_first, u_last, v_last;  ///< inclusive; may lie outside the image
  };

  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(camera_.width_px) + static_cast<std::size_t>(u);
  }
  [[nodiscard]] Eigen::Vector3d to_camera(const Eigen::Vector3d& p_world) const {
    return R_camera_world_ * (p_world - centre_world_);
  }
  [[nodiscard]] double reach_m(double range_m) const {
    return pose_.translation_m + pose_.rotation_rad * range_m + pose_.time_m;
  }
  [[nodiscard]] bool has_reach() const { return pose_.translation_m > 0 || pose_.rotation_rad > 0 || pose_.time_m > 0; }
  [[nodiscard]] std::array<Eigen::Vector3d, 8> corners_in_camera(const WorldBox& box) const;
  [[nodiscard]] std::optional<PixelWindow> window_of(const std::array<Eigen::Vector3d, 8>& corners) const;
  [[nodiscard]] bool frees_box_unreached(const WorldBox& box, const std::optional<ViewLimits>& limits) const;
  /// Slopes x/z and y/z of the image's four borders: left, right, top, bottom.
  [[nodiscard]] std::array<double, 4> border_slopes() const;

  PinholeCamera camera_;
  Eigen::Matrix3d R_camera_world_;
  Eigen::Vector3d centre_world_;
  double near_m_;
  PoseMargin pose_;
  std::vector<Pixel> pixels_;
};

}  // namespace depthgrid::reference
