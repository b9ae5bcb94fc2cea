#include "depthgrid/core/distortion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/interval.hpp"
#include "depthgrid/core/radial_distortion.hpp"

namespace depthgrid {
namespace {

/// A source pixel that a mapped square enters by less than this does not count as touched. Far above the rounding of
/// the map (1e-11 px) and far below anything that matters (0.04 um at 2 m and 525 px), it keeps the identity, and
/// scalings by whole factors, from dragging in the next pixel.
constexpr double kSliver_px = 1e-6;

/// Partial derivatives of the distorted coordinates over a box of undistorted ones.
struct Jacobian {
  Interval xx, xy, yx, yy;
};

Jacobian jacobian(const Distortion& distortion, const Interval& x, const Interval& y,
                  const Radial<Interval>& r) noexcept {
  const Interval p1 = tangential(distortion).p1;
  const Interval p2 = tangential(distortion).p2;
  const Interval two = 2.0;
  const Interval six = 6.0;
  const Interval mixed = two * (x * y * r.derivative + p1 * x + p2 * y);
  return {r.factor + two * (square(x) * r.derivative + p1 * y) + six * p2 * x, mixed, mixed,
          r.factor + two * (square(y) * r.derivative + p2 * x) + six * p1 * y};
}

/// Whether a step of one pixel of the result is clearly less than one of the source, in some direction. The matrix of
/// the derivatives is symmetric, so its smaller eigenvalue is the least that a step becomes.
bool stretched(const Jacobian& j, double source_per_result) noexcept {
  constexpr double kClearly = 0.95;
  const double mixed = std::max(std::abs(j.xy.low), std::abs(j.xy.high));
  return (std::min(j.xx.low, j.yy.low) - mixed) * source_per_result < kClearly;
}

/// Whether the image would hold some of these rays without a lens.
bool seen_without_lens(const PinholeCamera& camera, const Interval& x, const Interval& y) noexcept {
  const auto overlaps = [](const Interval& ray, double focal_px, double centre_px, int side_px) {
    return ray.high * focal_px + centre_px > 0.0 && ray.low * focal_px + centre_px < side_px;
  };
  return overlaps(x, camera.fx_px, camera.cx_px, camera.width_px) &&
         overlaps(y, camera.fy_px, camera.cy_px, camera.height_px);
}

/// Undistorted coordinates of one row or column of pixels of the result.
Interval pixel_interval(int index, double focal_px, double centre_px) noexcept {
  return {(index - centre_px) / focal_px, (index + 1.0 - centre_px) / focal_px};
}

/// Mean value form: the value at the box's centre plus derivative times half the box's size. Encloses the image of the
/// whole box, border and inside; too large only by the second derivative times the box's area.
Interval enclose(double centre, const Interval& dx, double half_x, const Interval& dy, double half_y) noexcept {
  return Interval(centre) + dx * Interval(-half_x, half_x) + dy * Interval(-half_y, half_y);
}

struct Range {
  int first, last;
};

/// The source pixels that an interval of continuous coordinates touches; last < first when it leaves the image.
Range touched(const Interval& px, int side_px) noexcept {
  const double first = std::floor(px.low + kSliver_px);
  const double last = std::max(first, std::ceil(px.high - kSliver_px) - 1.0);
  if (!(first >= 0.0 && last < side_px)) {
    return {0, -1};
  }
  return {static_cast<int>(first), static_cast<int>(last)};
}

/// With as many pixels more on both sides; last < first when it leaves the image.
Range widened(const Range& range, int by, int side_px) noexcept {
  const bool inside = range.last >= 0 && range.first >= by && range.last + by < side_px;
  return inside ? Range{range.first - by, range.last + by} : Range{0, -1};
}

}  // namespace

bool distorts(const Distortion& distortion) noexcept {
  const auto& c = distortion.coefficients;
  if (distortion.model == Distortion::Model::equidistant) {
    return true;  // whatever the coefficients: such a lens is no pinhole
  }
  return distortion.model != Distortion::Model::none &&
         std::any_of(c.begin(), c.end(), [](double coefficient) { return coefficient != 0; });
}

std::string_view to_string(Distortion::Model model) noexcept {
  switch (model) {
    case Distortion::Model::none:
      return "none";
    case Distortion::Model::plumb_bob:
      return "plumb_bob";
    case Distortion::Model::rational:
      return "rational";
    case Distortion::Model::equidistant:
      break;
  }
  return "equidistant";
}

std::optional<Distortion::Model> distortion_model(std::string_view name) noexcept {
  struct Named {
    std::string_view name;
    Distortion::Model model;
  };
  static constexpr std::array<Named, 11> kNames{{{"none", Distortion::Model::none},
                                                 {"plumb_bob", Distortion::Model::plumb_bob},
                                                 {"brown_conrady", Distortion::Model::plumb_bob},
                                                 {"radtan", Distortion::Model::plumb_bob},
                                                 {"radial-tangential", Distortion::Model::plumb_bob},
                                                 {"rational", Distortion::Model::rational},
                                                 {"rational_polynomial", Distortion::Model::rational},
                                                 {"equidistant", Distortion::Model::equidistant},
                                                 {"equi", Distortion::Model::equidistant},
                                                 {"fisheye", Distortion::Model::equidistant},
                                                 {"kannala_brandt4", Distortion::Model::equidistant}}};
  const auto* found = std::find_if(kNames.begin(), kNames.end(), [&](const Named& one) { return one.name == name; });
  return found != kNames.end() ? std::optional(found->model) : std::nullopt;
}

Distortion make_distortion(Distortion::Model model, std::span<const double> coefficients) {
  const std::string_view name = to_string(model);
  Distortion distortion;
  if (coefficients.size() > distortion.coefficients.size()) {
    fail("distortion ", name, ": ", coefficients.size(),
         " coefficients given, at most 8 are known (k1 k2 p1 p2 k3 k4 k5 k6)");
  }
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (!std::isfinite(coefficients[i])) {
      fail("distortion ", name, ": coefficient ", i, " is ", coefficients[i], ", must be a finite number");
    }
    if (model == Distortion::Model::none && coefficients[i] != 0.0) {
      fail("distortion none: coefficient ", i, " is ", coefficients[i],
           ", must be 0; is the model plumb_bob, rational or equidistant?");
    }
    distortion.coefficients[i] = coefficients[i];
  }
  if (model == Distortion::Model::plumb_bob && coefficients.size() != 4 && coefficients.size() != 5) {
    fail("distortion plumb_bob: ", coefficients.size(), " coefficients given, must be 4 or 5 (k1 k2 p1 p2 k3)");
  }
  if (model == Distortion::Model::rational && coefficients.size() != 8) {
    fail("distortion rational: ", coefficients.size(), " coefficients given, must be 8 (k1 k2 p1 p2 k3 k4 k5 k6)");
  }
  if (model == Distortion::Model::equidistant && coefficients.size() != 4) {
    fail("distortion equidistant: ", coefficients.size(), " coefficients given, must be 4 (k1 k2 k3 k4)");
  }
  distortion.model = model;
  return distortion;
}

