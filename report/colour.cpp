#include "report/colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace depthgrid::report {

namespace {

/// Eleven samples of a curve through the Oklab colour space: lightness falls linearly from 0.95 to 0.23 while the hue
/// turns from 100 to -85 degrees; chroma is reduced where sRGB cannot show it.
constexpr std::array<Colour, 11> kDepthColours{{
    {0.999, 0.944, 0.613},
    {0.998, 0.812, 0.467},
    {1.000, 0.667, 0.338},
    {0.995, 0.503, 0.266},
    {0.996, 0.268, 0.263},
    {0.887, 0.075, 0.393},
    {0.723, 0.005, 0.484},
    {0.548, 0.015, 0.526},
    {0.368, 0.070, 0.500},
    {0.206, 0.090, 0.409},
    {0.075, 0.084, 0.269},
}};

constexpr std::array<Colour, 8> kSeriesColours{{
    {0.12, 0.38, 0.70},
    {0.85, 0.33, 0.10},
    {0.13, 0.55, 0.25},
    {0.55, 0.20, 0.60},
    {0.60, 0.45, 0.00},
    {0.00, 0.60, 0.65},
    {0.75, 0.10, 0.30},
    {0.35, 0.35, 0.38},
}};

}  // namespace

Colour depth_colour(double share) noexcept {
  if (std::isnan(share)) {
    return kNoMeasurement;
  }
  const double position = std::clamp(share, 0.0, 1.0) * (kDepthColours.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(position), kDepthColours.size() - 2);
  const double t = position - static_cast<double>(below);
  const Colour& a = kDepthColours[below];
  const Colour& b = kDepthColours[below + 1];
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green), a.blue + t * (b.blue - a.blue)};
}

Colour series_colour(unsigned index) noexcept { return kSeriesColours[index % kSeriesColours.size()]; }

}  // namespace depthgrid::report
