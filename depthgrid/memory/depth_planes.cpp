#include "depthgrid/memory/depth_planes.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/memory/depth_planes.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: they must be seen once for each target.
#include "depthgrid/core/lanes-inl.hpp"

#ifndef DEPTHGRID_MEMORY_DEPTH_PLANES_ONCE
#define DEPTHGRID_MEMORY_DEPTH_PLANES_ONCE
namespace depthgrid::memory {

inline constexpr int kTile = 1 << DepthPlanes::kFirstShift;
/// Nearer than this nothing is asked.
inline constexpr float kNearest_m = 1e-3F;
/// Slopes are fitted to inverse depths up to this: a pixel without a reading should not tilt a whole tile.
inline constexpr float kMostFitted = 4;
/// So many values may be read and written behind the end of a row.
inline constexpr std::size_t kBehind = 64;

/// One row of tiles: kTile rows of inverse depths, of what is free and of what is free or an island, and sums or
/// extrema over each column of it.
struct TileRow {
  const float* near_side;
  const float* far_side;
  std::size_t stride;
  std::size_t columns;
};

/// Of one level.
struct TileArrays {
  float *mean, *right, *down, *most, *least, *nearest, *farthest;
};

struct WindowArrays {
  float *x, *y, *z_near, *z_far, *nearest, *farthest;
};

}  // namespace depthgrid::memory
#endif

HWY_BEFORE_NAMESPACE();
namespace depthgrid::memory::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using lanes::HWY_NAMESPACE::Floats;
using lanes::HWY_NAMESPACE::V;

/// The inverse of a row of depths; behind them the last one again.
void invert(const float* HWY_RESTRICT depths_m, const float* HWY_RESTRICT others_m, std::size_t count, float* to,
            std::size_t columns) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const V nearest = hn::Set(d, kNearest_m);
  std::size_t u = 0;
  for (; u + lanes <= count; u += lanes) {
    V depth = hn::Max(hn::LoadU(d, depths_m + u), nearest);
    if (others_m != nullptr) {
      depth = hn::Max(depth, hn::LoadU(d, others_m + u));
    }
    hn::StoreU(hn::Div(hn::Set(d, 1.0F), depth), d, to + u);
  }
  for (; u < count; ++u) {
    const float depth = std::max(depths_m[u], kNearest_m);
    to[u] = 1 / (others_m != nullptr ? std::max(depth, others_m[u]) : depth);
  }
  std::fill(to + count, to + columns, to[count - 1]);
}

/// Sums over the columns of a row of tiles: of inverse depths, and weighted by their rows.
void add_columns(const TileRow& row, float* HWY_RESTRICT sums, float* HWY_RESTRICT weighted,
                 float* HWY_RESTRICT nearest, float* HWY_RESTRICT farthest) {
  const Floats d;
  const V most = hn::Set(d, kMostFitted);
  for (std::size_t u = 0; u < row.columns; u += hn::Lanes(d)) {
    V sum = hn::Zero(d);
    V moment = hn::Zero(d);
    V high = hn::Zero(d);
    V low = hn::Set(d, 1e30F);
    for (int v = 0; v < kTile; ++v) {
      const std::size_t at = static_cast<std::size_t>(v) * row.stride + u;
      const V exact = hn::LoadU(d, row.near_side + at);
      const V value = hn::Min(exact, most);
      high = hn::Max(high, exact);
      low = hn::Min(low, hn::LoadU(d, row.far_side + at));
      sum = hn::Add(sum, value);
      moment = hn::Add(moment, hn::Mul(value, hn::Set(d, static_cast<float>(v) - 0.5F * (kTile - 1))));
    }
    hn::StoreU(sum, d, sums + u);
    hn::StoreU(moment, d, weighted + u);
    hn::StoreU(high, d, nearest + u);
    hn::StoreU(low, d, farthest + u);
  }
}

/// What is left of the columns beyond a plane, at most and at least.
void bound_columns(const TileRow& row, const float* HWY_RESTRICT first, const float* HWY_RESTRICT down,
                   float* HWY_RESTRICT most, float* HWY_RESTRICT least) {
  const Floats d;
  for (std::size_t u = 0; u < row.columns; u += hn::Lanes(d)) {
    const V step = hn::LoadU(d, down + u);
    V plane = hn::LoadU(d, first + u);
    V high = hn::Set(d, -1e30F);
    V low = hn::Set(d, 1e30F);
    for (std::size_t v = 0; v < static_cast<std::size_t>(kTile); ++v) {
      high = hn::Max(high, hn::Sub(hn::LoadU(d, row.near_side + v * row.stride + u), plane));
      low = hn::Min(low, hn::Sub(hn::LoadU(d, row.far_side + v * row.stride + u), plane));
      plane = hn::Add(plane, step);
    }
    hn::StoreU(high, d, most + u);
    hn::StoreU(low, d, least + u);
  }
}

