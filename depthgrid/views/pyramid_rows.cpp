#include "depthgrid/views/pyramid_rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/views/pyramid_rows.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: seen once for each target.
#include <hwy/highway.h>

#include "depthgrid/views/vector_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {

/// Every second value of two vectors one behind the other.
HWY_INLINE V even_lanes(V left, [[maybe_unused]] V right) {
#if HWY_TARGET == HWY_SCALAR
  return left;
#else
  return hn::ConcatEven(Floats(), right, left);
#endif
}

/// Texels of one row of a level from 1 on: the extremum of the columns 2 i and 2 i + 4 of two rows of the level below.
template <class Extremum>
HWY_INLINE void texel_row(const Extremum& extremum, const float* upper, const float* lower, int width_below,
                          const PixelRange& columns, float* halves, float* texels) {
  const Floats d;
  const int n = lanes(d);
  // halves[i - begin]: the columns 2 i of both rows.
  float* half = halves;
  int u = 2 * columns.begin;
  const int end = std::min(2 * columns.end + 4, width_below);
  for (; u + 2 * n <= std::min(end, width_below); u += 2 * n, half += n) {
    const V left = extremum(hn::LoadU(d, upper + u), hn::LoadU(d, lower + u));
    const V right = extremum(hn::LoadU(d, upper + u + n), hn::LoadU(d, lower + u + n));
    hn::StoreU(even_lanes(left, right), d, half);
  }
  for (; u < end; u += 2 * n, half += n) {
    const int count = width_below - u;
    const V left = extremum(load_some(d, upper + u, count, Extremum::kNeutral),
                            load_some(d, lower + u, count, Extremum::kNeutral));
    const V right = extremum(load_some(d, upper + u + n, count - n, Extremum::kNeutral),
                             load_some(d, lower + u + n, count - n, Extremum::kNeutral));
    hn::StoreU(even_lanes(left, right), d, half);
  }
  std::fill_n(half, 2, Extremum::kNeutral);
  for_columns(columns, n, [&](int i, const auto& part) HWY_ATTR {
    const float* from = halves + (i - columns.begin);
    part.store(extremum(hn::LoadU(d, from), hn::LoadU(d, from + 2)), d, texels + i);
  });
}

/// Row j of a level from the level below it.
template <class Extremum>
HWY_INLINE void row_above(const Extremum& extremum, const PyramidLevel& from, const PyramidLevel& to, int j,
                          const PixelRange& columns, float* scratch, float* texels) {
  const float* upper = texels + from.offset + std::ptrdiff_t{2} * j * from.width;
  const float* lower = 2 * j + 4 < from.height ? upper + std::ptrdiff_t{4} * from.width : upper;
  texel_row(extremum, upper, lower, from.width, columns, scratch, texels + to.offset + std::ptrdiff_t{j} * to.width);
}

/// Row j of level l is there.
void rows_above(const std::vector<PyramidLevel>& levels, std::size_t l, int j, float* scratch, float* texels) {
  if (l + 1 == levels.size()) {
    return;
  }
  const PyramidLevel& level = levels[l];
  const PyramidLevel& next = levels[l + 1];
  // Row r of the next level needs the rows 2 r and 2 r + 4 of this one; the last two only what there is.
  const auto ready = [](int last_row) { return std::max(last_row / 2 - 1, 0); };
  const int end = j + 1 == level.height ? next.height : ready(j);
  for (int row = ready(j - 1); row < end; ++row) {
    row_above(Smaller(), level, next, row, {0, next.width}, scratch, texels);
    rows_above(levels, l + 1, row, scratch, texels);
  }
}

void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* scratch, float* texels) {
  rows_above(levels, 0, j, scratch, texels);
}

