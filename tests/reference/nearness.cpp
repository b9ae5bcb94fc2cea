#include "reference/nearness.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::reference {
namespace {

constexpr double kUnboundedM = std::numeric_limits<double>::infinity();
/// More than the rounding of any distance here.
constexpr double kNearnessRoundingM = 1e-9;
/// Boxes that project on more pixels are too large to be decided by single pixels: subdividing them is cheaper.
constexpr int kMaxPixels = 2048;
/// ...unless their half diagonal is this share of the pose error, or less: then the pose error makes them large.
constexpr double kSmallBesidePoseError = 0.25;

int width(const CameraSpace::PixelWindow& window) { return window.u_last - window.u_first + 1; }
int height(const CameraSpace::PixelWindow& window) { return window.v_last - window.v_first + 1; }

}  // namespace

Nearness::Nearness(const CameraSpace& camera, const Primitive& primitive, double enough_m)
    : camera_(&camera),
      a_camera_(camera.to_camera(primitive.a_world)),
      b_camera_(camera.to_camera(primitive.b_world)),
      enough_m_(enough_m + camera.pose_error_at_range_m(std::max(a_camera_.norm(), b_camera_.norm()) + enough_m)),
      farthest_m_(std::max(a_camera_.z(), b_camera_.z()) + enough_m_) {
  // Beyond a border plane lies a half space: the nearer end of the axis decides.
  const std::array<double, 4> inside_a_m = camera.inside_m(a_camera_);
  const std::array<double, 4> inside_b_m = camera.inside_m(b_camera_);
  for (std::size_t i = 0; i < border_m_.size(); ++i) {
    border_m_[i] = std::max(0.0, std::min(inside_a_m[i], inside_b_m[i]) - kNearnessRoundingM);
  }
  // The pixels in which a piece may be near enough.
  const WorldBox around = WorldBox{a_camera_.cwiseMin(b_camera_), a_camera_.cwiseMax(b_camera_)}.grown(enough_m_);
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[static_cast<std::size_t>(i)] = around.corner(i);
  }
  const PinholeCamera& image = camera.intrinsics();
  const CameraSpace::PixelWindow all{0, 0, image.width_px - 1, image.height_px - 1};
  const CameraSpace::PixelWindow window = camera.window_of(corners).value_or(all);
  kept_ = {std::max(window.u_first, 0), std::max(window.v_first, 0), std::min(window.u_last, all.u_last),
           std::min(window.v_last, all.v_last)};
  if (width(kept_) > 0 && height(kept_) > 0) {
    known_.resize(static_cast<std::size_t>(width(kept_)) * static_cast<std::size_t>(height(kept_)));
  }
}

const Nearness::Known& Nearness::piece_distance(int u, int v, std::size_t i, const std::array<double, 2>& depths) {
  const bool keep = u >= kept_.u_first && u <= kept_.u_last && v >= kept_.v_first && v <= kept_.v_last;
  std::array<Known, 4>& pixel =
      keep ? known_[static_cast<std::size_t>(v - kept_.v_first) * static_cast<std::size_t>(width(kept_)) +
                    static_cast<std::size_t>(u - kept_.u_first)]
           : unkept_;
  Known& known = pixel[i];
  if (!keep || std::isnan(known.distance_m)) {
    known = {enough_m_, Eigen::Vector3f::Zero()};
    if (depths[0] < farthest_m_) {
      const PyramidPiece piece = camera_->piece(u, v, depths[0], std::min(depths[1], farthest_m_));
      const Separation between = separation(piece, a_camera_, b_camera_, enough_m_);
      known.distance_m = std::min(enough_m_, std::max(0.0, between.lower_m - kNearnessRoundingM));
      known.nearest = between.nearest.cast<float>();
    }
  }
  return known;
}

double Nearness::of_blocked_m(const WorldBox& box, const std::optional<ViewLimits>& limits, double useless_m) {
  suspect_world_.reset();
  // Every point that is blocked has a point that is not known free within its pose error, which lies in the grown box,
  // and within this radius around the box's centre.
  double pose_error_m = 0;
  if (camera_->has_pose_error()) {
    for (int i = 0; i < 8; ++i) {
      pose_error_m = std::max(pose_error_m, camera_->pose_error_m(box.corner(i)));
    }
  }
  const double radius_m = pose_error_m + box.half_diagonal_m() + kNearnessRoundingM;
  const std::array<Eigen::Vector3d, 8> corners =
      camera_->corners_in_camera(pose_error_m > 0 ? box.grown(pose_error_m) : box);
  const std::optional<CameraSpace::PixelWindow> hull = camera_->window_of(corners);
  if (!hull) {
    return 0;
  }
  CameraSpace::PixelWindow window = *hull;
  double z_low = kUnboundedM;
  double z_high = -kUnboundedM;
  for (const Eigen::Vector3d& corner : corners) {
    z_low = std::min(z_low, corner.z() - kNearnessRoundingM);
    z_high = std::max(z_high, corner.z() + kNearnessRoundingM);
  }
  const PinholeCamera& image = camera_->intrinsics();
  const Eigen::Vector3d centre = camera_->to_camera(box.centre());
  double result_m = kUnboundedM;
  if (limits && pose_error_m == 0) {
    z_low = std::max(z_low, limits->d_min_m);
    z_high = std::min(z_high, limits->d_max_m);
    if (z_low > z_high) {
      return kUnboundedM;
    }
  } else {
    const std::array<bool, 4> leaves{window.u_first < 0, window.u_last >= image.width_px, window.v_first < 0,
                                     window.v_last >= image.height_px};
    const std::array<double, 4> inside_m = camera_->inside_m(centre);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (leaves[i] && inside_m[i] <= radius_m) {
        result_m = std::min(result_m, border_m_[i] - pose_error_m);
      }
    }
  }
  window = {std::max(window.u_first, 0), std::max(window.v_first, 0), std::min(window.u_last, image.width_px - 1),
            std::min(window.v_last, image.height_px - 1)};
  // Subdividing makes the window smaller only while the box is what makes it large.
  const bool many = width(window) > 0 && height(window) > 0 && width(window) * height(window) > kMaxPixels &&
                    box.half_diagonal_m() > kSmallBesidePoseError * pose_error_m;
  if (result_m <= useless_m) {
    return std::max(result_m, 0.0);
  }
  (void)camera_->any_pixel(window, z_low, z_high, centre, radius_m, [&](int u, int v) {
    const CameraSpace::Depths depths = camera_->not_free_depths(u, v);
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const auto& [d1_m, d2_m] = depths[i];
      if (d1_m >= d2_m || d1_m > z_high || d2_m < z_low) {
        continue;
      }
      if (many) {
        result_m = 0;
        return true;
      }
      const Known& known = piece_distance(u, v, i, depths[i]);
      if (known.distance_m - pose_error_m < result_m && camera_->piece(u, v, d1_m, d2_m).meets_ball(centre, radius_m)) {
        result_m = known.distance_m - pose_error_m;
        // Into the pixel's middle and away from the border by less than matters.
        const Eigen::Vector3d nearest = known.nearest.cast<double>();
        const double z = nearest.z() + 1e-7;
        const Eigen::Vector3d middle((u + 0.5 - image.cx_px) / image.fx_px * z,
                                     (v + 0.5 - image.cy_px) / image.fy_px * z, z);
        suspect_world_ = camera_->to_world(nearest + 1e-5 * (middle - nearest));
        if (result_m <= useless_m) {
          return true;
        }
      }
    }
    return false;
  });
  return std::max(result_m, 0.0);
}

}  // namespace depthgrid::reference
