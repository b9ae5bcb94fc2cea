#include "report/canvas.hpp"

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_replacement.hpp"

namespace depthgrid::report {

namespace {

constexpr int kLargestSide = 16384;

struct SurfaceDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextDeleter {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
struct FontDeleter {
  void operator()(cairo_font_face_t* font) const { cairo_font_face_destroy(font); }
};
using SurfacePointer = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using ContextPointer = std::unique_ptr<cairo_t, ContextDeleter>;
using FontPointer = std::unique_ptr<cairo_font_face_t, FontDeleter>;

/// A sans-serif font, or the one built into cairo where the machine has none: an error while drawing text would
/// silence everything drawn after it. Tried out on a surface of its own.
FontPointer usable_font() {
  const SurfacePointer surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 8, 8));
  for (const char* family : {"sans-serif", "@cairo:"}) {
    FontPointer font(cairo_toy_font_face_create(family, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL));
    const ContextPointer trial(cairo_create(surface.get()));
    cairo_set_font_face(trial.get(), font.get());
    cairo_text_extents_t extents;
    cairo_text_extents(trial.get(), "m", &extents);
    cairo_show_text(trial.get(), "m");
    if (cairo_status(trial.get()) == CAIRO_STATUS_SUCCESS && extents.x_advance > 0) {
      return font;
    }
  }
  return nullptr;
}

/// `text` with every byte that does not belong to a well-formed UTF-8 sequence replaced by '?'.
std::string valid_utf8(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    std::size_t length = 0;
    if (byte != 0 && byte < 0x80U) {
      length = 1;
    } else if (byte >= 0xC2U && byte < 0xE0U) {
      length = 2;
    } else if (byte >= 0xE1U && byte < 0xF0U && byte != 0xEDU) {  // leaves out what could be overlong or a surrogate
      length = 3;
    }
    bool good = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; good && k < length; ++k) {
      good = (static_cast<unsigned char>(text[i + k]) & 0xC0U) == 0x80U;
    }
    length = good ? length : 1;
    result += good ? text.substr(i, length) : "?";
    i += length;
  }
  return result;
}

bool finite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

cairo_status_t write_bytes(void* stream, const unsigned char* data, unsigned int length) {
  const auto written = std::fwrite(data, 1, length, static_cast<std::FILE*>(stream));
  return written == length ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

void require_success(cairo_status_t status, const std::filesystem::path& file) {
  if (status != CAIRO_STATUS_SUCCESS) {
    fail("cannot write picture '", file.string(), "': ", cairo_status_to_string(status));
  }
}

}  // namespace

/// Everything drawn is recorded, so that it can be played into a PNG and into an SVG.
struct Canvas::Surface {
  int width_px = 0;
  int height_px = 0;
  SurfacePointer recording;
  ContextPointer context;
  FontPointer font;

  [[nodiscard]] cairo_t* ink(const Colour& colour) const {
    cairo_set_source_rgba(context.get(), colour.red, colour.green, colour.blue, colour.alpha);
    return context.get();
  }
  void stroke_path(const Stroke& stroke) const {
    cairo_t* const cr = ink(stroke.colour);
    cairo_set_line_width(cr, stroke.width_px);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_dash(cr, &stroke.dash_px, stroke.dash_px > 0 ? 1 : 0, 0);
    cairo_stroke(cr);
  }
  void path(std::span<const CanvasPoint> points) const {
    bool begun = false;
    for (const CanvasPoint& p : points) {
      if (!finite({p.x_px, p.y_px})) {
        begun = false;  // a gap
      } else if (begun) {
        cairo_line_to(context.get(), p.x_px, p.y_px);
      } else {
        cairo_move_to(context.get(), p.x_px, p.y_px);
        begun = true;
      }
    }
  }
  void play(cairo_surface_t* target) const {
    const ContextPointer player(cairo_create(target));
    cairo_set_source_surface(player.get(), recording.get(), 0, 0);
    cairo_paint(player.get());
  }
};

Raster::Raster(int width, int height) : width_px(width), height_px(height) {
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide) {
    fail("raster of ", width, " x ", height, " px, sides must be between 1 and ", kLargestSide);
  }
  rgb.resize(3U * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

void Raster::set(int u, int v, const Colour& colour) noexcept {
  const std::size_t index =
      3U * (static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(u));
  const auto byte = [](double share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0., 1.)));
  };
  rgb[index] = byte(colour.red);
  rgb[index + 1] = byte(colour.green);
  rgb[index + 2] = byte(colour.blue);
}

Canvas::Canvas(int width_px, int height_px, const Colour& background) : surface_(std::make_unique<Surface>()) {
  if (width_px < 1 || height_px < 1 || width_px > kLargestSide || height_px > kLargestSide) {
    fail("canvas of ", width_px, " x ", height_px, " px, sides must be between 1 and ", kLargestSide);
  }
  const cairo_rectangle_t extents{0, 0, static_cast<double>(width_px), static_cast<double>(height_px)};
  surface_->width_px = width_px;
  surface_->height_px = height_px;
  surface_->recording.reset(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, &extents));
  surface_->context.reset(cairo_create(surface_->recording.get()));
  surface_->font = usable_font();
  fill({0, 0, extents.width, extents.height}, background);
}
Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;

int Canvas::width_px() const noexcept { return surface_->width_px; }
int Canvas::height_px() const noexcept { return surface_->height_px; }

void Canvas::fill(const Rectangle& area, const Colour& colour) {
  if (finite({area.x_px, area.y_px, area.width_px, area.height_px})) {
    cairo_t* const cr = surface_->ink(colour);
    cairo_rectangle(cr, area.x_px, area.y_px, area.width_px, area.height_px);
    cairo_fill(cr);
  }
}

