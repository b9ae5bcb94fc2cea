#include "report/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "depthgrid/core/error.hpp"

namespace depthgrid::report {

namespace {

constexpr double kTextSize = 13;
constexpr Colour kGrid{0.85, 0.85, 0.87};

/// One axis: values to canvas pixels.
struct Axis {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();
  bool logarithmic = false;
  double begin_px = 0;
  double end_px = 0;

  [[nodiscard]] bool shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0); }
  void include(double value) {
    if (shows(value)) {
      lower = std::min(lower, value);
      upper = std::max(upper, value);
    }
  }
  /// Gives an empty or single-valued axis some extent.
  void settle() {
    if (!(lower <= upper)) {
      lower = logarithmic ? 1 : 0;
      upper = logarithmic ? 10 : 1;
    } else if (lower == upper) {
      const double room = lower == 0 ? 1 : 0.5 * std::abs(lower);
      lower = logarithmic ? lower / 2 : lower - room;
      upper = logarithmic ? upper * 2 : upper + room;
    } else if (!logarithmic && lower > 0 && lower < 0.5 * upper) {
      lower = 0;
    }
  }
  [[nodiscard]] double scale(double value) const { return logarithmic ? std::log10(value) : value; }
  [[nodiscard]] double pixel(double value) const {
    if (!shows(value)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return begin_px + (scale(value) - scale(lower)) / (scale(upper) - scale(lower)) * (end_px - begin_px);
  }
};

std::string number(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

void draw_legend(Canvas& canvas, const Rectangle& frame, const std::vector<Series>& series) {
  double width_px = 0;
  for (const Series& s : series) {
    width_px = std::max(width_px, canvas.text_width_px(s.label, kTextSize));
  }
  if (width_px == 0) {
    return;
  }
  const double line_px = 1.5 * kTextSize;
  const Rectangle box{frame.x_px + frame.width_px + 14, frame.y_px, width_px + 40,
                      line_px * static_cast<double>(series.size())};
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double y_px = box.y_px + (static_cast<double>(i) + 0.5) * line_px;
    const Colour colour = series_colour(static_cast<unsigned>(i));
    if (series[i].joined) {
      canvas.line({box.x_px, y_px}, {box.x_px + 24, y_px}, {colour, 2});
    }
    if (series[i].markers) {
      canvas.disc({box.x_px + 12, y_px}, 3.5, colour);
    }
    canvas.text({box.x_px + 32, y_px + 0.35 * kTextSize}, series[i].label, kTextSize);
  }
}

double legend_width_px(const Canvas& canvas, const std::vector<Series>& series) {
  double width_px = 0;
  for (const Series& s : series) {
    width_px = std::max(width_px, canvas.text_width_px(s.label, kTextSize));
  }
  return width_px > 0 ? width_px + 54 : 0;
}

}  // namespace

std::vector<double> ticks(double lower, double upper, int most, bool logarithmic) {
  std::vector<double> result;
  if (!(lower < upper) || !std::isfinite(lower) || !std::isfinite(upper) || most < 1 || (logarithmic && lower <= 0)) {
    return result;
  }
  // Values that differ from an end by rounding only still count as inside.
  const double slack = 1e-9;
  if (logarithmic) {
    const bool few = std::log10(upper / lower) < 2.5;
    const int highest = static_cast<int>(std::ceil(std::log10(upper)));
    for (int power = static_cast<int>(std::floor(std::log10(lower))); power <= highest; ++power) {
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double value = factor * std::pow(10.0, power);
        if ((few || factor == 1.0) && value >= lower * (1 - slack) && value <= upper * (1 + slack)) {
          result.push_back(value);
        }
      }
    }
    return result;
  }
  const double rough = (upper - lower) / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    step = factor * power >= rough * (1 - slack) ? factor * power : step;
  }
  const double first = std::ceil(lower / step - slack);
  for (int i = 0; (first + i) * step <= upper + slack * step; ++i) {
    result.push_back(first + i == 0 ? 0.0 : (first + i) * step);
  }
  return result;
}

