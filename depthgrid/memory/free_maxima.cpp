#include "depthgrid/memory/free_maxima.hpp"

#include <algorithm>

namespace depthgrid::memory {
namespace {

constexpr int kFirstShift = 2;

std::size_t size(int count) noexcept { return static_cast<std::size_t>(count); }

/// Adds a row of pixels to the texels over it, four a texel.
void add_row(const float* pixels_m, int width_px, float* texels_m) noexcept {
  for (int u = 0; u < width_px; ++u) {
    texels_m[u >> kFirstShift] = std::max(texels_m[u >> kFirstShift], pixels_m[u]);
  }
}

}  // namespace

FreeMaxima::FreeMaxima(int width_px, int height_px) {
  lay_out(width_px, height_px);
  const Level& last = levels_.back();
  texels_m_.resize(size(last.offset) + size(last.width) * size(last.height));
}

void FreeMaxima::lay_out(int width_px, int height_px) noexcept {
  std::int32_t offset = 0;
  std::int32_t shift = kFirstShift;
  for (Level& level : levels_) {
    const std::int32_t side = std::int32_t{1} << shift;
    level = {offset, (width_px + side - 1) >> shift, (height_px + side - 1) >> shift, shift};
    offset += level.width * level.height;
    ++shift;
  }
}

void FreeMaxima::update(const views::PreparedImage& image) noexcept {
  const int width_px = image.free_m.width_px();
  const int height_px = image.free_m.height_px();
  lay_out(width_px, height_px);
  const Level& first = levels_.front();
  std::fill_n(texels_m_.begin(), size(first.width) * size(first.height), 0.0F);
  for (int v = 0; v < height_px; ++v) {
    float* texels_m = &texels_m_[size(v >> kFirstShift) * size(first.width)];
    add_row(image.free_m.data() + image.free_m.index(0, v), width_px, texels_m);
    if (image.has_islands && !image.island_bands[size(v / views::PreparedImage::kBandRows)].empty()) {
      add_row(image.island_far_m.data() + image.island_far_m.index(0, v), width_px, texels_m);
    }
  }
  for (int n = 1; n < kLevels; ++n) {
    const Level& below = levels_[size(n - 1)];
    const Level& level = levels_[size(n)];
    for (int j = 0; j < level.height; ++j) {
      for (int i = 0; i < level.width; ++i) {
        const int right = std::min(2 * i + 1, below.width - 1);
        const int lower = std::min(2 * j + 1, below.height - 1);
        const float* from = &texels_m_[size(below.offset)];
        const auto at = [&](int x, int y) { return from[size(y) * size(below.width) + size(x)]; };
        texels_m_[size(level.offset) + size(j) * size(level.width) + size(i)] =
            std::max(std::max(at(2 * i, 2 * j), at(right, 2 * j)), std::max(at(2 * i, lower), at(right, lower)));
      }
    }
  }
}

}  // namespace depthgrid::memory