void Canvas::outline(const Rectangle& area, const Stroke& stroke) {
  if (finite({area.x_px, area.y_px, area.width_px, area.height_px})) {
    cairo_rectangle(surface_->context.get(), area.x_px, area.y_px, area.width_px, area.height_px);
    surface_->stroke_path(stroke);
  }
}

void Canvas::line(const CanvasPoint& from, const CanvasPoint& to, const Stroke& stroke) {
  const std::array<CanvasPoint, 2> points{from, to};
  polyline(points, stroke);
}

void Canvas::polyline(std::span<const CanvasPoint> points, const Stroke& stroke) {
  surface_->path(points);
  surface_->stroke_path(stroke);
}

void Canvas::polygon(std::span<const CanvasPoint> points, const Colour& colour) {
  surface_->path(points);
  cairo_fill(surface_->ink(colour));
}

void Canvas::disc(const CanvasPoint& centre, double radius_px, const Colour& colour) {
  if (finite({centre.x_px, centre.y_px, radius_px})) {
    cairo_t* const cr = surface_->ink(colour);
    cairo_arc(cr, centre.x_px, centre.y_px, radius_px, 0, 2 * std::numbers::pi);
    cairo_fill(cr);
  }
}

void Canvas::circle(const CanvasPoint& centre, double radius_px, const Stroke& stroke) {
  if (finite({centre.x_px, centre.y_px, radius_px})) {
    cairo_arc(surface_->context.get(), centre.x_px, centre.y_px, radius_px, 0, 2 * std::numbers::pi);
    surface_->stroke_path(stroke);
  }
}

void Canvas::text(const CanvasPoint& at, const std::string& text, double size_px, const Colour& colour, Align align,
                  double angle_rad) {
  if (surface_->font == nullptr || !finite({at.x_px, at.y_px, angle_rad}) || !(size_px > 0)) {
    return;
  }
  const double width_px = text_width_px(text, size_px);
  const double share = align == Align::left ? 0.0 : align == Align::centre ? 0.5 : 1.0;
  cairo_t* const cr = surface_->ink(colour);
  cairo_save(cr);
  cairo_translate(cr, at.x_px, at.y_px);
  cairo_rotate(cr, angle_rad);
  cairo_move_to(cr, -share * width_px, 0);
  cairo_show_text(cr, valid_utf8(text).c_str());
  cairo_new_path(cr);
  cairo_restore(cr);
}

double Canvas::text_width_px(const std::string& text, double size_px) const {
  if (surface_->font == nullptr || !(size_px > 0)) {
    return 0;
  }
  cairo_t* const cr = surface_->context.get();
  cairo_set_font_face(cr, surface_->font.get());
  cairo_set_font_size(cr, size_px);
  cairo_text_extents_t extents;
  cairo_text_extents(cr, valid_utf8(text).c_str(), &extents);
  return extents.x_advance;
}

void Canvas::raster(const Rectangle& area, const Raster& raster) {
  if (!finite({area.x_px, area.y_px}) || !(area.width_px > 0) || !(area.height_px > 0)) {
    return;
  }
  const SurfacePointer image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, raster.width_px, raster.height_px));
  const int stride = cairo_image_surface_get_stride(image.get());
  unsigned char* const data = cairo_image_surface_get_data(image.get());
  if (data == nullptr) {
    fail("no memory for a raster of ", raster.width_px, " x ", raster.height_px, " px");
  }
  const auto width = static_cast<std::size_t>(raster.width_px);
  for (std::size_t v = 0; v < static_cast<std::size_t>(raster.height_px); ++v) {
    auto* const row = reinterpret_cast<std::uint32_t*>(data + v * static_cast<std::size_t>(stride));
    for (std::size_t u = 0; u < width; ++u) {
      const std::uint8_t* const rgb = raster.rgb.data() + 3 * (v * width + u);
      row[u] = (static_cast<std::uint32_t>(rgb[0]) << 16U) | (static_cast<std::uint32_t>(rgb[1]) << 8U) | rgb[2];
    }
  }
  cairo_surface_mark_dirty(image.get());
  cairo_t* const cr = surface_->context.get();
  cairo_save(cr);
  cairo_translate(cr, area.x_px, area.y_px);
  cairo_scale(cr, area.width_px / raster.width_px, area.height_px / raster.height_px);
  cairo_set_source_surface(cr, image.get(), 0, 0);
  // Nearest, because a blend of two depths is none.
  cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
  cairo_rectangle(cr, 0, 0, raster.width_px, raster.height_px);
  cairo_fill(cr);
  cairo_restore(cr);
}

void Canvas::clip(const Rectangle& area) {
  cairo_rectangle(surface_->context.get(), area.x_px, area.y_px, area.width_px, area.height_px);
  cairo_clip(surface_->context.get());
}

void Canvas::unclip() { cairo_reset_clip(surface_->context.get()); }

void Canvas::save_png(const std::filesystem::path& file) const {
  require_success(cairo_status(surface_->context.get()), file);
  const SurfacePointer image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, surface_->width_px, surface_->height_px));
  surface_->play(image.get());
  FileReplacement target(file);
  require_success(cairo_surface_write_to_png_stream(image.get(), write_bytes, target.stream()), file);
  target.commit();
}

void Canvas::save_svg(const std::filesystem::path& file) const {
  require_success(cairo_status(surface_->context.get()), file);
  FileReplacement target(file);
  const SurfacePointer page(
      cairo_svg_surface_create_for_stream(write_bytes, target.stream(), surface_->width_px, surface_->height_px));
  surface_->play(page.get());
  cairo_surface_finish(page.get());
  require_success(cairo_surface_status(page.get()), file);
  target.commit();
}

}  // namespace depthgrid::report