Eigen::Vector2d distort(const Distortion& distortion, const Eigen::Vector2d& normalised) noexcept {
  if (distortion.model == Distortion::Model::none) {
    return normalised;
  }
  const double x = normalised.x();
  const double y = normalised.y();
  const auto [p1, p2] = tangential(distortion);
  const double s = x * x + y * y;
  const double factor = radial(distortion, s).factor;
  return {x * factor + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x),
          y * factor + p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y};
}

void refuse_fold(const PinholeCamera& camera, const Distortion& lens) {
  if (lens.model != Distortion::Model::equidistant) {
    return;
  }
  const auto farther = [](double centre_px, int side_px) { return std::max(centre_px, side_px - centre_px); };
  const double corner = std::hypot(farther(camera.cx_px, camera.width_px) / camera.fx_px,
                                   farther(camera.cy_px, camera.height_px) / camera.fy_px);
  const auto& k = lens.coefficients;
  constexpr int kSteps = 9000;  // hundredths of a degree, up to a right angle
  constexpr double kStep_rad = 0.5 * std::numbers::pi / kSteps;
  double before = 0.0;
  for (int step = 1; step <= kSteps; ++step) {
    const double theta = step * kStep_rad;
    const double u = theta * theta;
    const double image = theta * (1.0 + u * (k[0] + u * (k[1] + u * (k[2] + u * k[3]))));
    if (!(image > before)) {
      fail("distortion equidistant: the coefficients fold back ", 0.01 * step, " degrees off the axis, ",
           std::lround(before * camera.fx_px),
           " px from the principal point and inside the image, whose farthest corner is ",
           std::lround(corner * camera.fx_px),
           " px away; are they of another model (plumb_bob, rational), in another order, or for another image size?");
    }
    before = image;
    if (image > corner) {
      return;
    }
  }
}

