#include "depthgrid/core/distortion.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/interval.hpp"

namespace depthgrid {
namespace {

/// A source pixel that a mapped square enters by less than this does not count as touched. Far above the rounding of
/// the map (1e-11 px) and far below anything that matters (0.04 um at 2 m and 525 px), it keeps the identity, and
/// scalings by whole factors, from dragging in the next pixel.
constexpr double kSliver_px = 1e-6;

/// Steps in which the radial function is checked for a fold.
constexpr int kFoldSteps = 4096;

/// The factor on the radius and its derivatives with respect to s = r^2. T is double or Interval.
template <class T>
struct Radial {
  T factor, derivative, second_derivative, denominator;
};

template <class T>
Radial<T> radial(const Distortion& distortion, const T& s) noexcept {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = distortion.coefficients;
  const T numerator = T(1.0) + s * (T(k1) + s * (T(k2) + s * T(k3)));
  const T numerator_1 = T(k1) + s * (T(2.0 * k2) + s * T(3.0 * k3));
  const T numerator_2 = T(2.0 * k2) + s * T(6.0 * k3);
  const T denominator = T(1.0) + s * (T(k4) + s * (T(k5) + s * T(k6)));
  const T denominator_1 = T(k4) + s * (T(2.0 * k5) + s * T(3.0 * k6));
  const T denominator_2 = T(2.0 * k5) + s * T(6.0 * k6);
  const T factor = numerator / denominator;
  const T derivative = (numerator_1 - factor * denominator_1) / denominator;
  const T second = (numerator_2 - T(2.0) * derivative * denominator_1 - factor * denominator_2) / denominator;
  return {factor, derivative, second, denominator};
}

/// Encloses the radial function over s. The mean value form (value in the middle plus derivative times half the width)
/// stays tight where large coefficients nearly cancel, which plain interval arithmetic does not.
Radial<Interval> radial_over(const Distortion& distortion, const Interval& s) noexcept {
  const Radial<double> middle = radial(distortion, 0.5 * (s.low + s.high));
  Radial<Interval> all = radial(distortion, s);
  const Interval offset(-0.5 * (s.high - s.low), 0.5 * (s.high - s.low));
  all.derivative = Interval(middle.derivative) + all.second_derivative * offset;
  all.factor = Interval(middle.factor) + all.derivative * offset;
  return all;
}

/// Partial derivatives of the distorted coordinates over a box of undistorted ones.
struct Jacobian {
  Interval xx, xy, yx, yy;
};

Jacobian jacobian(const Distortion& distortion, const Interval& x, const Interval& y,
                  const Radial<Interval>& r) noexcept {
  const Interval p1 = distortion.coefficients[2];
  const Interval p2 = distortion.coefficients[3];
  const Interval two = 2.0;
  const Interval six = 6.0;
  const Interval mixed = two * (x * y * r.derivative + p1 * x + p2 * y);
  return {r.factor + two * (square(x) * r.derivative + p1 * y) + six * p2 * x, mixed, mixed,
          r.factor + two * (square(y) * r.derivative + p2 * x) + six * p1 * y};
}

/// The squared radius up to which the radial function r R(r^2) surely grows, at most s_largest. Beyond a fold the model
/// maps points that the lens never images back into the picture.
double unfolded_squared_radius(const Distortion& distortion, double s_largest) noexcept {
  for (int step = 0; step < kFoldSteps; ++step) {
    const Interval s(s_largest * step / kFoldSteps, s_largest * (step + 1) / kFoldSteps);
    const Radial<Interval> r = radial_over(distortion, s);
    if (!((r.factor + Interval(2.0) * s * r.derivative).low > 0.0)) {
      return s.low;
    }
  }
  return s_largest;
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

}  // namespace

bool distorts(const Distortion& distortion) noexcept {
  const auto& c = distortion.coefficients;
  return distortion.model != Distortion::Model::none &&
         std::any_of(c.begin(), c.end(), [](double coefficient) { return coefficient != 0; });
}

Distortion make_distortion(Distortion::Model model, std::span<const double> coefficients) {
  constexpr std::array<const char*, 3> kNames{"none", "plumb_bob", "rational"};
  const char* name = kNames[static_cast<std::size_t>(model)];
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
           ", must be 0; is the model plumb_bob or rational?");
    }
    distortion.coefficients[i] = coefficients[i];
  }
  if (model == Distortion::Model::plumb_bob && coefficients.size() != 4 && coefficients.size() != 5) {
    fail("distortion plumb_bob: ", coefficients.size(), " coefficients given, must be 4 or 5 (k1 k2 p1 p2 k3)");
  }
  if (model == Distortion::Model::rational && coefficients.size() != 8) {
    fail("distortion rational: ", coefficients.size(), " coefficients given, must be 8 (k1 k2 p1 p2 k3 k4 k5 k6)");
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
  const double p1 = distortion.coefficients[2];
  const double p2 = distortion.coefficients[3];
  const double s = x * x + y * y;
  const double factor = radial(distortion, s).factor;
  return {x * factor + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x),
          y * factor + p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y};
}

DepthUndistortion::DepthUndistortion(const PinholeCamera& distorted, const Distortion& lens,
                                     const PinholeCamera& undistorted)
    : source_width_px_(distorted.width_px),
      source_height_px_(distorted.height_px),
      width_px_(undistorted.width_px),
      height_px_(undistorted.height_px) {
  validate(distorted, "distorted camera");
  validate(undistorted, "undistorted camera");
  const Distortion distortion = lens.model == Distortion::Model::none ? Distortion{} : lens;
  const Interval x_all{pixel_interval(0, undistorted.fx_px, undistorted.cx_px).low,
                       pixel_interval(width_px_ - 1, undistorted.fx_px, undistorted.cx_px).high};
  const Interval y_all{pixel_interval(0, undistorted.fy_px, undistorted.cy_px).low,
                       pixel_interval(height_px_ - 1, undistorted.fy_px, undistorted.cy_px).high};
  const double s_unfolded = unfolded_squared_radius(distortion, (square(x_all) + square(y_all)).high);

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
      const Range columns = touched(x_px, source_width_px_);
      const Range rows = touched(y_px, source_height_px_);
      const bool imaged = s.high <= s_unfolded && determinant.low > 0.0 && columns.last >= 0 && rows.last >= 0;
      windows_.push_back(
          imaged ? SourceWindow{static_cast<std::int16_t>(columns.first), static_cast<std::int16_t>(rows.first),
                                static_cast<std::int16_t>(columns.last), static_cast<std::int16_t>(rows.last)}
                 : SourceWindow{0, 0, -1, -1});
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

}  // namespace depthgrid
