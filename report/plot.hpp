// Line plots of measured figures.
#pragma once

#include <string>
#include <vector>

#include "report/canvas.hpp"

namespace depthgrid::report {

/// Points in the order in which they are joined. x and y have the same length; values that are not finite (or not
/// positive on a logarithmic axis) leave a gap.
struct Series {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
  bool markers = true;
  bool joined = true;  ///< false: markers only
};

struct Plot {
  std::string title;
  std::string x_label;  ///< with unit, for instance "cameras" or "distance (m)"
  std::string y_label;
  bool log_x = false;
  bool log_y = false;
  std::vector<Series> series;
};

/// Round values that cover [lower, upper]: steps of 1, 2 or 5 times a power of ten, at most `most` + 1 of them; powers
/// of ten on a logarithmic axis (with 2 and 5 between them where there are few). Empty unless lower < upper and, when
/// logarithmic, lower > 0.
[[nodiscard]] std::vector<double> ticks(double lower, double upper, int most, bool logarithmic);

/// Draws title, axes with ticks and labels, the series and a legend into `area`. Throws Error when a series has x and y
/// of different lengths.
void draw_plot(Canvas& canvas, const Rectangle& area, const Plot& plot);

}  // namespace depthgrid::report
