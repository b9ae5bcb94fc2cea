#include "reference/camera_space.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace depthgrid::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Boxes are looked at a little larger than they are, so that rounding cannot let one slip beside a pixel.
constexpr double kRoundingPx = 1e-9;
constexpr double kRoundingM = 1e-12;

/// A reading as single-precision metres, 0 = no measurement.
float reading_m(const DepthView& view, const MeasurementRule& rule, int u, int v) {
  const char* row = static_cast<const char*>(view.data) + view.stride_bytes * v;
  float depth_m = 0;
  if (view.format == DepthFormat::uint16_units) {
    const std::uint16_t units = reinterpret_cast<const std::uint16_t*>(row)[u];
    const bool listed =
        std::find(rule.invalid_units.begin(), rule.invalid_units.end(), units) != rule.invalid_units.end();
    if (units == 0 || units == 65535 || listed) {
      return 0;
    }
    depth_m = static_cast<float>(units) * static_cast<float>(view.metres_per_unit);
  } else {
    depth_m = reinterpret_cast<const float*>(row)[u];
  }
  if (!std::isfinite(depth_m) || depth_m <= 0 || depth_m < static_cast<float>(rule.near_m)) {
    return 0;
  }
  if (depth_m > static_cast<float>(rule.far_m)) {
    return rule.clamp_beyond_far ? static_cast<float>(rule.far_m) : 0;
  }
  return depth_m;
}

/// Distance of x from an interval.
double gap(double x, double low, double high) { return std::max({low - x, x - high, 0.0}); }

/// A pixel's pyramid between two depths: a0 z <= x <= a1 z, b0 z <= y <= b1 z, d1 <= z <= d2.
struct Piece {
  double a0, a1, b0, b1, d1_m, d2_m;

  [[nodiscard]] double squared_distance_at(const Eigen::Vector3d& p, double z) const {
    const double dx = gap(p.x(), a0 * z, a1 * z);
    const double dy = gap(p.y(), b0 * z, b1 * z);
    return dx * dx + dy * dy + (p.z() - z) * (p.z() - z);
  }

  /// The squared distance to the slice at depth z is convex in z: golden-section search over the depths that a ball of
  /// this radius reaches.
  [[nodiscard]] bool meets_ball(const Eigen::Vector3d& p, double radius_m) const {
    double low = std::max(d1_m, p.z() - radius_m);
    double high = std::min(d2_m, p.z() + radius_m);
    if (low > high) {
      return false;
    }
    constexpr double kGolden = 0.6180339887498949;
    for (int step = 0; step < 60 && high - low > 1e-12; ++step) {
      const double left = high - kGolden * (high - low);
      const double right = low + kGolden * (high - low);
      const double at_left = squared_distance_at(p, left);
      const double at_right = squared_distance_at(p, right);
      if (std::min(at_left, at_right) <= radius_m * radius_m) {
        return true;
      }
      (at_left < at_right ? high : low) = at_left < at_right ? right : left;
    }
    return std::min(squared_distance_at(p, low), squared_distance_at(p, high)) <= radius_m * radius_m;
  }
};

}  // namespace

