#include "depthgrid/core/depth_image.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid {
namespace {

constexpr std::uint16_t kSaturated = 65535;

void check_layout(std::size_t elements, std::size_t element_bytes, int width_px, int height_px,
                  std::ptrdiff_t& stride_bytes) {
  if (width_px < 1 || height_px < 1 || width_px > kLargestImageSide || height_px > kLargestImageSide) {
    fail("depth image: size is ", width_px, " x ", height_px, " px, each side must be between 1 and ",
         kLargestImageSide);
  }
  const auto row_bytes = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(width_px) * element_bytes);
  if (stride_bytes == 0) {
    stride_bytes = row_bytes;
  }
  if (stride_bytes < row_bytes || stride_bytes % static_cast<std::ptrdiff_t>(element_bytes) != 0) {
    fail("depth image: stride is ", stride_bytes, " bytes, must be a multiple of ", element_bytes, " and at least ",
         row_bytes, " for ", width_px, " pixels");
  }
  const auto needed = static_cast<std::size_t>(stride_bytes) * static_cast<std::size_t>(height_px - 1) +
                      static_cast<std::size_t>(row_bytes);
  if (elements * element_bytes < needed) {
    fail("depth image: buffer has ", elements * element_bytes, " bytes, ", width_px, " x ", height_px,
         " pixels with a stride of ", stride_bytes, " bytes need ", needed);
  }
}

/// 0 = no measurement. NaN fails every comparison and ends as 0.
inline float decide(float depth_m, float near_m, float far_m, bool clamp) noexcept {
  if (!(depth_m > 0.0F) || !(depth_m >= near_m) || std::isinf(depth_m)) {
    return 0.0F;
  }
  if (depth_m > far_m) {
    return clamp ? far_m : 0.0F;
  }
  return depth_m;
}

inline float decide_units(std::uint16_t value, float scale, float near_m, float far_m,
                          const MeasurementRule& rule) noexcept {
  if (value == 0 || value == kSaturated) {
    return 0.0F;
  }
  for (const std::uint16_t invalid : rule.invalid_units) {
    if (value == invalid) {
      return 0.0F;
    }
  }
  return decide(static_cast<float>(value) * scale, near_m, far_m, rule.clamp_beyond_far);
}

template <class Pixel>
const Pixel* row(const DepthView& view, int v) noexcept {
  return reinterpret_cast<const Pixel*>(static_cast<const char*>(view.data) + view.stride_bytes * v);
}

inline float pixel_depth_m(const DepthView& view, const MeasurementRule& rule, float near_m, float far_m, int u,
                           int v) noexcept {
  if (view.format == DepthFormat::uint16_units) {
    return decide_units(row<std::uint16_t>(view, v)[u], static_cast<float>(view.metres_per_unit), near_m, far_m, rule);
  }
  return decide(row<float>(view, v)[u], near_m, far_m, rule.clamp_beyond_far);
}

}  // namespace

DepthView depth_view(std::span<const std::uint16_t> pixels, int width_px, int height_px, double metres_per_unit,
                     std::ptrdiff_t stride_bytes) {
  check_layout(pixels.size(), sizeof(std::uint16_t), width_px, height_px, stride_bytes);
  if (!(std::isfinite(metres_per_unit) && metres_per_unit > 0)) {
    fail("depth image: metres_per_unit is ", metres_per_unit, ", must be a positive finite number");
  }
  return {pixels.data(), DepthFormat::uint16_units, width_px, height_px, stride_bytes, metres_per_unit};
}

DepthView depth_view(std::span<const float> pixels_m, int width_px, int height_px, std::ptrdiff_t stride_bytes) {
  check_layout(pixels_m.size(), sizeof(float), width_px, height_px, stride_bytes);
  return {pixels_m.data(), DepthFormat::float32_metres, width_px, height_px, stride_bytes, 1.0};
}

void validate(const MeasurementRule& rule, const char* name) {
  if (!(std::isfinite(rule.near_m) && rule.near_m >= 0)) {
    fail(name, ": near is ", rule.near_m, " m, must be a finite number that is not negative");
  }
  if (!(rule.far_m > rule.near_m)) {
    fail(name, ": far is ", rule.far_m, " m, must be greater than near (", rule.near_m, " m)");
  }
}

std::optional<float> measured_depth_m(const DepthView& view, const MeasurementRule& rule, int u, int v) noexcept {
  const float depth_m =
      pixel_depth_m(view, rule, static_cast<float>(rule.near_m), static_cast<float>(rule.far_m), u, v);
  return depth_m > 0.0F ? std::optional<float>(depth_m) : std::nullopt;
}

DepthImage::DepthImage(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {
  if (width_px < 1 || height_px < 1 || width_px > kLargestImageSide || height_px > kLargestImageSide) {
    fail("depth image: size is ", width_px, " x ", height_px, " px, each side must be between 1 and ",
         kLargestImageSide);
  }
  depth_m_.assign(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 0.0F);
}

void normalise(const DepthView& view, const MeasurementRule& rule, DepthImage& image) noexcept {
  const auto near_m = static_cast<float>(rule.near_m);
  const auto far_m = static_cast<float>(rule.far_m);
  for (int v = 0; v < view.height_px; ++v) {
    for (int u = 0; u < view.width_px; ++u) {
      image.at(u, v) = pixel_depth_m(view, rule, near_m, far_m, u, v);
    }
  }
}

}  // namespace depthgrid
