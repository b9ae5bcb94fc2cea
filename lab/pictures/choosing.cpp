// What each declared number buys and costs, from the formulas of the pages about them.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "lab/pictures/pictures.hpp"
#include "report/colour.hpp"

namespace depthgrid::lab {
namespace {

struct Curve {
  std::string label;
  std::function<double(double)> y_of;
};

struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  double x_most = 1;
  double y_most = 1;
  int x_steps = 4;
  int y_steps = 4;
  std::vector<Curve> curves;
};

constexpr double kPanelWidth = 284;
constexpr double kPanelHeight = 190;
constexpr int kSamples = 40;

std::string tick_text(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  return text.back() == '.' ? text.substr(0, text.size() - 1) : text;
}

/// The curves end where they leave the panel; each has its name at its last point inside.
void draw(Sheet& sheet, const OnSheet& corner, const Panel& panel) {
  const auto place = [&](double x, double y) {
    return OnSheet(corner.x() + x / panel.x_most * kPanelWidth, corner.y() + (1 - y / panel.y_most) * kPanelHeight);
  };
  sheet.title(corner + OnSheet(-34, -28), panel.title);
  for (int i = 0; i <= panel.x_steps; ++i) {
    const double x = panel.x_most * i / panel.x_steps;
    sheet.line(place(x, 0), place(x, panel.y_most), report::Colour{0.88, 0.88, 0.9}, 0.8);
    sheet.text(place(x, 0) + OnSheet(0, 16), tick_text(x), kSoftInk, report::Align::centre);
  }
  for (int i = 0; i <= panel.y_steps; ++i) {
    const double y = panel.y_most * i / panel.y_steps;
    sheet.line(place(0, y), place(panel.x_most, y), report::Colour{0.88, 0.88, 0.9}, 0.8);
    sheet.text(place(0, y) + OnSheet(-7, 4), tick_text(y), kSoftInk, report::Align::right);
  }
  sheet.text(place(panel.x_most / 2, 0) + OnSheet(0, 33), panel.x_label, kInk, report::Align::centre);
  sheet.text(corner + OnSheet(-34, -10), panel.y_label, kSoftInk);
  for (std::size_t k = 0; k < panel.curves.size(); ++k) {
    const report::Colour colour = report::series_colour(static_cast<unsigned>(k));
    std::vector<OnSheet> points;
    for (int i = 0; i <= kSamples; ++i) {
      const double x = panel.x_most * i / kSamples;
      const double y = panel.curves[k].y_of(x);
      if (std::isfinite(y) && y >= 0 && y <= panel.y_most) {
        points.push_back(place(x, y));
      }
    }
    sheet.line(points, colour, 1.8);
    const OnSheet end = points.back().x() > corner.x() + kPanelWidth - 1 ? points.back() + OnSheet(5, 4)
                                                                         : points.back() + OnSheet(5, 10);
    sheet.text(end, panel.curves[k].label, colour);
  }
}

/// A Kinect v1: f = 525 px, at the corner of its image 0.8 of that; readings up to 2 px beside their place.
Panel hole_panel() {
  const auto curve = [](double s_m) {
    return [s_m](double hole_px) { return s_m * 525 * 0.8 / (hole_px + 4) - s_m / 2; };
  };
  return {"s: what a hole says",
          "width W of the hole, px (a lone pixel: 2)",
          "nothing is nearer than, m",
          16,
          8,
          4,
          4,
          {{"2 cm", curve(0.02)}, {"5 cm", curve(0.05)}, {"10 cm", curve(0.1)}}};
}

Panel speed_panel() {
  const auto curve = [](double v_m_s) { return [v_m_s](double hidden_s) { return v_m_s * hidden_s; }; };
  return {"v_max: what comes back",
          "hidden for, s",
          "from its border something may have come, m",
          1,
          2,
          5,
          4,
          {{"0.25 m/s", curve(0.25)}, {"1.6 m/s", curve(1.6)}, {"2 m/s", curve(2)}}};
}

Panel exposure_panel() {
  const auto curve = [](double exposure_s) {
    return [exposure_s](double v_m_s) { return 1e3 * v_m_s * exposure_s / 2; };
  };
  return {"Exposure: what it adds to e",
          "v_max, m/s",
          "e grows by, mm",
          2,
          80,
          4,
          4,
          {{"8 ms", curve(0.008)}, {"66.7 ms", curve(2 / 30.0)}}};
}

/// Half a voxel's diagonal, with half of a voxel pending on the average, less half the thinnest hidden thing.
Panel hidden_panel() {
  const auto curve = [](double voxel_m) {
    return [voxel_m](double hidden_cm) {
      return 200 * std::max(0.0, voxel_m * (std::sqrt(3.0) / 2 + 0.5) - hidden_cm / 200);
    };
  };
  return {"Thinnest hidden thing: what a gap needs",
          "thinnest hidden thing, cm; curves: the voxel's side",
          "cleared from a width of, cm",
          6,
          8,
          3,
          4,
          {{"2.5 cm", curve(0.025)}, {"1.25 cm", curve(0.0125)}}};
}

}  // namespace

Sheet draw_choosing() {
  Sheet sheet(604);
  draw(sheet, {46, 58}, hole_panel());
  draw(sheet, {438, 58}, speed_panel());
  draw(sheet, {46, 362}, exposure_panel());
  draw(sheet, {438, 362}, hidden_panel());
  return sheet;
}

}  // namespace depthgrid::lab
