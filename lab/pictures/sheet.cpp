#include "lab/pictures/sheet.hpp"

#include <array>
#include <cmath>
#include <sstream>

namespace depthgrid::lab {
namespace {

constexpr double kScale = 2;
constexpr double kLineHeight = 1.28;  // of the size of its text

report::CanvasPoint pixels(const OnSheet& p) { return {kScale * p.x(), kScale * p.y()}; }

report::Rectangle pixels(const OnSheet& corner, const OnSheet& size) {
  return {kScale * corner.x(), kScale * corner.y(), kScale * size.x(), kScale * size.y()};
}

std::vector<report::CanvasPoint> pixels(std::span<const OnSheet> points) {
  std::vector<report::CanvasPoint> result;
  for (const OnSheet& p : points) {
    result.push_back(pixels(p));
  }
  return result;
}

}  // namespace

Sheet::Sheet(double height)
    : height_(height), canvas_(static_cast<int>(kScale * kSheetWidth), static_cast<int>(kScale * height)) {}

void Sheet::line(std::span<const OnSheet> points, const report::Colour& colour, double width, double dash) {
  canvas_.polyline(pixels(points), {colour, kScale * width, kScale * dash});
}

void Sheet::line(const OnSheet& from, const OnSheet& to, const report::Colour& colour, double width, double dash) {
  const std::array<OnSheet, 2> points{from, to};
  line(points, colour, width, dash);
}

void Sheet::arrow(const OnSheet& from, const OnSheet& to, const report::Colour& colour, double width, bool both) {
  const OnSheet along = (to - from).normalized();
  const OnSheet across(-along.y(), along.x());
  const double head = 5 + 1.5 * width;
  const auto draw_head = [&](const OnSheet& tip, const OnSheet& back) {
    const std::array<OnSheet, 3> corners{tip, tip + head * back + 0.42 * head * across,
                                         tip + head * back - 0.42 * head * across};
    polygon(corners, colour);
  };
  line(both ? OnSheet(from + 0.7 * head * along) : from, to - 0.7 * head * along, colour, width);
  draw_head(to, -along);
  if (both) {
    draw_head(from, along);
  }
}

void Sheet::polygon(std::span<const OnSheet> corners, const report::Colour& colour) {
  canvas_.polygon(pixels(corners), colour);
}

void Sheet::fill(const OnSheet& corner, const OnSheet& size, const report::Colour& colour) {
  canvas_.fill(pixels(corner, size), colour);
}

void Sheet::outline(const OnSheet& corner, const OnSheet& size, const report::Colour& colour, double width,
                    double dash) {
  canvas_.outline(pixels(corner, size), {colour, kScale * width, kScale * dash});
}

void Sheet::disc(const OnSheet& centre, double radius, const report::Colour& colour) {
  canvas_.disc(pixels(centre), kScale * radius, colour);
}

void Sheet::circle(const OnSheet& centre, double radius, const report::Colour& colour, double width, double dash) {
  canvas_.circle(pixels(centre), kScale * radius, {colour, kScale * width, kScale * dash});
}

void Sheet::point(const OnSheet& centre, const report::Colour& colour, double radius) {
  disc(centre, radius + 1.2, report::kWhite);
  disc(centre, radius, colour);
}

void Sheet::text(const OnSheet& at, const std::string& text, const report::Colour& colour, report::Align align,
                 double size) {
  std::istringstream lines(text);
  OnSheet place = at;
  for (std::string line; std::getline(lines, line); place.y() += kLineHeight * size) {
    canvas_.text(pixels(place), line, kScale * size, colour, align);
  }
}

void Sheet::title(const OnSheet& at, const std::string& title) {
  text(at, title, kInk, report::Align::left, kTitleSize);
}

void Sheet::pointer(const OnSheet& from, const OnSheet& to) {
  line(from, to, report::kWhite, 2.6);
  line(from, to, kInk, 0.9);
  disc(to, 2.2, kInk);
}

void Sheet::key(const OnSheet& at, std::span<const std::pair<std::string, report::Colour>> entries) {
  OnSheet place = at;
  for (const auto& [what, colour] : entries) {
    fill(place - OnSheet(0, 9.5), {11, 11}, colour);
    outline(place - OnSheet(0, 9.5), {11, 11}, kInk, 0.5);
    text(place + OnSheet(16, 0), what);
    place.x() += 16 + canvas_.text_width_px(what, kScale * kLabelSize) / kScale + 18;
  }
}

void Sheet::camera(const OnSheet& at, const OnSheet& direction, double half_angle_rad) {
  const OnSheet along = direction.normalized();
  const OnSheet across(-along.y(), along.x());
  constexpr double kLength = 20;
  const double half = kLength * std::tan(half_angle_rad);
  const std::array<OnSheet, 3> corners{at, at + kLength * along + half * across, at + kLength * along - half * across};
  polygon(corners, kInk);
}

void Sheet::shade(const OnSheet& corner, const OnSheet& size,
                  const std::function<report::Colour(const OnSheet&)>& colour_at) {
  report::Raster raster(static_cast<int>(kScale * size.x()), static_cast<int>(kScale * size.y()));
  for (int v = 0; v < raster.height_px; ++v) {
    for (int u = 0; u < raster.width_px; ++u) {
      raster.set(u, v, colour_at(corner + OnSheet(u + 0.5, v + 0.5) / kScale));
    }
  }
  canvas_.raster(pixels(corner, size), raster);
}

void Sheet::clip(const OnSheet& corner, const OnSheet& size) { canvas_.clip(pixels(corner, size)); }

void Sheet::unclip() { canvas_.unclip(); }

}  // namespace depthgrid::lab