/// The bounds of a piece of the image from those of one tile in it.
struct Merged {
  V right, down, most, least;
};

HWY_INLINE void merge(const TileArrays& from, std::size_t at, float u, float v, float half, Merged& to) {
  const Floats d;
  const V right = hn::LoadU(d, from.right + at);
  const V down = hn::LoadU(d, from.down + at);
  const V plane = hn::Add(hn::Mul(to.right, hn::Set(d, u)), hn::Mul(to.down, hn::Set(d, v)));
  const V tilt = hn::Mul(hn::Add(hn::Abs(hn::Sub(right, to.right)), hn::Abs(hn::Sub(down, to.down))), hn::Set(d, half));
  to.most = hn::Max(to.most, hn::Add(hn::Sub(hn::LoadU(d, from.most + at), plane), tilt));
  to.least = hn::Min(to.least, hn::Sub(hn::Sub(hn::LoadU(d, from.least + at), plane), tilt));
}

/// The windows whose first tiles are the `count` from `at` on, which lie in row j of a level.
void make_windows(const TileArrays& tiles, const DepthPlanes::Level& level, int j, const PinholeCamera& camera,
                  const WindowArrays& to) {
  const Floats d;
  const auto side = static_cast<float>(1 << level.shift);
  const auto width = static_cast<std::size_t>(level.width);
  const std::size_t first = static_cast<std::size_t>(level.offset) + static_cast<std::size_t>(j) * width;
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  const V by = hn::Set(d, 1 / (20 * side));
  const V v_away = hn::Set(d, static_cast<float>(camera.cy_px) - side * static_cast<float>(j + 2));
  for (std::size_t i = 0; i + DepthPlanes::kTiles <= width; i += hn::Lanes(d)) {
    Merged sum{hn::Zero(d), hn::Zero(d), hn::Set(d, -1e30F), hn::Set(d, 1e30F)};
    V nearest = hn::Zero(d);
    V farthest = hn::Set(d, 1e30F);
    for (std::size_t l = 0; l < 4; ++l) {
      for (std::size_t k = 0; k < 4; ++k) {
        const V mean = hn::LoadU(d, tiles.mean + first + l * width + i + k);
        sum.right = hn::Add(sum.right, hn::Mul(mean, hn::Set(d, static_cast<float>(k) - 1.5F)));
        sum.down = hn::Add(sum.down, hn::Mul(mean, hn::Set(d, static_cast<float>(l) - 1.5F)));
        nearest = hn::Max(nearest, hn::LoadU(d, tiles.nearest + first + l * width + i + k));
        farthest = hn::Min(farthest, hn::LoadU(d, tiles.farthest + first + l * width + i + k));
      }
    }
    sum.right = hn::Mul(sum.right, by);
    sum.down = hn::Mul(sum.down, by);
    for (std::size_t l = 0; l < 4; ++l) {
      for (std::size_t k = 0; k < 4; ++k) {
        merge(tiles, first + l * width + i + k, side * (static_cast<float>(k) - 1.5F),
              side * (static_cast<float>(l) - 1.5F), 0.5F * side, sum);
      }
    }
    const V u_away = hn::Sub(hn::Set(d, static_cast<float>(camera.cx_px)),
                             hn::Mul(hn::Iota(d, static_cast<float>(i + 2)), hn::Set(d, side)));
    const V away = hn::Add(hn::Mul(sum.right, u_away), hn::Mul(sum.down, v_away));
    hn::StoreU(hn::Mul(sum.right, hn::Set(d, fx)), d, to.x + first + i);
    hn::StoreU(hn::Mul(sum.down, hn::Set(d, fy)), d, to.y + first + i);
    hn::StoreU(hn::Add(sum.most, away), d, to.z_near + first + i);
    hn::StoreU(hn::Add(sum.least, away), d, to.z_far + first + i);
    hn::StoreU(nearest, d, to.nearest + first + i);
    hn::StoreU(farthest, d, to.farthest + first + i);
  }
}

}  // namespace depthgrid::memory::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::memory {
namespace {

HWY_EXPORT(invert);
HWY_EXPORT(add_columns);
HWY_EXPORT(bound_columns);
HWY_EXPORT(make_windows);

std::size_t size(int count) noexcept { return static_cast<std::size_t>(count); }

int tiles_along(int pixels) noexcept { return std::max((pixels + kTile - 1) / kTile, DepthPlanes::kTiles); }

/// The tiles of a level from the four below each; at the border the last one again.
void join_tiles(const DepthPlanes::Level& below, const DepthPlanes::Level& level, const TileArrays& tiles) noexcept {
  const auto side = static_cast<float>(1 << below.shift);
  for (int j = 0; j < level.height; ++j) {
    for (int i = 0; i < level.width; ++i) {
      std::array<std::size_t, 4> from{};
      for (std::size_t k = 0; k < 4; ++k) {
        const int x = std::min(2 * i + static_cast<int>(k & 1U), below.width - 1);
        const int y = std::min(2 * j + static_cast<int>(k >> 1U), below.height - 1);
        from[k] = size(below.offset) + size(y) * size(below.width) + size(x);
      }
      const float* mean = tiles.mean;
      const float right = (mean[from[1]] + mean[from[3]] - mean[from[0]] - mean[from[2]]) / (2 * side);
      const float down = (mean[from[2]] + mean[from[3]] - mean[from[0]] - mean[from[1]]) / (2 * side);
      float most = -1e30F;
      float least = 1e30F;
      float nearest = 0;
      float farthest = 1e30F;
      for (std::size_t k = 0; k < 4; ++k) {
        const float plane = 0.5F * side * (((k & 1U) != 0 ? right : -right) + ((k & 2U) != 0 ? down : -down));
        const float tilt =
            0.5F * side * (std::abs(tiles.right[from[k]] - right) + std::abs(tiles.down[from[k]] - down));
        most = std::max(most, tiles.most[from[k]] - plane + tilt);
        least = std::min(least, tiles.least[from[k]] - plane - tilt);
        nearest = std::max(nearest, tiles.nearest[from[k]]);
        farthest = std::min(farthest, tiles.farthest[from[k]]);
      }
      const std::size_t at = size(level.offset) + size(j) * size(level.width) + size(i);
      tiles.mean[at] = 0.25F * (mean[from[0]] + mean[from[1]] + mean[from[2]] + mean[from[3]]);
      tiles.right[at] = right;
      tiles.down[at] = down;
      tiles.most[at] = most;
      tiles.least[at] = least;
      tiles.nearest[at] = nearest;
      tiles.farthest[at] = farthest;
    }
  }
}

}  // namespace

