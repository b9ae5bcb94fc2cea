// The passes over an image that find how wide the holes in it are, with the widest instructions of the machine at hand.
// Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "depthgrid/core/aligned_vector.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/views/hole_levels.hpp"
#include "depthgrid/views/reading.hpp"

namespace depthgrid::views {

/// Minima over squares of readings: texel (i, j) of level L is that of the pixels [i 2^L, (i + 4) 2^L) x [j 2^L, (j +
/// 4) 2^L) of the image.
struct LeastLevel {
  int width = 0;
  int height = 0;
  AlignedVector<std::uint16_t> texels;
};

/// The first level on which two texels a row cover 2 window_px + 1 columns wherever they begin.
[[nodiscard]] int least_level(int window_px) noexcept;

/// Rows of bits: column u of row v is bit u % 64 of words[v words_per_row + u / 64].
using BitRows = AlignedVector<std::uint64_t>;

/// What the passes find of one image, and their scratch memory. Allocated by the constructor.
struct HoleImage {
  /// Images of floats are read in steps of this.
  static constexpr double kFloatStep = 1.0 / 4096;
  /// Rows of bits are whole multiples of this many words.
  static constexpr std::size_t kWordStep = 8;
  static constexpr int kLeftRows = 8;

  HoleImage(int width_px, int height_px, std::vector<HoleLevel> levels);

  int width_px;
  int height_px;
  std::size_t words_per_row;
  std::vector<HoleLevel> levels;

  BitRows missing;  ///< pixels without a reading
  /// Of pixels that are missing: the highest level whose shape stands around them.
  AlignedVector<std::uint8_t> level;
  /// Of codes less one, so 65535 where there is no reading. As many levels as the widest window needs.
  std::vector<LeastLevel> least;

  // Scratch.
  AlignedVector<std::uint16_t> codes;  ///< 0: no reading; else see Reading, or for floats steps plus one
  AlignedVector<std::uint16_t> row;
  std::vector<BitRows> shrunk;  ///< [h]: pixels with h missing columns to both sides
  BitRows left;                 ///< pixels that have no level yet
  BitRows left_around;          ///< places around which there are some, likewise
  BitRows left_rows;            ///< the same, kLeftRows rows joined to one
  BitRows found;                ///< where a level's shape stands
  BitRows fresh;                ///< one row: found and not found above
  BitRows found_above;          ///< where that of the level above stands
};

/// `depth` has the image's size and a stride.
void find_holes(const Reading& reading, const DepthView& depth, HoleImage& image) noexcept;

}  // namespace depthgrid::views
