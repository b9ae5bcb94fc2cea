// What the search reads of a View: free depths, the robot's islands, and the pyramids over them. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "depthgrid/core/aligned_vector.hpp"
#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/views/pixel_range.hpp"
#include "depthgrid/views/view.hpp"

namespace depthgrid::views {

/// Overlapping extrema of an image: texel (i, j) of level L covers the pixels [i 2^L, (i + 4) 2^L) x
/// [j 2^L, (j + 4) 2^L) of the image. So a rectangle of pixels whose last and first texel columns (pixel >> L) differ
/// by at most 7, and its rows likewise, is covered by four texels, each side with less than 2^L pixels too many.
struct PyramidLevel {
  std::uint32_t offset = 0;  ///< of its first texel in the pyramid's buffer
  std::int32_t width = 0;
  std::int32_t height = 0;
};

/// Texel columns (or rows) that four texels can cover. On the last level, the first such, the whole image spans at most
/// so many.
inline constexpr int kPyramidSpan = 8;

/// Buffers are allocated by the constructor. Images and pyramids are dense.
struct PreparedImage {
  PreparedImage(int width_px, int height_px);

  /// Nothing is measured or free.
  void clear() noexcept;
  /// Makes island images and columns "none", where the frame before left something.
  void clear_islands() noexcept;
  /// island_bands from island_columns.
  void join_island_bands() noexcept;

  AlignedVector<std::byte> kept;  ///< the values as they came
  /// A pixel's frustum is free between the blind zone and this depth: g, and where the pixel's robot interval
  /// [near, far] begins at or before g and ends behind it, that far end (what lies in the interval is the robot).
  /// Never above the exact g, and below it by less than 2^-20 of the depths that it is made of (1 um a metre).
  DepthImage free_m;
  std::vector<PyramidLevel> levels;
  AlignedVector<float> minima_m;  ///< of free_m, all levels
  /// Behind the texels of each pyramid there are so many values more, so that whole vectors may be read.
  static constexpr std::size_t kTexelsBehind = 64;

  /// True when some pixel has a robot interval that free_m does not hold wholly: it begins beyond the free depth
  /// (something stands before the robot, or nothing was measured there) or in the blind zone. Such an interval is an
  /// island that is not an obstacle to this camera. Else the rest is not up to date.
  bool has_islands = false;
  DepthImage island_near_m, island_far_m;  ///< per pixel; (+inf, -inf) where there is none
  /// Every pixel has a second interval [near, far) without obstacles: its island, joined with what is free where the
  /// two meet; without an island what is free. Largest `near` and smallest `far` of what a texel covers, all levels.
  /// (+inf, -inf) in texels that are farther than kSecondReach texels of their level from those with islands: there
  /// the second interval says no more than free_m.
  AlignedVector<float> second_near_maxima_m, second_far_minima_m;
  /// Texels that are looked up together lie no farther apart.
  static constexpr int kSecondReach = kPyramidSpan / 2;
  /// The columns outside of which each kBandRows rows have no islands.
  static constexpr int kBandRows = 8;
  std::vector<PixelRange> island_bands;

  /// RobotView's, the first kMostLinks of them, and what its readings are.
  static constexpr std::size_t kMostLinks = 128;
  std::vector<Capsule> links_world;
  bool within_margin = false;

  // What only the next update reads.
  std::vector<PixelRange> island_columns;  ///< where a row of the island images may differ from "none"
  std::vector<PixelRange> second_texels;   ///< the same of all rows of the second interval's pyramids, level by level
  std::vector<PixelRange> island_texels;   ///< in each of these rows, texels that may cover islands
};

[[nodiscard]] inline const PreparedImage& prepared(const View& view) noexcept { return *view.image_; }

}  // namespace depthgrid::views
