#include "depthgrid/search/pyramid_rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/pyramid_rows.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: seen once for each target.
#include <hwy/highway.h>

#include "depthgrid/search/vector_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::HWY_NAMESPACE {

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
    const float* upper = texels + level.offset + std::ptrdiff_t{2} * row * level.width;
    const float* lower = 2 * row + 4 < level.height ? upper + std::ptrdiff_t{4} * level.width : upper;
    texel_row(Smaller(), upper, lower, level.width, {0, next.width}, scratch,
              texels + next.offset + std::ptrdiff_t{row} * next.width);
    rows_above(levels, l + 1, row, scratch, texels);
  }
}

void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* scratch, float* texels) {
  rows_above(levels, 0, j, scratch, texels);
}

/// One row of level 0: the extremum of four by four pixels.
template <class Extremum>
HWY_INLINE void first_row(const Extremum& extremum, const float* image_row, int row_count, int width_px,
                          const PixelRange& columns, float* scratch, float* texels) {
  const Floats d;
  for (int u = columns.begin; u < std::min(columns.end + 3, width_px); u += lanes(d)) {
    V best = load_some(d, image_row + u, width_px - u, Extremum::kNeutral);
    for (int row = 1; row < row_count; ++row) {
      best = extremum(best,
                      load_some(d, image_row + std::ptrdiff_t{row} * width_px + u, width_px - u, Extremum::kNeutral));
    }
    hn::StoreU(best, d, scratch + u);
  }
  window_row(extremum, scratch, width_px, columns, texels);
}

/// Texels that cover only columns of this range: those from `step` i to `step` i + 3 or so, as far as there are
/// columns.
HWY_INLINE PixelRange texels_within(const PixelRange& columns, int step, int reach, int width) {
  const PixelRange texels{(columns.begin + step - 1) / step,
                          columns.end == width ? (width + step - 1) / step : (columns.end - 1 - reach + step) / step};
  return columns.empty() || texels.empty() ? PixelRange{} : texels;
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

void build_island_pyramids(const std::vector<PyramidLevel>& levels, const float* near_m, const float* far_m,
                           const std::vector<PixelRange>& image_columns, float* scratch, float* near_maxima_m,
                           float* far_minima_m, std::vector<PixelRange>& texel_columns) {
  const PixelRange* below_columns = image_columns.data();
  PixelRange* columns = texel_columns.data();
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const PyramidLevel& level = levels[l];
    const PyramidLevel& below = levels[l == 0 ? 0 : l - 1];
    for (int j = 0; j < level.height; ++j) {
      // A texel is an island only if all that it covers is: its rows have islands in all of its columns.
      const int first = l == 0 ? j : 2 * j;
      const int end = std::min(first + (l == 0 ? 4 : 5), below.height);
      PixelRange all = below_columns[first];
      for (int row = first; row < end; row += l == 0 ? 1 : 4) {
        all = common(all, below_columns[row]);
      }
      const PixelRange now = l == 0 ? texels_within(all, 1, 3, below.width) : texels_within(all, 2, 4, below.width);
      const std::ptrdiff_t offset = level.offset + std::ptrdiff_t{j} * level.width;
      clear_row(columns[j], now, Smaller::kNeutral, near_maxima_m + offset);
      clear_row(columns[j], now, Larger::kNeutral, far_minima_m + offset);
      columns[j] = now;
      if (now.empty()) {
        continue;
      }
      const std::ptrdiff_t below_offset = (l == 0 ? 0 : below.offset) + std::ptrdiff_t{first} * below.width;
      if (l == 0) {
        first_row(Larger(), near_m + below_offset, end - first, level.width, now, scratch, near_maxima_m + offset);
        first_row(Smaller(), far_m + below_offset, end - first, level.width, now, scratch, far_minima_m + offset);
        continue;
      }
      const std::ptrdiff_t lower = first + 4 < below.height ? std::ptrdiff_t{4} * below.width : 0;
      const float* near_below = near_maxima_m + below_offset;
      const float* far_below = far_minima_m + below_offset;
      texel_row(Larger(), near_below, near_below + lower, below.width, now, scratch, near_maxima_m + offset);
      texel_row(Smaller(), far_below, far_below + lower, below.width, now, scratch, far_minima_m + offset);
    }
    below_columns = columns;
    columns += level.height;
  }
}

}  // namespace depthgrid::search::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::search {

HWY_EXPORT(minimum_rows_above);
HWY_EXPORT(build_island_pyramids);

void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* scratch, float* texels) noexcept {
  HWY_DYNAMIC_DISPATCH(minimum_rows_above)(levels, j, scratch, texels);
}

void build_island_pyramids(const std::vector<PyramidLevel>& levels, const float* near_m, const float* far_m,
                           const std::vector<PixelRange>& image_columns, float* scratch, float* near_maxima_m,
                           float* far_minima_m, std::vector<PixelRange>& texel_columns) noexcept {
  HWY_DYNAMIC_DISPATCH(build_island_pyramids)
  (levels, near_m, far_m, image_columns, scratch, near_maxima_m, far_minima_m, texel_columns);
}

std::size_t row_count(const std::vector<PyramidLevel>& levels) noexcept {
  std::size_t count = 0;
  for (const PyramidLevel& level : levels) {
    count += static_cast<std::size_t>(level.height);
  }
  return count;
}

}  // namespace depthgrid::search
#endif
