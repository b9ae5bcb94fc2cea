// A picture of a documentation page: drawn in units of the page, twice as fine as it is shown there.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "report/canvas.hpp"
#include "report/scene_colours.hpp"

namespace depthgrid::lab {

/// Where on the page: x to the right, y down. A unit is a pixel of a page 800 wide, two pixels of the file.
using OnSheet = Eigen::Vector2d;

inline constexpr double kSheetWidth = 800;
inline constexpr double kTitleSize = 15;
inline constexpr double kLabelSize = 12.5;
inline constexpr report::Colour kInk = report::kBlack;
inline constexpr report::Colour kSoftInk{0.38, 0.40, 0.44};

class Sheet {
 public:
  explicit Sheet(double height);

  [[nodiscard]] double height() const { return height_; }

  void line(std::span<const OnSheet> points, const report::Colour& colour, double width = 1.2, double dash = 0);
  void line(const OnSheet& from, const OnSheet& to, const report::Colour& colour, double width = 1.2, double dash = 0);
  /// With a head at the end; `both` puts one at the beginning as well.
  void arrow(const OnSheet& from, const OnSheet& to, const report::Colour& colour, double width = 1.4,
             bool both = false);
  void polygon(std::span<const OnSheet> corners, const report::Colour& colour);
  void fill(const OnSheet& corner, const OnSheet& size, const report::Colour& colour);
  void outline(const OnSheet& corner, const OnSheet& size, const report::Colour& colour, double width = 1,
               double dash = 0);
  void disc(const OnSheet& centre, double radius, const report::Colour& colour);
  void circle(const OnSheet& centre, double radius, const report::Colour& colour, double width = 1.2, double dash = 0);
  /// A control point or a nearest point: a disc with a white rim.
  void point(const OnSheet& centre, const report::Colour& colour, double radius = 4.5);

  /// Lines of text, from the first base line down.
  void text(const OnSheet& at, const std::string& text, const report::Colour& colour = kInk,
            report::Align align = report::Align::left, double size = kLabelSize);
  void title(const OnSheet& at, const std::string& text);
  /// Text with a thin line from `from` to what it names.
  void pointer(const OnSheet& from, const OnSheet& to);
  /// Small squares of colour with what they mean, side by side.
  void key(const OnSheet& at, std::span<const std::pair<std::string, report::Colour>> entries);
  /// A camera as a small triangle that opens to where it looks, with its name beside it.
  void camera(const OnSheet& at, const OnSheet& direction, double half_angle_rad);

  /// Colours of the area, from the centre of each of the file's pixels.
  void shade(const OnSheet& corner, const OnSheet& size,
             const std::function<report::Colour(const OnSheet&)>& colour_at);
  void clip(const OnSheet& corner, const OnSheet& size);
  void unclip();

  void save_png(const std::filesystem::path& file) const { canvas_.save_png(file); }

 private:
  double height_;
  report::Canvas canvas_;
};

}  // namespace depthgrid::lab
