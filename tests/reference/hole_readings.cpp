#include "reference/hole_readings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace depthgrid::reference {
namespace {

constexpr double kHalfDiagonal = 0.70711;

/// A shape of pixels relative to a place.
struct Step {
  double radius_px;
  double around_px;
  std::vector<std::vector<std::array<int, 2>>> shapes;  ///< each of them will do
};

bool sum_of_squares(int k) {
  for (int a = 0; a * a <= k; ++a) {
    for (int b = 0; a * a + b * b <= k; ++b) {
      if (a * a + b * b == k) {
        return true;
      }
    }
  }
  return false;
}

std::vector<std::array<int, 2>> disc(int square) {
  std::vector<std::array<int, 2>> pixels;
  for (int v = -square; v <= square; ++v) {
    for (int u = -square; u <= square; ++u) {
      if (u * u + v * v <= square) {
        pixels.push_back({u, v});
      }
    }
  }
  return pixels;
}

std::vector<Step> steps_up_to(double widest_px) {
  std::vector<Step> steps;
  // A place of the disc is at most radius + half a diagonal from p, and what is missing at most that far from it.
  const auto add = [&](double radius_px, double off_px, std::vector<std::vector<std::array<int, 2>>> shapes) {
    steps.push_back({radius_px, radius_px + kHalfDiagonal + off_px, std::move(shapes)});
  };
  add(kHalfDiagonal, kHalfDiagonal, {disc(0)});
  add(1.0, 1.0, {{{0, 0}, {1, 0}}, {{0, 0}, {0, 1}}});
  add(1.11804, 1.2,
      {{{0, 0}, {1, 0}, {0, 1}}, {{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {0, 1}, {1, 1}}, {{1, 0}, {0, 1}, {1, 1}}});
  for (int k = 1;; k = static_cast<int>(std::ceil(1.25 * k))) {
    while (!sum_of_squares(k)) {
      ++k;
    }
    const double radius_px = std::sqrt(k) + kHalfDiagonal;
    add(radius_px, kHalfDiagonal, {disc(k)});
    if (2 * radius_px >= widest_px || radius_px > 52) {
      return steps;
    }
  }
}

struct Image {
  const std::vector<float>& readings_m;
  int width_px;
  int height_px;

  [[nodiscard]] bool inside(int u, int v) const { return u >= 0 && v >= 0 && u < width_px && v < height_px; }
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(u);
  }
  [[nodiscard]] double at(int u, int v) const { return readings_m[index(u, v)]; }
  [[nodiscard]] bool missing(int u, int v) const { return inside(u, v) && at(u, v) == 0; }

  [[nodiscard]] bool stands(const Step& step, int u, int v) const {
    return std::any_of(step.shapes.begin(), step.shapes.end(), [&](const auto& shape) {
      return std::all_of(shape.begin(), shape.end(), [&](const auto& d) { return missing(u + d[0], v + d[1]); });
    });
  }

  [[nodiscard]] bool belongs(const Step& step, int u, int v) const {
    const int reach = static_cast<int>(step.around_px);
    for (int dv = -reach; dv <= reach; ++dv) {
      for (int du = -reach; du <= reach; ++du) {
        if (du * du + dv * dv <= step.around_px * step.around_px && inside(u + du, v + dv) &&
            stands(step, u + du, v + dv)) {
          return true;
        }
      }
    }
    return false;
  }

  /// 0 where the window leaves the image.
  [[nodiscard]] double least_m(int u, int v, int window_px) const {
    if (!inside(u - window_px, v - window_px) || !inside(u + window_px, v + window_px)) {
      return 0;
    }
    int step = 1;
    while (2 * window_px > 7 * step) {
      step *= 2;
    }
    const auto first = [&](int pixel) { return (pixel - window_px) / step * step; };
    const auto end = [&](int pixel) { return ((pixel + window_px) / step + 1) * step; };
    double least = std::numeric_limits<double>::infinity();
    for (int y = first(v); y < std::min(end(v), height_px); ++y) {
      for (int x = first(u); x < std::min(end(u), width_px); ++x) {
        least = missing(x, y) ? least : std::min(least, at(x, y));
      }
    }
    return least;
  }
};

/// The depth that a reading in single precision stands for: its units, or a step of a float image.
double exact_m(double reading_m, const DepthView& format) {
  if (!std::isfinite(reading_m)) {
    return reading_m;
  }
  if (format.format == DepthFormat::float32_metres) {
    return std::floor(reading_m * 4096) / 4096;
  }
  const double units_m = std::round(reading_m / format.metres_per_unit) * format.metres_per_unit;
  return std::abs(units_m - reading_m) <= 1e-6 * reading_m ? units_m : reading_m;  // else it is the far limit
}

/// The last value that the rule takes for a reading and that is not above this depth; 0: none.
float reading_below(double depth_m, const MeasurementRule& rule, const DepthView& format) {
  const double limited_m = std::min(depth_m, rule.far_m);
  if (format.format == DepthFormat::float32_metres) {
    const auto near = static_cast<float>(limited_m);
    const float value = near > limited_m ? std::nextafter(near, 0.0F) : near;
    return value > 0 && value >= static_cast<float>(rule.near_m) ? value : 0.0F;
  }
  const double units = std::min(65534.0, std::floor(limited_m * (1 - 1e-12) / format.metres_per_unit));
  for (int unit = static_cast<int>(units); unit > 0; --unit) {
    const auto value = static_cast<float>(unit * format.metres_per_unit);
    if (value < static_cast<float>(rule.near_m)) {
      return 0;
    }
    if (std::find(rule.invalid_units.begin(), rule.invalid_units.end(), unit) == rule.invalid_units.end()) {
      return value;
    }
  }
  return 0;
}

}  // namespace

