#include "depthgrid/views/hole_levels.hpp"

#include <cmath>
#include <cstdint>

namespace depthgrid::views {
namespace {

/// Half a pixel's diagonal, rounded up: the greatest distance of a place from the pixel nearest to it.
constexpr double kHalfDiagonal = 0.70711;

/// `around` of the next level reaches no farther than 64 columns.
constexpr double kWidestRadius = 52.0;

int square_below(double radius_px) { return static_cast<int>(std::floor(radius_px * radius_px)); }

/// The next square of a digital disc's radius that is at least `least` and adds pixels.
int next_square(double least) {
  for (int square = std::max(1, static_cast<int>(std::ceil(least)));; ++square) {
    for (int a = 0; a * a <= square; ++a) {
      const int b = static_cast<int>(std::lround(std::sqrt(square - a * a)));
      if (a * a + b * b == square) {
        return square;
      }
    }
  }
}

}  // namespace

DiscRows disc_rows(int square) {
  DiscRows rows;
  for (int dv = 0; dv * dv <= square; ++dv) {
    int half = static_cast<int>(std::sqrt(square - dv * dv));
    while ((half + 1) * (half + 1) + dv * dv <= square) {
      ++half;
    }
    rows.half_px.push_back(half);
  }
  return rows;
}

std::vector<HoleLevel> hole_levels(double widest_px) {
  std::vector<HoleLevel> levels;
  // A place of the disc is at most radius + kHalfDiagonal from p; where its shape stands is at most `off` from that.
  const auto add = [&](HoleShape shape, double radius_px, double off_px, int core) {
    levels.push_back(
        {shape, radius_px, disc_rows(core), disc_rows(square_below(radius_px + kHalfDiagonal + off_px)), 0, 0});
  };
  add(HoleShape::pixel, kHalfDiagonal, kHalfDiagonal, 0);
  // Of a disc around a place (x, y), 0 <= y <= x <= 1/2: (0, 0) and (1, 0), at most 1 away; with radius sqrt(5)/2 also
  // (0, 1). Where the two by two with the disc's centre among them begins no more than 2 away in both directions: a
  // pixel 3 away is 2 from all of it, more than the 1.83 that a disc reaches. So 1.2 are more than enough, and what is
  // around them is no more than around a disc of the next level, as grow() in hole_passes.cpp has to have it.
  add(HoleShape::pair, 1.0, 1.0, 0);
  add(HoleShape::corner, 1.11804, 1.2, 0);
  for (int square = 1;; square = next_square(square * 1.25)) {
    const double radius_px = std::sqrt(square) + kHalfDiagonal;
    add(HoleShape::disc, radius_px, kHalfDiagonal, square);
    if (2 * radius_px >= widest_px || radius_px > kWidestRadius) {
      break;
    }
  }
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    levels[i].width_px = 2 * levels[i + 1].radius_px;
    levels[i].window_px = static_cast<int>(std::floor(levels[i].width_px + kHalfDiagonal));
  }
  return levels;
}

}  // namespace depthgrid::views
