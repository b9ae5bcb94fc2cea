#include "reference/camera_space.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "reference/hole_readings.hpp"

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
    depth_m = static_cast<float>(units * view.metres_per_unit);
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

}  // namespace

CameraSpace::CameraSpace(const CameraInput& input)
    : camera_(input.camera),
      R_camera_world_(input.T_world_camera.linear().transpose()),
      centre_world_(input.T_world_camera.translation()),
      near_m_(input.rule.near_m),
      pose_(input.pose),
      border_slopes_{-camera_.cx_px / camera_.fx_px, (camera_.width_px - camera_.cx_px) / camera_.fx_px,
                     -camera_.cy_px / camera_.fy_px, (camera_.height_px - camera_.cy_px) / camera_.fy_px},
      pixels_(static_cast<std::size_t>(input.camera.width_px) * static_cast<std::size_t>(input.camera.height_px)) {
  for (std::size_t i = 0; i < 4; ++i) {
    border_scales_[i] = 1 / std::hypot(1.0, border_slopes_[i]);
  }
  const DepthView& view = input.frame.depth;
  if (view.data == nullptr || view.width_px != camera_.width_px || view.height_px != camera_.height_px) {
    note_first_depths();
    return;  // no frame: no measurement anywhere, nothing free
  }
  std::vector<float> readings_m(pixels_.size());
  for (int v = 0; v < camera_.height_px; ++v) {
    for (int u = 0; u < camera_.width_px; ++u) {
      readings_m[index(u, v)] = reading_m(view, input.rule, u, v);
    }
  }
  const std::vector<float> measured_m = readings_m;
  if (input.smallest_obstacle_m > 0) {
    readings_m = with_holes_filled(readings_m, camera_, input.rule, input.sensor, view, input.smallest_obstacle_m);
  }
  // D - m(D) of every pixel on its own, or the robot's exit where the pixel shows the robot.
  std::vector<double> reduced_m(pixels_.size(), 0.0);
  // What a pixel says of its neighbours: the same, but nothing where it shows the robot and nothing else.
  std::vector<double> beside_m(pixels_.size(), 0.0);
  for (int v = 0; v < camera_.height_px; ++v) {
    for (int u = 0; u < camera_.width_px; ++u) {
      Pixel& pixel = pixels_[index(u, v)];
      if (input.frame.robot.near_m != nullptr) {
        const double near_m = input.frame.robot.near_m[input.frame.robot.stride_px * v + u];
        const double far_m = input.frame.robot.far_m[input.frame.robot.stride_px * v + u];
        if (near_m > 0 && near_m <= far_m && std::isfinite(far_m)) {
          pixel.robot_near_m = near_m;
          pixel.robot_far_m = far_m;
        }
      }
      const double depth_m = readings_m[index(u, v)];
      if (depth_m > 0) {
        const SensorMargin& m = input.sensor;
        const double margin_m = m.constant_m + m.linear * depth_m + m.quadratic_per_m * depth_m * depth_m;
        const double front_m = depth_m - margin_m;
        const double tie_m = input.tie_share * depth_m;
        // All that the reading may mean, from D - m to D, or some of it, from D - m to D + m.
        const bool within = input.frame.robot.within_margin;
        const bool shows_robot = pixel.robot_near_m > 0 &&
                                 pixel.robot_near_m <= (within ? depth_m + margin_m : front_m) - tie_m &&
                                 (within ? front_m : depth_m) <= pixel.robot_far_m;
        reduced_m[index(u, v)] =
            std::max(0.0, shows_robot ? pixel.robot_far_m + input.robot_pocket_m : front_m - tie_m);
        const bool nothing_else = within && shows_robot && measured_m[index(u, v)] > 0 && front_m > 0 &&
                                  depth_m + margin_m <= pixel.robot_far_m;
        beside_m[index(u, v)] = nothing_else ? kInfinity : reduced_m[index(u, v)];
      }
    }
  }
  // The minimum over the neighbourhood; outside the image counts as 0.
  const int w = input.sensor.lateral_px;
  for (int v = 0; v < camera_.height_px; ++v) {
    for (int u = 0; u < camera_.width_px; ++u) {
      double smallest_m = reduced_m[index(u, v)];
      for (int dv = -w; dv <= w; ++dv) {
        for (int du = -w; du <= w; ++du) {
          const bool inside = camera_.contains(u + du, v + dv);
          smallest_m = std::min(smallest_m, inside ? beside_m[index(u + du, v + dv)] : 0.0);
        }
      }
      pixels_[index(u, v)].free_m = smallest_m;
    }
  }
  note_first_depths();
}

