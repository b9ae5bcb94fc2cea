// A surface to draw on: PNG and SVG from the same calls. The drawing library is not visible from here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "report/colour.hpp"

namespace depthgrid::report {

/// Canvas coordinates: pixels, x to the right, y down, the origin at the top left corner.
struct CanvasPoint {
  double x_px = 0;
  double y_px = 0;
};

struct Rectangle {
  double x_px = 0;
  double y_px = 0;
  double width_px = 0;
  double height_px = 0;
};

/// Which point of a text stands at the given place; vertically it is always the base line.
enum class Align : std::uint8_t { left, centre, right };

/// How a line or outline is drawn.
struct Stroke {
  Colour colour = kBlack;
  double width_px = 1;
  double dash_px = 0;  ///< length of dashes and of the gaps between them; 0: solid
};

/// A raster of colours: row-major, three bytes (red, green, blue) a pixel.
struct Raster {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;

  Raster(int width, int height);
  /// (u, v) must lie in the raster.
  void set(int u, int v, const Colour& colour) noexcept;
};

/// Drawing calls with coordinates that are not finite draw nothing. Not thread-safe.
class Canvas {
 public:
  /// Throws Error unless both sides are in [1, 16384].
  Canvas(int width_px, int height_px, const Colour& background = kWhite);
  ~Canvas();
  Canvas(const Canvas& other) = delete;
  Canvas& operator=(const Canvas& other) = delete;
  Canvas(Canvas&& other) noexcept;
  Canvas& operator=(Canvas&& other) noexcept;

  [[nodiscard]] int width_px() const noexcept;
  [[nodiscard]] int height_px() const noexcept;

  void fill(const Rectangle& area, const Colour& colour);
  void outline(const Rectangle& area, const Stroke& stroke);
  void line(const CanvasPoint& from, const CanvasPoint& to, const Stroke& stroke);
  void polyline(std::span<const CanvasPoint> points, const Stroke& stroke);
  void polygon(std::span<const CanvasPoint> points, const Colour& colour);
  void disc(const CanvasPoint& centre, double radius_px, const Colour& colour);
  void circle(const CanvasPoint& centre, double radius_px, const Stroke& stroke);
  /// UTF-8; bytes that are none are shown as '?'. Without any font on the machine a built-in one is used.
  void text(const CanvasPoint& at, const std::string& text, double size_px, const Colour& colour = kBlack,
            Align align = Align::left, double angle_rad = 0);
  /// Width that text() would take.
  [[nodiscard]] double text_width_px(const std::string& text, double size_px) const;
  /// Scales the raster to the area without blending its pixels.
  void raster(const Rectangle& area, const Raster& raster);

  /// Until unclip() nothing is drawn outside `area`.
  void clip(const Rectangle& area);
  void unclip();

  /// Written under a temporary name and then renamed. Throw Error that names the file.
  void save_png(const std::filesystem::path& file) const;
  void save_svg(const std::filesystem::path& file) const;

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

}  // namespace depthgrid::report