DepthUndistortion::DepthUndistortion(const PinholeCamera& distorted, const Distortion& lens,
                                     const PinholeCamera& undistorted, int lateral_px)
    : source_width_px_(distorted.width_px),
      source_height_px_(distorted.height_px),
      width_px_(undistorted.width_px),
      height_px_(undistorted.height_px) {
  validate(distorted, "distorted camera");
  validate(undistorted, "undistorted camera");
  refuse_fold(distorted, lens);
  constexpr SourceWindow kOutside{0, 0, -1, -1};
  const Distortion distortion = lens.model == Distortion::Model::none ? Distortion{} : lens;
  const Interval x_all{pixel_interval(0, undistorted.fx_px, undistorted.cx_px).low,
                       pixel_interval(width_px_ - 1, undistorted.fx_px, undistorted.cx_px).high};
  const Interval y_all{pixel_interval(0, undistorted.fy_px, undistorted.cy_px).low,
                       pixel_interval(height_px_ - 1, undistorted.fy_px, undistorted.cy_px).high};
  const double s_unfolded = unfolded_squared_radius(distortion, (square(x_all) + square(y_all)).high);

  const double source_per_result = std::min(distorted.fx_px / undistorted.fx_px, distorted.fy_px / undistorted.fy_px);

  windows_.reserve(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_));
  for (int v = 0; v < height_px_; ++v) {
    const Interval y = pixel_interval(v, undistorted.fy_px, undistorted.cy_px);
    for (int u = 0; u < width_px_; ++u) {
      const Interval x = pixel_interval(u, undistorted.fx_px, undistorted.cx_px);
      const Interval s = square(x) + square(y);
      const Radial<Interval> r = radial_over(distortion, s);
      const Jacobian j = jacobian(distortion, x, y, r);
      const Interval determinant = j.xx * j.yy - j.xy * j.yx;
      if (r.denominator.contains(0.0) || !std::isfinite(determinant.low) || !std::isfinite(determinant.high)) {
        if (!seen_without_lens(distorted, x, y)) {  // the pole of a rational model, far outside what the lens images
          windows_.push_back(kOutside);
          continue;
        }
        fail("distortion: the model is not finite at pixel (", u, ", ", v, ") of the undistorted image (x/z = ", x.low,
             ", y/z = ", y.low, "); check the order of the coefficients or choose a narrower undistorted image");
      }
      const Eigen::Vector2d centre = distort(distortion, {0.5 * (x.low + x.high), 0.5 * (y.low + y.high)});
      const double half_x = 0.5 * (x.high - x.low);
      const double half_y = 0.5 * (y.high - y.low);
      const Interval x_px =
          Interval(distorted.fx_px) * enclose(centre.x(), j.xx, half_x, j.xy, half_y) + distorted.cx_px;
      const Interval y_px =
          Interval(distorted.fy_px) * enclose(centre.y(), j.yx, half_x, j.yy, half_y) + distorted.cy_px;
      const int beside_px = stretched(j, source_per_result) ? lateral_px : 0;
      const Range columns = widened(touched(x_px, source_width_px_), beside_px, source_width_px_);
      const Range rows = widened(touched(y_px, source_height_px_), beside_px, source_height_px_);
      const bool imaged = s.high <= s_unfolded && determinant.low > 0.0 && columns.last >= 0 && rows.last >= 0;
      windows_.push_back(
          imaged ? SourceWindow{static_cast<std::int16_t>(columns.first), static_cast<std::int16_t>(rows.first),
                                static_cast<std::int16_t>(columns.last), static_cast<std::int16_t>(rows.last)}
                 : kOutside);
    }
  }
}

void DepthUndistortion::apply(const DepthImage& source, DepthImage& result) const noexcept {
  const std::size_t pixels = result.index(0, result.height_px());
  if (source.width_px() != source_width_px_ || source.height_px() != source_height_px_ ||
      result.width_px() != width_px_ || result.height_px() != height_px_) {
    std::fill_n(result.data(), pixels, 0.0F);
    return;
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    const SourceWindow& window = windows_[i];
    // "No measurement" is 0, the smallest depth there is, so the minimum keeps it.
    float depth_m = window.u_last < window.u_first ? 0.0F : source.at(window.u_first, window.v_first);
    for (int v = window.v_first; v <= window.v_last; ++v) {
      for (int u = window.u_first; u <= window.u_last; ++u) {
        depth_m = std::min(depth_m, source.at(u, v));
      }
    }
    result.data()[i] = depth_m;
  }
}

std::vector<bool> DepthUndistortion::pixels_read() const {
  std::vector<bool> read(static_cast<std::size_t>(source_width_px_) * static_cast<std::size_t>(source_height_px_));
  for (const SourceWindow& window : windows_) {
    for (int v = window.v_first; v <= window.v_last; ++v) {
      for (int u = window.u_first; u <= window.u_last; ++u) {
        read[static_cast<std::size_t>(v) * static_cast<std::size_t>(source_width_px_) + static_cast<std::size_t>(u)] =
            true;
      }
    }
  }
  return read;
}

}  // namespace depthgrid