void CameraSpace::note_first_depths() {
  const auto blocks = [](int pixels) { return (pixels + kBlock - 1) / kBlock; };
  blocks_a_row_ = blocks(camera_.width_px);
  const auto row = static_cast<std::size_t>(blocks_a_row_);
  strips_m_.assign(row * static_cast<std::size_t>(camera_.height_px), kInfinity);
  blocks_m_.assign(row * static_cast<std::size_t>(blocks(camera_.height_px)), kInfinity);
  for (int v = 0; v < camera_.height_px; ++v) {
    for (int u = 0; u < camera_.width_px; ++u) {
      for (const auto& [d1_m, d2_m] : not_free_depths(u, v)) {
        if (d1_m < d2_m && d2_m > near_m_) {
          double& strip_m = strips_m_[static_cast<std::size_t>(v * blocks_a_row_ + u / kBlock)];
          double& block_m = blocks_m_[static_cast<std::size_t>(v / kBlock * blocks_a_row_ + u / kBlock)];
          strip_m = std::min(strip_m, d1_m);
          block_m = std::min(block_m, d1_m);
        }
      }
    }
  }
}

bool CameraSpace::block_matters(int i, int j, double z_low_m, double z_high_m, const Eigen::Vector3d& p_camera,
                                double radius_m) const {
  const double first_m = z_low_m <= near_m_ ? 0.0 : blocks_m_[static_cast<std::size_t>(j * blocks_a_row_ + i)];
  if (first_m > z_high_m) {
    return false;
  }
  const PyramidPiece block{(i * kBlock - camera_.cx_px) / camera_.fx_px,
                           ((i + 1) * kBlock - camera_.cx_px) / camera_.fx_px,
                           (j * kBlock - camera_.cy_px) / camera_.fy_px,
                           ((j + 1) * kBlock - camera_.cy_px) / camera_.fy_px,
                           first_m,
                           kInfinity};
  return block.meets_ball(p_camera, radius_m + kRoundingM);
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

CameraSpace::Depths CameraSpace::not_free_depths(int u, int v) const {
  const Pixel& pixel = pixels_[index(u, v)];
  // The blind zone and what begins at g, each less the robot's interval.
  const double start_m = std::max(pixel.free_m, near_m_);
  if (pixel.robot_near_m <= 0) {
    return {{{0, near_m_}, {start_m, kInfinity}, {0, 0}, {0, 0}}};
  }
  return {{{0, std::min(near_m_, pixel.robot_near_m)},
           {start_m, pixel.robot_near_m},
           {pixel.robot_far_m, near_m_},
           {std::max(start_m, pixel.robot_far_m), kInfinity}}};
}

PyramidPiece CameraSpace::piece(int u, int v, double d1_m, double d2_m) const {
  return {(u - camera_.cx_px) / camera_.fx_px,
          (u + 1 - camera_.cx_px) / camera_.fx_px,
          (v - camera_.cy_px) / camera_.fy_px,
          (v + 1 - camera_.cy_px) / camera_.fy_px,
          d1_m,
          d2_m};
}

std::array<double, 4> CameraSpace::inside_m(const Eigen::Vector3d& p) const {
  return {
      (p.x() - border_slopes_[0] * p.z()) * border_scales_[0], (border_slopes_[1] * p.z() - p.x()) * border_scales_[1],
      (p.y() - border_slopes_[2] * p.z()) * border_scales_[2], (border_slopes_[3] * p.z() - p.y()) * border_scales_[3]};
}

bool CameraSpace::ball_meets_not_free(const Eigen::Vector3d& p_world, double radius_m) const {
  const Eigen::Vector3d p = to_camera(p_world);
  if (p.z() <= radius_m) {
    return true;  // reaches the camera's plane or behind it
  }
  // Outside the image is the union of four half spaces (and what lies behind the camera).
  const std::array<double, 4> inside = inside_m(p);
  if (*std::min_element(inside.begin(), inside.end()) <= radius_m) {
    return true;
  }
  // Inside the image, pixel by pixel.
  const WorldBox around{p - Eigen::Vector3d::Constant(radius_m), p + Eigen::Vector3d::Constant(radius_m)};
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[static_cast<std::size_t>(i)] = around.corner(i);
  }
  const std::optional<PixelWindow> window = window_of(corners);
  if (!window) {
    return true;
  }
  const PixelWindow in_image{std::max(window->u_first, 0), std::max(window->v_first, 0),
                             std::min(window->u_last, camera_.width_px - 1),
                             std::min(window->v_last, camera_.height_px - 1)};
  return any_pixel(in_image, p.z() - radius_m, p.z() + radius_m, p, radius_m, [&](int u, int v) {
    const Depths depths = not_free_depths(u, v);
    return std::any_of(depths.begin(), depths.end(), [&](const std::array<double, 2>& d) {
      const bool may_meet = d[0] < d[1] && d[0] <= p.z() + radius_m && d[1] >= p.z() - radius_m;
      return may_meet && piece(u, v, d[0], d[1]).meets_ball(p, radius_m);
    });
  });
}

bool CameraSpace::blocks(const Eigen::Vector3d& p_world) const {
  return not_free(p_world) || (has_pose_error() && ball_meets_not_free(p_world, pose_error_m(p_world)));
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
  const auto [left, right, top, bottom] = border_slopes_;
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
  const auto [left, right, top, bottom] = border_slopes_;
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
  return to_world(nearest);
}

}  // namespace depthgrid::reference
