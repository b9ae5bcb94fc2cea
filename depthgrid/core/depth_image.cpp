#include "depthgrid/core/depth_image.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/plausibility.hpp"
#include "depthgrid/core/rounding.hpp"

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
  // In floating point, because a huge stride times the height exceeds every integer.
  const double needed = static_cast<double>(stride_bytes) * (height_px - 1) + static_cast<double>(row_bytes);
  const auto available = static_cast<double>(elements * element_bytes);
  if (available < needed) {
    fail("depth image: buffer has ", available, " bytes, ", width_px, " x ", height_px, " pixels with a stride of ",
         stride_bytes, " bytes need ", needed);
  }
}

/// The rule with its limits in the pixels' precision.
struct Decision {
  explicit Decision(const MeasurementRule& rule) noexcept
      : near_m(nearest_float(rule.near_m)),
        far_m(nearest_float(rule.far_m)),
        beyond_far_m(rule.clamp_beyond_far ? far_m : 0.0F),
        invalid_units(rule.invalid_units) {}

  /// 0 = no measurement. NaN fails the comparisons and ends as 0. Selections only, so that rows vectorise.
  [[nodiscard]] float of_metres(float depth_m) const noexcept {
    float result_m = depth_m > far_m ? beyond_far_m : depth_m;
    result_m = depth_m > 0.0F ? result_m : 0.0F;
    result_m = depth_m >= near_m ? result_m : 0.0F;
    return depth_m <= std::numeric_limits<float>::max() ? result_m : 0.0F;
  }

  /// The product is rounded once, so a limit written in metres meets the unit it stands for.
  [[nodiscard]] float of_units(std::uint16_t units, double metres_per_unit) const noexcept {
    const float depth_m = of_metres(static_cast<float>(static_cast<double>(units) * metres_per_unit));
    return units == kSaturated ? 0.0F : depth_m;
  }

  [[nodiscard]] bool listed(std::uint16_t units) const noexcept {
    return std::find(invalid_units.begin(), invalid_units.end(), units) != invalid_units.end();
  }

  float near_m;
  float far_m;
  float beyond_far_m;
  std::span<const std::uint16_t> invalid_units;
};

template <class Pixel>
const Pixel* row(const DepthView& view, int v) noexcept {
  return reinterpret_cast<const Pixel*>(static_cast<const char*>(view.data) + view.stride_bytes * v);
}

}  // namespace

DepthView depth_view(std::span<const std::uint16_t> pixels, int width_px, int height_px, double metres_per_unit,
                     std::ptrdiff_t stride_bytes) {
  check_layout(pixels.size(), sizeof(std::uint16_t), width_px, height_px, stride_bytes);
  check_plausible_scale(metres_per_unit);
  return {pixels.data(), DepthFormat::uint16_units, width_px, height_px, stride_bytes, metres_per_unit};
}

DepthView depth_view(std::span<const float> pixels_m, int width_px, int height_px, std::ptrdiff_t stride_bytes) {
  check_layout(pixels_m.size(), sizeof(float), width_px, height_px, stride_bytes);
  return {pixels_m.data(), DepthFormat::float32_metres, width_px, height_px, stride_bytes, 1.0};
}

DepthView depth_view(const DepthImage& image_m) {
  const std::size_t pixels = image_m.index(0, image_m.height_px());
  return depth_view(std::span(image_m.data(), pixels), image_m.width_px(), image_m.height_px());
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
  const Decision decision(rule);
  float depth_m = 0.0F;
  if (view.format == DepthFormat::uint16_units) {
    const std::uint16_t units = row<std::uint16_t>(view, v)[u];
    depth_m = decision.listed(units) ? 0.0F : decision.of_units(units, view.metres_per_unit);
  } else {
    depth_m = decision.of_metres(row<float>(view, v)[u]);
  }
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
  const Decision decision(rule);
  for (int v = 0; v < view.height_px; ++v) {
    float* depth_m = image.data() + image.index(0, v);
    if (view.format == DepthFormat::float32_metres) {
      const auto* metres = row<float>(view, v);
      for (int u = 0; u < view.width_px; ++u) {
        depth_m[u] = decision.of_metres(metres[u]);
      }
      continue;
    }
    const auto* units = row<std::uint16_t>(view, v);
    const double metres_per_unit = view.metres_per_unit;
    for (int u = 0; u < view.width_px; ++u) {
      depth_m[u] = decision.of_units(units[u], metres_per_unit);
    }
    if (!rule.invalid_units.empty()) {
      for (int u = 0; u < view.width_px; ++u) {
        depth_m[u] = decision.listed(units[u]) ? 0.0F : depth_m[u];
      }
    }
  }
}

}  // namespace depthgrid
