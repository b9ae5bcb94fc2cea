// Colours of pictures and plots.
#pragma once

namespace depthgrid::report {

/// sRGB, each part in [0, 1].
struct Colour {
  double red = 0;
  double green = 0;
  double blue = 0;
  double alpha = 1;
};

inline constexpr Colour kBlack{0.10, 0.10, 0.12};
inline constexpr Colour kWhite{1, 1, 1};
/// Pixels without measurement: a hue that the depth colours do not contain.
inline constexpr Colour kNoMeasurement{0.36, 0.80, 0.82};

/// Colour of a share in [0, 1] (clamped): from pale yellow over orange and magenta to near black, so that lightness
/// falls strictly and the order survives printing in gray. NaN gives kNoMeasurement.
[[nodiscard]] Colour depth_colour(double share) noexcept;

/// Distinct colours for the series of a plot; repeats after eight.
[[nodiscard]] Colour series_colour(unsigned index) noexcept;

}  // namespace depthgrid::report