/// Row j of level 0 from the image: the extremum of four by four pixels.
template <class Extremum>
HWY_INLINE void first_row(const Extremum& extremum, const float* image, const PyramidLevel& level, int j,
                          const PixelRange& columns, float* scratch, float* texels) {
  const Floats d;
  const int width_px = level.width;
  const float* image_row = image + std::ptrdiff_t{j} * width_px;
  const int row_count = std::min(4, level.height - j);
  for (int u = columns.begin; u < std::min(columns.end + 3, width_px); u += lanes(d)) {
    V best = load_some(d, image_row + u, width_px - u, Extremum::kNeutral);
    for (int row = 1; row < row_count; ++row) {
      best = extremum(best,
                      load_some(d, image_row + std::ptrdiff_t{row} * width_px + u, width_px - u, Extremum::kNeutral));
    }
    hn::StoreU(best, d, scratch + u);
  }
  window_row(extremum, scratch, width_px, columns, texels + level.offset + std::ptrdiff_t{j} * width_px);
}

/// Texels that cover only columns of this range: those from `step` i to `step` i + 3 or so, as far as there are
/// columns.
HWY_INLINE PixelRange texels_within(const PixelRange& columns, int step, int extent, int width) {
  if (columns.empty()) {
    return {};
  }
  const PixelRange texels{(columns.begin + step - 1) / step,
                          columns.end == width ? (width + step - 1) / step : (columns.end - 1 - extent + step) / step};
  return texels.empty() ? PixelRange{} : texels;
}

/// "None" where the row holds something that will not be written.
HWY_INLINE void clear_row(const PixelRange& old, const PixelRange& now, float value, float* row) {
  if (old.empty()) {
    return;
  }
  const PixelRange kept = common(old, now);
  std::fill(row + old.begin, row + (kept.empty() ? old.end : kept.begin), value);
  if (!kept.empty()) {
    std::fill(row + kept.end, row + old.end, value);
  }
}

/// Texels of row j that may hold islands: those that cover islands only, in the rows of the image (level 0) or of the
/// level below, of which we know the columns that have some.
HWY_INLINE PixelRange island_texels(bool from_image, int j, const PyramidLevel& below,
                                    const PixelRange* below_columns) {
  const int step = from_image ? 1 : 2;
  const int extent = from_image ? 3 : 4;
  const int first = step * j;
  PixelRange all = below_columns[first];
  for (int row = first; row < std::min(first + extent + 1, below.height); row += from_image ? 1 : 4) {
    all = common(all, below_columns[row]);
  }
  return texels_within(all, step, extent, below.width);
}

void build_island_pyramids(PreparedImage& image, float* scratch) {
  const std::vector<PyramidLevel>& levels = image.levels;
  const float* near_m = image.island_near_m.data();
  const float* far_m = image.island_far_m.data();
  float* near_maxima_m = image.island_near_maxima_m.data();
  float* far_minima_m = image.island_far_minima_m.data();
  const PixelRange* below_columns = image.island_columns.data();
  PixelRange* columns = image.island_texels.data();
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const PyramidLevel& level = levels[l];
    const PyramidLevel& below = levels[l == 0 ? 0 : l - 1];
    for (int j = 0; j < level.height; ++j) {
      const PixelRange now = island_texels(l == 0, j, below, below_columns);
      const std::ptrdiff_t offset = level.offset + std::ptrdiff_t{j} * level.width;
      clear_row(columns[j], now, Smaller::kNeutral, near_maxima_m + offset);
      clear_row(columns[j], now, Larger::kNeutral, far_minima_m + offset);
      columns[j] = now;
      if (now.empty()) {
        continue;
      }
      if (l == 0) {
        first_row(Larger(), near_m, level, j, now, scratch, near_maxima_m);
        first_row(Smaller(), far_m, level, j, now, scratch, far_minima_m);
      } else {
        row_above(Larger(), below, level, j, now, scratch, near_maxima_m);
        row_above(Smaller(), below, level, j, now, scratch, far_minima_m);
      }
    }
    below_columns = columns;
    columns += level.height;
  }
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::views {

HWY_EXPORT(minimum_rows_above);
HWY_EXPORT(build_island_pyramids);

void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* scratch, float* texels) noexcept {
  HWY_DYNAMIC_DISPATCH(minimum_rows_above)(levels, j, scratch, texels);
}

void build_island_pyramids(PreparedImage& image, float* scratch) noexcept {
  HWY_DYNAMIC_DISPATCH(build_island_pyramids)(image, scratch);
}

}  // namespace depthgrid::views
#endif
