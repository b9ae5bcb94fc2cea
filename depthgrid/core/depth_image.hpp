// Depth images: a view on the caller's own buffer, and the one place that decides what is a measurement.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "depthgrid/core/aligned_vector.hpp"

namespace depthgrid {

/// How the pixels of a depth image are stored.
enum class DepthFormat : std::uint8_t {
  uint16_units,    ///< unsigned 16-bit, metres = value * metres_per_unit
  float32_metres,  ///< float, metres
};

/// Bytes of one row without padding.
[[nodiscard]] constexpr std::ptrdiff_t row_bytes(DepthFormat format, int width_px) noexcept {
  return width_px *
         static_cast<std::ptrdiff_t>(format == DepthFormat::uint16_units ? sizeof(std::uint16_t) : sizeof(float));
}

/// A depth image in somebody else's memory: never copied, never owned. The buffer must outlive the view
/// and must not change while a call reads it. Depth is z (not range along the ray).
struct DepthView {
  const void* data = nullptr;
  DepthFormat format = DepthFormat::uint16_units;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;  ///< distance between rows; depth_view() fills it in
  double metres_per_unit = 0.001;   ///< used by uint16_units only
};

/// View on 16-bit depth. `stride_bytes` = 0 means rows without padding. Throws Error when the buffer is
/// too small for width, height and stride, the stride is odd or shorter than a row, or as check_plausible_scale().
DepthView depth_view(std::span<const std::uint16_t> pixels, int width_px, int height_px, double metres_per_unit,
                     std::ptrdiff_t stride_bytes = 0);

/// View on float depth in metres. Errors as above.
DepthView depth_view(std::span<const float> pixels_m, int width_px, int height_px, std::ptrdiff_t stride_bytes = 0);

/// What counts as a measurement. Zero, negative, NaN, infinite, saturated (65535) and every listed value
/// are none; so is a depth below near_m; so is one above far_m unless `clamp_beyond_far`.
struct MeasurementRule {
  double near_m = 0.0;
  double far_m = std::numeric_limits<double>::infinity();
  /// Only for sensors that tell "farther than far_m" from "no return": such a reading counts as far_m.
  bool clamp_beyond_far = false;
  std::vector<std::uint16_t> invalid_units;  ///< further 16-bit values that mean "no measurement"
};

/// Throws Error unless 0 <= near_m < far_m. `name` is used in messages only.
void validate(const MeasurementRule& rule, const char* name = "measurement rule");

/// The measured depth of pixel (u, v) in metres, or nothing. (u, v) must lie in the image.
/// This function and normalise() are the only places that decide what is a measurement.
[[nodiscard]] std::optional<float> measured_depth_m(const DepthView& view, const MeasurementRule& rule, int u,
                                                    int v) noexcept;

/// A dense float depth image owned by the library: row-major, no padding, metres, 0 = no measurement. The first pixel
/// lies at the beginning of a cache line.
class DepthImage {
 public:
  DepthImage() = default;
  /// All pixels "no measurement".
  DepthImage(int width_px, int height_px);

  [[nodiscard]] int width_px() const noexcept { return width_px_; }
  [[nodiscard]] int height_px() const noexcept { return height_px_; }
  [[nodiscard]] const float* data() const noexcept { return depth_m_.data(); }
  [[nodiscard]] float* data() noexcept { return depth_m_.data(); }
  [[nodiscard]] float at(int u, int v) const noexcept { return depth_m_[index(u, v)]; }
  [[nodiscard]] float& at(int u, int v) noexcept { return depth_m_[index(u, v)]; }
  [[nodiscard]] std::size_t index(int u, int v) const noexcept {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px_) + static_cast<std::size_t>(u);
  }

 private:
  int width_px_ = 0;
  int height_px_ = 0;
  AlignedVector<float> depth_m_;
};

/// The image as a camera's, metres. Throws Error when it is empty.
DepthView depth_view(const DepthImage& image_m);

/// Writes the measured depths of `view` into `image` (0 = no measurement). Sizes must be equal. Does not allocate.
void normalise(const DepthView& view, const MeasurementRule& rule, DepthImage& image) noexcept;

}  // namespace depthgrid
