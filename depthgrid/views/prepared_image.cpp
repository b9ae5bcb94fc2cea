#include "depthgrid/views/prepared_image.hpp"

#include <algorithm>
#include <limits>

#include "depthgrid/views/preparation_rows.hpp"

namespace depthgrid::views {
namespace {

constexpr float kNoNear = std::numeric_limits<float>::infinity();
constexpr float kNoFar = -std::numeric_limits<float>::infinity();

std::size_t pixel_count(const DepthImage& image) noexcept { return image.index(0, image.height_px()); }

}  // namespace

PreparedImage::PreparedImage(int width_px, int height_px)
    : free_m(width_px, height_px),
      island_near_m(free_m),
      island_far_m(free_m),
      island_bands(static_cast<std::size_t>((height_px + kBandRows - 1) / kBandRows)),
      island_columns(static_cast<std::size_t>(height_px)) {
  std::size_t texels = 0;
  std::size_t rows = 0;
  for (int size = 1; levels.empty() || std::max(levels.back().width, levels.back().height) > kPyramidSpan; size *= 2) {
    levels.push_back({static_cast<std::uint32_t>(texels), (width_px + size - 1) / size, (height_px + size - 1) / size});
    texels += static_cast<std::size_t>(levels.back().width) * static_cast<std::size_t>(levels.back().height);
    rows += static_cast<std::size_t>(levels.back().height);
  }
  kept.resize(pixel_count(free_m) * sizeof(float));
  texels += kTexelsBehind;
  minima_m.resize(texels);
  std::fill_n(island_near_m.data(), pixel_count(free_m), kNoNear);
  std::fill_n(island_far_m.data(), pixel_count(free_m), kNoFar);
  second_near_maxima_m.assign(texels, kNoNear);
  second_far_minima_m.assign(texels, kNoFar);
  links_world.reserve(kMostLinks);
  second_texels.resize(rows);
  island_texels.resize(rows);
}

void PreparedImage::clear() noexcept {
  has_islands = false;
  links_world.clear();
  std::fill_n(free_m.data(), pixel_count(free_m), 0.0F);
  std::fill(minima_m.begin(), minima_m.end(), 0.0F);
}

void PreparedImage::clear_islands() noexcept {
  for (int v = 0; v < free_m.height_px(); ++v) {
    PixelRange& columns = island_columns[static_cast<std::size_t>(v)];
    if (!columns.empty()) {
      const std::size_t first = free_m.index(columns.begin, v);
      std::fill_n(island_near_m.data() + first, columns.end - columns.begin, kNoNear);
      std::fill_n(island_far_m.data() + first, columns.end - columns.begin, kNoFar);
      columns = {};
    }
  }
}

/// Bands begin and end at multiples of the longest vector: the columns of a row are only known to the length of this
/// instruction set's.
void PreparedImage::join_island_bands() noexcept {
  constexpr int kStep = FloatColumns::kStep;
  std::fill(island_bands.begin(), island_bands.end(), PixelRange{});
  for (int v = 0; v < free_m.height_px(); ++v) {
    const PixelRange& columns = island_columns[static_cast<std::size_t>(v)];
    if (!columns.empty()) {
      PixelRange& band = island_bands[static_cast<std::size_t>(v / kBandRows)];
      band = joined(band, {columns.begin / kStep * kStep, (columns.end + kStep - 1) / kStep * kStep});
    }
  }
}

}  // namespace depthgrid::views
