#include "depthgrid/search/classification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depthgrid/search/search.hpp"
#include "depthgrid/views/prepared_image.hpp"

namespace depthgrid::search {
namespace {

/// Pixels that a wide look reads at most; the first of them say something already.
constexpr int kMaxPixels = 4096;

/// What one camera says of a point.
struct Look {
  bool measured = false;
  bool occluded = false;
  Unmeasured unmeasured = Unmeasured::not_told;

  void says_nothing(Unmeasured why) noexcept { unmeasured = first_of(unmeasured, why); }
  [[nodiscard]] bool anything() const noexcept { return measured || occluded || unmeasured != Unmeasured::not_told; }
};

/// Pixels, inclusive.
struct PixelWindow {
  int u0, v0, u1, v1;

  [[nodiscard]] PixelWindow grown(int by_px) const noexcept { return {u0 - by_px, v0 - by_px, u1 + by_px, v1 + by_px}; }
  [[nodiscard]] PixelWindow clipped_to(const PixelWindow& other) const noexcept {
    return {std::max(u0, other.u0), std::max(v0, other.v0), std::min(u1, other.u1), std::min(v1, other.v1)};
  }
};

/// One camera, and a point in its frame that it looks at.
struct Sight {
  const views::View& view;
  const views::PreparedImage& image;
  const SensorMargin& margin;
  const PinholeCamera& pinhole;
  Eigen::Vector3d p;
  double slack_m;  ///< resolution and pose error

  [[nodiscard]] PixelWindow whole() const noexcept { return {0, 0, pinhole.width_px - 1, pinhole.height_px - 1}; }

  /// What the readings in these pixels say, added to what is known. The window may leave the image.
  void read(const PixelWindow& pixels, Look& known) const noexcept {
    const PixelWindow inside = pixels.clipped_to(whole());
    if (inside.u0 > pixels.u0 || inside.v0 > pixels.v0 || inside.u1 < pixels.u1 || inside.v1 < pixels.v1) {
      known.says_nothing(Unmeasured::image_edge);
    }
    for (int v = inside.v0; v <= inside.v1; ++v) {
      for (int u = inside.u0; u <= inside.u1; ++u) {
        const auto depth_m = static_cast<double>(view.measured_m(u, v));
        if (!(depth_m > 0)) {
          known.says_nothing(Unmeasured::no_reading);
        } else if (std::abs(p.z() - depth_m) <= depth_margin_m(margin, depth_m) + slack_m) {
          known.measured = true;
        } else if (p.z() > depth_m) {
          known.occluded = true;
        }
      }
    }
  }

  /// The same for those pixels of a block of 4 * 2^level a side that do not free what is within slack of the
  /// point; the pyramid says which blocks have none. Stops at a measured one, which nothing outranks.
  void read_block(std::size_t level, int i, int j, const PixelWindow& window, int& pixels_left,
                  Look& known) const noexcept {
    const views::PyramidLevel& texels = image.levels[level];
    const auto texel =
        static_cast<std::size_t>(4 * j) * static_cast<std::size_t>(texels.width) + static_cast<std::size_t>(4 * i);
    if (known.measured || pixels_left <= 0 ||
        static_cast<double>(image.minima_m[texels.offset + texel]) > p.z() + slack_m) {
      return;
    }
    if (level == 0) {
      const PixelWindow block{4 * i, 4 * j, 4 * i + 3, 4 * j + 3};
      const PixelWindow reached = block.clipped_to(window).grown(margin.lateral_px);
      pixels_left -= (reached.u1 - reached.u0 + 1) * (reached.v1 - reached.v0 + 1);
      read(reached, known);
      return;
    }
    read_blocks(
        level - 1,
        window.clipped_to({(4 * i) << level, (4 * j) << level, ((4 * i + 4) << level) - 1, ((4 * j + 4) << level) - 1}),
        pixels_left, known);
  }