std::vector<float> with_holes_filled(const std::vector<float>& readings_m, const PinholeCamera& camera,
                                     const MeasurementRule& rule, const SensorMargin& margin, const DepthView& format,
                                     double smallest_obstacle_m) {
  const Image image{readings_m, camera.width_px, camera.height_px};
  const double s = smallest_obstacle_m;
  // The least radius of curvature of a ball's image, over the ball's radius and depth: in the farthest corner.
  double tangent = 0;
  for (const double u : {0.0, static_cast<double>(camera.width_px)}) {
    for (const double v : {0.0, static_cast<double>(camera.height_px)}) {
      tangent = std::max(tangent, std::hypot((u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px));
    }
  }
  const double unlike = std::max(camera.fx_px, camera.fy_px) / std::min(camera.fx_px, camera.fy_px);
  const double focal_px = std::min(camera.fx_px, camera.fy_px) / unlike * std::cos(std::atan(tangent));
  const std::vector<Step> steps = steps_up_to(s * focal_px / (std::max(rule.near_m, 0.25) + s / 2));
  std::vector<float> filled = readings_m;
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) {
      if (!image.missing(u, v)) {
        continue;
      }
      std::size_t n = steps.size() - 1;
      while (n > 0 && !image.belongs(steps[n], u, v)) {
        --n;
      }
      if (n + 1 == steps.size()) {
        continue;
      }
      const double W = 2 * steps[n + 1].radius_px;
      const double least_m = exact_m(image.least_m(u, v, static_cast<int>(std::floor(W + kHalfDiagonal))), format);
      const double bound_m = std::min(s * focal_px / (W + 2 * margin.lateral_px), least_m);
      const double growth = margin.linear + 2 * margin.quadratic_per_m * bound_m;
      if (growth < 1) {
        filled[image.index(u, v)] = reading_below(bound_m - s / 2 / (1 - growth), rule, format);
      }
    }
  }
  return filled;
}

}  // namespace depthgrid::reference
