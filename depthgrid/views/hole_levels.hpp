// How wide a hole is around a pixel, in steps: what has to be missing so that a disc of some radius may lie there.
// Internal.
#pragma once

#include <cstdint>
#include <vector>

namespace depthgrid::views {

/// A digital shape that is the same above and below its centre: half_px[|dy|] columns to both sides in row dy.
struct DiscRows {
  std::vector<int> half_px;
  [[nodiscard]] int height() const noexcept { return static_cast<int>(half_px.size()) - 1; }
};

/// The pixels (du, dv) with du^2 + dv^2 <= square.
[[nodiscard]] DiscRows disc_rows(int square);

/// What every disc of radius `radius_px`, wherever its centre lies between the pixels, covers at least.
enum class HoleShape : std::uint8_t {
  pixel,   ///< one pixel
  pair,    ///< two neighbours in a row or column
  corner,  ///< three of two by two
  disc,    ///< the digital disc `core` around the pixel nearest to its centre
};

/// If a disc of radius radius_px that touches pixel p (comes within 0.7072 px of its centre) shows no reading, the
/// shape is missing at a place (its centre; for `corner` the upper left of the two by two) within `around` of p.
struct HoleLevel {
  HoleShape shape = HoleShape::pixel;
  double radius_px = 0;
  DiscRows core;
  DiscRows around;
  /// Every disc of this diameter that touches p shows a reading if p does not belong to the next level.
  double width_px = 0;
  int window_px = 0;  ///< that reading lies within so many columns and rows of p
};

/// Levels with rising radii: the first is that of every missing pixel, the last radius is the first of at least
/// widest_px / 2 or the widest that a word of bits allows, and pixels of that level are in a hole too wide to say
/// anything. Neighbouring
/// radii of `core` differ by a factor of at most sqrt(2), from 4 px on by 15 %.
[[nodiscard]] std::vector<HoleLevel> hole_levels(double widest_px);

}  // namespace depthgrid::views