  void read_blocks(std::size_t level, const PixelWindow& window, int& pixels_left, Look& known) const noexcept {
    for (int j = window.v0 >> (level + 2); j <= window.v1 >> (level + 2); ++j) {
      for (int i = window.u0 >> (level + 2); i <= window.u1 >> (level + 2); ++i) {
        read_block(level, i, j, window, pixels_left, known);
      }
    }
  }
};

/// All pixels that a ball before the camera's plane projects to, or more; may leave the image.
PixelWindow pixel_window(const PinholeCamera& c, const Eigen::Vector3d& p, double radius_m) noexcept {
  const auto bound = [&](double x, double away_m, double f_px, double c_px) {
    const double end = x + away_m;
    const double px = c_px + f_px * end / (p.z() + (end * away_m > 0 ? -radius_m : radius_m));
    return static_cast<int>(std::floor(std::clamp(px, -1e6, 1e6)));
  };
  return {bound(p.x(), -radius_m, c.fx_px, c.cx_px), bound(p.y(), -radius_m, c.fy_px, c.cy_px),
          bound(p.x(), radius_m, c.fx_px, c.cx_px), bound(p.y(), radius_m, c.fy_px, c.cy_px)};
}

/// What keeps the camera from freeing the point though nothing in its own pixels does: something beside it.
Look look_around(const Sight& sight, double near_m) noexcept {
  Look result;
  if (sight.p.z() - sight.slack_m <= near_m) {
    result.says_nothing(Unmeasured::blind_zone);
    return result;
  }
  const PixelWindow window = pixel_window(sight.pinhole, sight.p, sight.slack_m);
  const PixelWindow inside = window.clipped_to(sight.whole());
  if (inside.u0 > window.u0 || inside.v0 > window.v0 || inside.u1 < window.u1 || inside.v1 < window.v1) {
    result.says_nothing(Unmeasured::image_edge);
  }
  std::size_t level = 0;
  while (level + 1 < sight.image.levels.size() &&
         std::max(inside.u1 - inside.u0, inside.v1 - inside.v0) >= 16 << level) {
    ++level;
  }
  int pixels_left = kMaxPixels;
  sight.read_blocks(level, inside, pixels_left, result);
  return result;
}

}  // namespace

Classification classify(const views::Snapshot& snapshot, const Eigen::Vector3d& x_world) noexcept {
  Classification result;
  double nearest_camera_m = std::numeric_limits<double>::infinity();
  bool occluded = false;
  Unmeasured unmeasured = Unmeasured::not_told;
  bool looks = false;
  for (std::size_t k = 0; k < snapshot.camera_count(); ++k) {
    const views::View& view = snapshot.view(k);
    const RigCamera& camera = snapshot.camera(k);
    const Pose& T_world_camera = snapshot.T_world_camera(k);
    const Eigen::Vector3d x = T_world_camera.linear().transpose() * (x_world - T_world_camera.translation());
    if (!(x.z() > 0)) {
      continue;
    }
    const DepthPoint p = project(camera.intrinsics, x);
    if (!(p.x_px >= 0 && p.y_px >= 0 && p.x_px < camera.intrinsics.width_px && p.y_px < camera.intrinsics.height_px)) {
      continue;
    }
    // What a late image shows is not known to be there any more.
    if (p.depth_m <= camera.rule.near_m || snapshot.late(k)) {
      unmeasured = first_of(unmeasured, snapshot.late(k) ? Unmeasured::late_image : Unmeasured::blind_zone);
      continue;
    }
    const PoseMargin& e = snapshot.pose_margin(k);
    const double range_m = x.norm();
    const double slack_m =
        snapshot.settings().resolution_m + e.translation_m + e.time_m + e.rotation_rad * range_m + kRounding;
    const Sight sight{view,   views::prepared(view), snapshot.settings().margins[k].sensor, camera.intrinsics, x,
                      slack_m};
    const auto u = static_cast<int>(p.x_px);
    const auto v = static_cast<int>(p.y_px);
    Look seen;
    sight.read(PixelWindow{u, v, u, v}.grown(sight.margin.lateral_px), seen);
    if (!seen.anything()) {
      seen = look_around(sight, camera.rule.near_m);
    }
    looks = true;
    if (seen.measured && range_m < nearest_camera_m) {
      nearest_camera_m = range_m;
      result.camera = static_cast<std::uint16_t>(k);
    }
    occluded = occluded || seen.occluded;
    unmeasured = first_of(unmeasured, seen.unmeasured);
  }
  if (result.camera) {
    result.state = ProximityState::measured;
  } else if (occluded || (looks && unmeasured == Unmeasured::not_told)) {
    result.state = ProximityState::occluded;  // where a camera looks and says nothing, none has seen it free either
  } else if (unmeasured != Unmeasured::not_told) {
    result.state = ProximityState::unmeasured;
    result.unmeasured = unmeasured;
  }
  return result;
}

}  // namespace depthgrid::search