CameraSpace::CameraSpace(const CameraInput& input)
    : camera_(input.camera),
      R_camera_world_(input.T_world_camera.linear().transpose()),
      centre_world_(input.T_world_camera.translation()),
      near_m_(input.rule.near_m),
      pose_(input.pose),
      pixels_(static_cast<std::size_t>(input.camera.width_px) * static_cast<std::size_t>(input.camera.height_px)) {
  const DepthView& view = input.frame.depth;
  if (view.data == nullptr || view.width_px != camera_.width_px || view.height_px != camera_.height_px) {
    return;  // no frame: no measurement anywhere, nothing free
  }
  // D - m(D) of every pixel on its own, or the robot's exit where the pixel shows the robot.
  std::vector<double> reduced_m(pixels_.size(), 0.0);
  for (int v = 0; v < camera_.height_px; ++v) {
    for (int u = 0; u < camera_.width_px; ++u) {
      Pixel& pixel = pixels_[index(u, v)];
      if (input.frame.robot.near_m != nullptr) {
        pixel.robot_near_m = input.frame.robot.near_m[input.frame.robot.stride_px * v + u];
        pixel.robot_far_m = input.frame.robot.far_m[input.frame.robot.stride_px * v + u];
      }
      const double depth_m = reading_m(view, input.rule, u, v);
      if (depth_m > 0) {
        const SensorMargin& m = input.sensor;
        const double front_m = depth_m - (m.constant_m + m.linear * depth_m + m.quadratic_per_m * depth_m * depth_m);
        const bool shows_robot =
            pixel.robot_near_m > 0 && pixel.robot_near_m <= front_m && depth_m <= pixel.robot_far_m;
        reduced_m[index(u, v)] = std::max(0.0, shows_robot ? pixel.robot_far_m : front_m);
      }
    }
  }
  // The minimum over the neighbourhood; outside the image counts as 0.
  const int w = input.sensor.lateral_px;
  for (int v = 0; v < camera_.height_px; ++v) {
    for (int u = 0; u < camera_.width_px; ++u) {
      double smallest_m = kInfinity;
      for (int dv = -w; dv <= w; ++dv) {
        for (int du = -w; du <= w; ++du) {
          const bool inside = camera_.contains(u + du, v + dv);
          smallest_m = std::min(smallest_m, inside ? reduced_m[index(u + du, v + dv)] : 0.0);
        }
      }
      pixels_[index(u, v)].free_m = smallest_m;
    }
  }
}

bool CameraSpace::not_free(const Eigen::Vector3d& p_world) const {
  const Eigen::Vector3d p = to_camera(p_world);
  if (p.z() <= 0) {
    return true;
  }
  const double x_px = camera_.cx_px + camera_.fx_px * p.x() / p.z();
  const double y_px = camera_.cy_px + camera_.fy_px * p.y() / p.z();
  if (!(x_px >= 0 && y_px >= 0 && x_px < camera_.width_px && y_px < camera_.height_px)) {
    return true;
  }
  const Pixel& pixel = pixels_[index(static_cast<int>(x_px), static_cast<int>(y_px))];
  const bool free = near_m_ < p.z() && p.z() < pixel.free_m;
  const bool robot = pixel.robot_near_m > 0 && pixel.robot_near_m <= p.z() && p.z() <= pixel.robot_far_m;
  return !free && !robot;
}

std::array<double, 4> CameraSpace::border_slopes() const {
  return {-camera_.cx_px / camera_.fx_px, (camera_.width_px - camera_.cx_px) / camera_.fx_px,
          -camera_.cy_px / camera_.fy_px, (camera_.height_px - camera_.cy_px) / camera_.fy_px};
}