DepthPlanes::DepthPlanes(int width_px, int height_px) {
  lay_out(width_px, height_px);
  const Level& last = levels_[level_count_ - 1];
  const std::size_t count = size(last.offset) + size(last.width) * size(last.height) + kBehind;
  for (AlignedVector<float>* values :
       {&tiles_.mean, &tiles_.right, &tiles_.down, &tiles_.most, &tiles_.least, &tiles_.nearest, &tiles_.farthest, &x_,
        &y_, &z_near_, &z_far_, &nearest_, &farthest_}) {
    values->resize(count);
  }
  rows_.resize((2 * kTile + 8) * (size(levels_[0].width) * kTile + kBehind));
}

/// Until one window has the whole image.
void DepthPlanes::lay_out(int width_px, int height_px) noexcept {
  Level level{0, tiles_along(width_px), tiles_along(height_px), kFirstShift};
  level_count_ = 0;
  while (true) {
    levels_[level_count_++] = level;
    if ((level.width == kTiles && level.height == kTiles) || level_count_ == levels_.size()) {
      break;
    }
    level = {level.offset + level.width * level.height, std::max((level.width + 1) / 2, kTiles),
             std::max((level.height + 1) / 2, kTiles), level.shift + 1};
  }
}

namespace {

constexpr std::size_t kTileColumns = kTile;

/// Rows of one row of tiles: inverse depths of the free space and, from kTile on, of what is free or an island.
using ScratchRows = std::array<float*, 2 * kTile + 8>;

/// The inverse depths of row j of tiles; below the image its last row again.
TileRow invert_rows(const views::PreparedImage& image, int j, const ScratchRows& rows, std::size_t stride,
                    std::size_t columns) noexcept {
  TileRow row{rows[0], rows[0], stride, columns};
  const auto width = size(image.free_m.width_px());
  for (int v = 0; v < kTile; ++v) {
    const int at = std::min(j * kTile + v, image.free_m.height_px() - 1);
    const float* free_m = image.free_m.data() + image.free_m.index(0, at);
    HWY_DYNAMIC_DISPATCH(invert)(free_m, nullptr, width, rows[size(v)], columns);
    if (image.has_islands) {
      const bool islands = !image.island_bands[size(at / views::PreparedImage::kBandRows)].empty();
      row.far_side = rows[kTileColumns];
      HWY_DYNAMIC_DISPATCH(invert)
      (free_m, islands ? image.island_far_m.data() + image.island_far_m.index(0, at) : nullptr, width,
       rows[kTileColumns + size(v)], columns);
    }
  }
  return row;
}

/// The plane through `count` tiles from `begin` on, by least squares of their columns' sums, and its value in each
/// column: at the first row, and the step from row to row.
void fit_tiles(const TileArrays& tiles, std::size_t begin, std::size_t count, const float* sums, const float* moments,
               float* plane, float* steps) noexcept {
  constexpr float kMiddle = 0.5F * (kTile - 1);
  constexpr float kSquares = kTile * kTile * (kTile * kTile - 1) / 12.0F;  ///< of the pixels' places along one axis
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * kTileColumns;
    float sum = 0;
    float right = 0;
    float down = 0;
    for (std::size_t u = 0; u < kTileColumns; ++u) {
      sum += sums[from + u];
      right += sums[from + u] * (static_cast<float>(u) - kMiddle);
      down += moments[from + u];
    }
    const std::size_t at = begin + i;
    tiles.mean[at] = sum / (kTile * kTile);
    tiles.right[at] = right / kSquares;
    tiles.down[at] = down / kSquares;
    for (std::size_t u = 0; u < kTileColumns; ++u) {
      plane[from + u] = tiles.right[at] * (static_cast<float>(u) - kMiddle) - tiles.down[at] * kMiddle;
      steps[from + u] = tiles.down[at];
    }
  }
}