void draw_plot(Canvas& canvas, const Rectangle& area, const Plot& plot) {
  Axis x;
  Axis y;
  x.logarithmic = plot.log_x;
  y.logarithmic = plot.log_y;
  for (const Series& s : plot.series) {
    if (s.x.size() != s.y.size()) {
      fail("plot '", plot.title, "': series '", s.label, "' has ", s.x.size(), " x and ", s.y.size(),
           " y values, must be as many");
    }
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (x.shows(s.x[i]) && y.shows(s.y[i])) {
        x.include(s.x[i]);
        y.include(s.y[i]);
      }
    }
  }
  x.settle();
  y.settle();
  const std::vector<double> y_ticks = ticks(y.lower, y.upper, 8, y.logarithmic);
  double y_text_px = 0;
  for (const double value : y_ticks) {
    y_text_px = std::max(y_text_px, canvas.text_width_px(number(value), kTextSize));
  }
  const double left_px = y_text_px + 3.2 * kTextSize;
  const double top_px = plot.title.empty() ? kTextSize : 2.4 * kTextSize;
  const Rectangle frame{area.x_px + left_px, area.y_px + top_px,
                        area.width_px - left_px - kTextSize - legend_width_px(canvas, plot.series),
                        area.height_px - top_px - 3.8 * kTextSize};
  if (!(frame.width_px > 0 && frame.height_px > 0)) {
    return;  // too small to show anything
  }
  x.begin_px = frame.x_px;
  x.end_px = frame.x_px + frame.width_px;
  y.begin_px = frame.y_px + frame.height_px;
  y.end_px = frame.y_px;

  for (const double value : ticks(x.lower, x.upper, 8, x.logarithmic)) {
    canvas.line({x.pixel(value), y.begin_px}, {x.pixel(value), y.end_px}, {kGrid, 1});
    canvas.text({x.pixel(value), y.begin_px + 1.4 * kTextSize}, number(value), kTextSize, kBlack, Align::centre);
  }
  for (const double value : y_ticks) {
    canvas.line({x.begin_px, y.pixel(value)}, {x.end_px, y.pixel(value)}, {kGrid, 1});
    canvas.text({x.begin_px - 6, y.pixel(value) + 0.35 * kTextSize}, number(value), kTextSize, kBlack, Align::right);
  }
  canvas.outline(frame, {kBlack, 1});
  canvas.clip({frame.x_px - 5, frame.y_px - 5, frame.width_px + 10, frame.height_px + 10});
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& s = plot.series[i];
    const Colour colour = series_colour(static_cast<unsigned>(i));
    std::vector<CanvasPoint> points;
    for (std::size_t k = 0; k < s.x.size(); ++k) {
      points.push_back({x.pixel(s.x[k]), y.pixel(s.y[k])});
    }
    if (s.joined) {
      canvas.polyline(points, {colour, 2});
    }
    for (const CanvasPoint& p : s.markers ? points : std::vector<CanvasPoint>{}) {
      canvas.disc(p, 3.5, colour);
    }
  }
  canvas.unclip();
  const double middle_px = frame.x_px + 0.5 * frame.width_px;
  canvas.text({middle_px, area.y_px + 1.4 * kTextSize}, plot.title, 1.2 * kTextSize, kBlack, Align::centre);
  canvas.text({middle_px, area.y_px + area.height_px - 0.6 * kTextSize}, plot.x_label, kTextSize, kBlack,
              Align::centre);
  canvas.text({area.x_px + 1.3 * kTextSize, frame.y_px + 0.5 * frame.height_px}, plot.y_label, kTextSize, kBlack,
              Align::centre, -0.5 * std::numbers::pi);
  draw_legend(canvas, frame, plot.series);
}

}  // namespace depthgrid::report