bool CameraSpace::ball_meets_not_free(const Eigen::Vector3d& p_world, double radius_m) const {
  const Eigen::Vector3d p = to_camera(p_world);
  if (p.z() <= radius_m) {
    return true;  // reaches the camera's plane or behind it
  }
  // Outside the image is the union of four half spaces (and what lies behind the camera).
  const auto [left, right, top, bottom] = border_slopes();
  const double inside_m =
      std::min({(p.x() - left * p.z()) / std::hypot(1.0, left), (right * p.z() - p.x()) / std::hypot(1.0, right),
                (p.y() - top * p.z()) / std::hypot(1.0, top), (bottom * p.z() - p.y()) / std::hypot(1.0, bottom)});
  if (inside_m <= radius_m) {
    return true;
  }
  // Inside the image, pixel by pixel: what is left of z > 0 without (near, g) and without the robot's interval.
  const WorldBox around{p - Eigen::Vector3d::Constant(radius_m), p + Eigen::Vector3d::Constant(radius_m)};
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[static_cast<std::size_t>(i)] = around.corner(i);
  }
  const std::optional<PixelWindow> window = window_of(corners);
  if (!window) {
    return true;
  }
  for (int v = std::max(window->v_first, 0); v <= std::min(window->v_last, camera_.height_px - 1); ++v) {
    for (int u = std::max(window->u_first, 0); u <= std::min(window->u_last, camera_.width_px - 1); ++u) {
      const Pixel& pixel = pixels_[index(u, v)];
      Piece piece{(u - camera_.cx_px) / camera_.fx_px,
                  (u + 1 - camera_.cx_px) / camera_.fx_px,
                  (v - camera_.cy_px) / camera_.fy_px,
                  (v + 1 - camera_.cy_px) / camera_.fy_px,
                  0,
                  0};
      // The two parts of z > 0 that are not free, each less the robot's interval.
      const double start_m = pixel.free_m > near_m_ ? pixel.free_m : near_m_;
      const std::array<std::array<double, 2>, 2> parts{{{0, near_m_}, {start_m, kInfinity}}};
      for (const auto& [from_m, to_m] : parts) {
        const bool robot = pixel.robot_near_m > 0;
        const std::array<std::array<double, 2>, 2> rest{
            {{from_m, robot ? std::min(to_m, pixel.robot_near_m) : to_m},
             {robot ? std::max(from_m, pixel.robot_far_m) : kInfinity, to_m}}};
        for (const auto& [d1_m, d2_m] : rest) {
          piece.d1_m = d1_m;
          piece.d2_m = d2_m;
          if (d1_m < d2_m && piece.meets_ball(p, radius_m)) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

bool CameraSpace::blocks(const Eigen::Vector3d& p_world) const {
  if (not_free(p_world)) {
    return true;
  }
  return has_reach() && ball_meets_not_free(p_world, reach_m((p_world - centre_world_).norm()));
}

std::array<Eigen::Vector3d, 8> CameraSpace::corners_in_camera(const WorldBox& box) const {
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[static_cast<std::size_t>(i)] = to_camera(box.corner(i));
  }
  return corners;
}

std::optional<CameraSpace::PixelWindow> CameraSpace::window_of(const std::array<Eigen::Vector3d, 8>& corners) const {
  // The projection of a convex set in front of the camera is the hull of its corners' projections.
  double u_low = kInfinity;
  double u_high = -kInfinity;
  double v_low = kInfinity;
  double v_high = -kInfinity;
  for (const Eigen::Vector3d& corner : corners) {
    if (corner.z() <= kRoundingM) {
      return std::nullopt;
    }
    const double x_px = camera_.cx_px + camera_.fx_px * corner.x() / corner.z();
    const double y_px = camera_.cy_px + camera_.fy_px * corner.y() / corner.z();
    u_low = std::min(u_low, x_px - kRoundingPx);
    u_high = std::max(u_high, x_px + kRoundingPx);
    v_low = std::min(v_low, y_px - kRoundingPx);
    v_high = std::max(v_high, y_px + kRoundingPx);
  }
  const auto pixel = [](double x_px) { return static_cast<int>(std::floor(std::clamp(x_px, -1e6, 1e6))); };
  return PixelWindow{pixel(u_low), pixel(v_low), pixel(u_high), pixel(v_high)};
}

bool CameraSpace::frees_box_unreached(const WorldBox& box, const std::optional<ViewLimits>& limits) const {
  const std::array<Eigen::Vector3d, 8> corners = corners_in_camera(box);
  std::optional<PixelWindow> window = window_of(corners);
  if (!window) {
    return false;
  }
  double z_low = kInfinity;
  double z_high = -kInfinity;
  for (const Eigen::Vector3d& corner : corners) {
    z_low = std::min(z_low, corner.z() - kRoundingM);
    z_high = std::max(z_high, corner.z() + kRoundingM);
  }
  if (limits) {
    window =
        PixelWindow{std::max(window->u_first, 0), std::max(window->v_first, 0),
                    std::min(window->u_last, camera_.width_px - 1), std::min(window->v_last, camera_.height_px - 1)};
    z_low = std::max(z_low, limits->d_min_m);
    z_high = std::min(z_high, limits->d_max_m);
  }
  if (window->u_first < 0 || window->v_first < 0 || window->u_last >= camera_.width_px ||
      window->v_last >= camera_.height_px) {
    return false;
  }
  for (int v = window->v_first; v <= window->v_last; ++v) {
    for (int u = window->u_first; u <= window->u_last; ++u) {
      const Pixel& pixel = pixels_[index(u, v)];
      const bool has_free = near_m_ < pixel.free_m;
      const bool has_robot = pixel.robot_near_m > 0;
      const bool in_free = near_m_ < z_low && z_high < pixel.free_m;
      const bool in_robot = has_robot && pixel.robot_near_m <= z_low && z_high <= pixel.robot_far_m;
      const bool joined = has_free && has_robot && pixel.robot_near_m <= pixel.free_m && near_m_ <= pixel.robot_far_m;
      const bool low_in = near_m_ < z_low || pixel.robot_near_m <= z_low;
      const bool high_in = z_high < pixel.free_m || z_high <= pixel.robot_far_m;
      if (!in_free && !in_robot && !(joined && low_in && high_in)) {
        return false;
      }
    }
  }
  return true;
}

bool CameraSpace::frees_box(const WorldBox& box, const std::optional<ViewLimits>& limits) const {
  if (!has_reach()) {
    return frees_box_unreached(box, limits);
  }
  double farthest_m = 0;
  for (int i = 0; i < 8; ++i) {
    farthest_m = std::max(farthest_m, (box.corner(i) - centre_world_).norm());
  }
  const double largest_reach_m = reach_m(farthest_m);
  if (frees_box_unreached(box.grown(largest_reach_m), std::nullopt)) {
    return true;
  }
  // The ball that holds every point's own ball is tighter once the box is small.
  const double radius_m = largest_reach_m + box.half_diagonal_m() + kRoundingM;
  return box.half_diagonal_m() < 4 * largest_reach_m && !ball_meets_not_free(box.centre(), radius_m);
}

ViewLimits CameraSpace::view_limits() const { return {std::nextafter(near_m_, kInfinity), kInfinity}; }

bool CameraSpace::covers(const Eigen::Vector3d& p_world) const { return in_view(p_world, view_limits()); }

bool CameraSpace::covers_nothing_of(const WorldBox& box) const { return outside_view(box, view_limits()); }

bool CameraSpace::in_view(const Eigen::Vector3d& p_world, const ViewLimits& limits) const {
  const Eigen::Vector3d p = to_camera(p_world);
  if (p.z() <= 0 || p.z() < limits.d_min_m || p.z() > limits.d_max_m) {
    return false;
  }
  const double x_px = camera_.cx_px + camera_.fx_px * p.x() / p.z();
  const double y_px = camera_.cy_px + camera_.fy_px * p.y() / p.z();
  return x_px >= 0 && y_px >= 0 && x_px < camera_.width_px && y_px < camera_.height_px;
}

bool CameraSpace::outside_view(const WorldBox& box, const ViewLimits& limits) const {
  // Wholly beyond one of the view's six planes.
  const std::array<Eigen::Vector3d, 8> corners = corners_in_camera(box);
  const auto [left, right, top, bottom] = border_slopes();
  const auto all = [&corners](auto beyond) { return std::all_of(corners.begin(), corners.end(), beyond); };
  using P = const Eigen::Vector3d&;
  return all([&](P p) { return p.z() < limits.d_min_m - kRoundingM; }) ||
         all([&](P p) { return p.z() > limits.d_max_m + kRoundingM; }) ||
         all([s = left](P p) { return p.x() < s * p.z() - kRoundingM; }) ||
         all([s = right](P p) { return p.x() > s * p.z() + kRoundingM; }) ||
         all([s = top](P p) { return p.y() < s * p.z() - kRoundingM; }) ||
         all([s = bottom](P p) { return p.y() > s * p.z() + kRoundingM; });
}

Eigen::Vector3d CameraSpace::nearest_border_point(const Eigen::Vector3d& p_world, const ViewLimits& limits) const {
  // Outward normals n and offsets c of the six planes n . x = c, camera frame.
  const auto [left, right, top, bottom] = border_slopes();
  struct Plane {
    Eigen::Vector3d normal;
    double offset_m;
  };
  const std::array<Plane, 6> planes{{{Eigen::Vector3d(-1, 0, left).normalized(), 0},
                                     {Eigen::Vector3d(1, 0, -right).normalized(), 0},
                                     {Eigen::Vector3d(0, -1, top).normalized(), 0},
                                     {Eigen::Vector3d(0, 1, -bottom).normalized(), 0},
                                     {Eigen::Vector3d(0, 0, -1), -limits.d_min_m},
                                     {Eigen::Vector3d(0, 0, 1), limits.d_max_m}}};
  const Eigen::Vector3d p = to_camera(p_world);
  Eigen::Vector3d nearest = p;
  double smallest_m = kInfinity;
  for (const Plane& plane : planes) {
    const double distance_m = plane.offset_m - plane.normal.dot(p);
    if (distance_m < smallest_m) {
      smallest_m = distance_m;
      nearest = p + (distance_m + kRoundingM) * plane.normal;
    }
  }
  return R_camera_world_.transpose() * nearest + centre_world_;
}

}  // namespace depthgrid::reference