/// How far the values of each tile lie beside its plane, and their extrema, from those of its columns.
void bound_tiles(const TileArrays& tiles, std::size_t begin, std::size_t count, const float* most, const float* least,
                 const float* nearest, const float* farthest) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = begin + i;
    const std::size_t from = i * kTileColumns;
    const std::size_t end = from + kTileColumns;
    const float pixel = 0.5F * (std::abs(tiles.right[at]) + std::abs(tiles.down[at]));
    tiles.most[at] = *std::max_element(most + from, most + end) + pixel;
    tiles.nearest[at] = *std::max_element(nearest + from, nearest + end);
    tiles.farthest[at] = *std::min_element(farthest + from, farthest + end);
    tiles.least[at] = *std::min_element(least + from, least + end) - pixel;
  }
}

}  // namespace

void DepthPlanes::update(const views::PreparedImage& image, const PinholeCamera& camera) noexcept {
  lay_out(image.free_m.width_px(), image.free_m.height_px());
  const Level& first = levels_.front();
  const std::size_t columns = size(first.width) * kTileColumns;
  const std::size_t stride = columns + kBehind;
  ScratchRows rows{};
  for (std::size_t n = 0; n < rows.size(); ++n) {
    rows[n] = &rows_[n * stride];
  }
  float* const* const scratch = rows.data() + 2 * kTileColumns;
  float* const sums = scratch[0];
  float* const moments = scratch[1];
  float* const plane = scratch[2];
  float* const steps = scratch[3];
  float* const most = scratch[4];
  float* const least = scratch[5];
  float* const nearest = scratch[6];
  float* const farthest = scratch[7];
  const TileArrays tiles{tiles_.mean.data(),  tiles_.right.data(),   tiles_.down.data(),    tiles_.most.data(),
                         tiles_.least.data(), tiles_.nearest.data(), tiles_.farthest.data()};
  for (int j = 0; j < first.height; ++j) {
    const TileRow row = invert_rows(image, j, rows, stride, columns);
    const std::size_t begin = size(j) * size(first.width);
    HWY_DYNAMIC_DISPATCH(add_columns)(row, sums, moments, nearest, farthest);
    fit_tiles(tiles, begin, size(first.width), sums, moments, plane, steps);
    HWY_DYNAMIC_DISPATCH(bound_columns)(row, plane, steps, most, least);
    bound_tiles(tiles, begin, size(first.width), most, least, nearest, farthest);
  }
  for (std::size_t n = 0; n < level_count_; ++n) {
    const Level& level = levels_[n];
    if (n > 0) {
      join_tiles(levels_[n - 1], level, tiles);
    }
    for (int j = 0; j + kTiles <= level.height; ++j) {
      HWY_DYNAMIC_DISPATCH(make_windows)
      (tiles, level, j, camera,
       {x_.data(), y_.data(), z_near_.data(), z_far_.data(), nearest_.data(), farthest_.data()});
    }
  }
}

}  // namespace depthgrid::memory
#endif
