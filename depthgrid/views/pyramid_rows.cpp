#include "depthgrid/views/pyramid_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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
/// What lies behind those rows is read, too, and not used (see PreparedImage::kTexelsBehind).
template <class Extremum>
HWY_INLINE void texel_row(const Extremum& extremum, const float* upper, const float* lower, int width_below,
                          const PixelRange& columns, float* HWY_RESTRICT texels) {
  const Floats d;
  const int n = lanes(d);
  const V neutral = hn::Set(d, Extremum::kNeutral);
  const auto both = [&](int u) HWY_ATTR { return extremum(hn::LoadU(d, upper + u), hn::LoadU(d, lower + u)); };
  const auto inside = [&](int u) HWY_ATTR {
    const int count = std::clamp(width_below - u, 0, n);
    return hn::IfThenElse(hn::FirstN(d, static_cast<std::size_t>(count)), both(u), neutral);
  };
  for (int i = columns.begin; i < columns.end; i += n) {
    const int u = 2 * i;
    const bool whole = u + 2 * n + 4 <= width_below;
    const V left = whole ? extremum(both(u), both(u + 4)) : extremum(inside(u), inside(u + 4));
    const V right = whole ? extremum(both(u + n), both(u + n + 4)) : extremum(inside(u + n), inside(u + n + 4));
    store_some(even_lanes(left, right), d, texels + i, columns.end - i);
  }
}

/// Row j of a level from the level below it.
template <class Extremum>
HWY_INLINE void row_above(const Extremum& extremum, const PyramidLevel& from, const PyramidLevel& to, int j,
                          const PixelRange& columns, float* texels) {
  const float* upper = texels + from.offset + std::ptrdiff_t{2} * j * from.width;
  const float* lower = 2 * j + 4 < from.height ? upper + std::ptrdiff_t{4} * from.width : upper;
  texel_row(extremum, upper, lower, from.width, columns, texels + to.offset + std::ptrdiff_t{j} * to.width);
}

/// Row j of level l is there.
void rows_above(const std::vector<PyramidLevel>& levels, std::size_t l, int j, float* texels) {
  if (l + 1 == levels.size()) {
    return;
  }
  const PyramidLevel& level = levels[l];
  const PyramidLevel& next = levels[l + 1];
  // Row r of the next level needs the rows 2 r and 2 r + 4 of this one; the last two only what there is.
  const auto ready = [](int last_row) { return std::max(last_row / 2 - 1, 0); };
  const int end = j + 1 == level.height ? next.height : ready(j);
  for (int row = ready(j - 1); row < end; ++row) {
    row_above(Smaller(), level, next, row, {0, next.width}, texels);
    rows_above(levels, l + 1, row, texels);
  }
}

void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* texels) {
  rows_above(levels, 0, j, texels);
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

/// What stands in the pyramids of the second interval, a row of texels or of pixels at a time.
class SecondPyramids {
 public:
  HWY_INLINE SecondPyramids(float blind_m, PreparationRows& rows, PreparedImage& image)
      : image_(image), rows_(rows), blind_m_(blind_m), after_blind_m_(std::nextafter(blind_m, kInf)) {}

  HWY_INLINE void run() {
    find_islands();
    const PixelRange* islands = image_.island_texels.data();
    PixelRange* written = image_.second_texels.data();
    for (std::size_t l = 0; l < image_.levels.size(); ++l) {
      const PyramidLevel& level = image_.levels[l];
      const PixelRange tall = rows_with(islands, level.height);
      if (l == 0) {
        first_level(islands, tall);
      } else {
        for (int j = 0; j < level.height; ++j) {
          if (!islands[j].empty()) {
            const PixelRange columns = in_steps(islands[j], level);
            row_above(Larger(), image_.levels[l - 1], level, j, columns, image_.second_near_maxima_m.data());
            row_above(Smaller(), image_.levels[l - 1], level, j, columns, image_.second_far_minima_m.data());
          }
        }
      }
      for (int j = 0; j < level.height; ++j) {
        const PixelRange now = j >= tall.begin && j < tall.end ? around(islands, level, j) : PixelRange{};
        finish_row(level, j, written[j], now, islands[j]);
        written[j] = now;
      }
      islands += level.height;
      written += level.height;
    }
  }

 private:
  static constexpr int kReach = PreparedImage::kSecondReach;
  static constexpr int kStep = FloatColumns::kStep;
  static constexpr std::ptrdiff_t kRowsAhead = 8;

  /// Columns of a level, up to multiples of kStep: whole vectors are quicker than parts.
  [[nodiscard]] static HWY_INLINE PixelRange in_steps(const PixelRange& columns, const PyramidLevel& level) {
    return {columns.begin / kStep * kStep, std::min((columns.end + kStep - 1) / kStep * kStep, level.width)};
  }

  /// Which texels may cover islands. The columns of a row of pixels are known to the length of this instruction set's
  /// vectors only, so they are taken to multiples of the longest.
  HWY_INLINE void find_islands() {
    PixelRange* islands = image_.island_texels.data();
    const PyramidLevel& first = image_.levels[0];
    for (int j = 0; j < first.height; ++j) {
      PixelRange columns;
      for (int v = j; v < std::min(j + 4, first.height); ++v) {
        columns = joined(columns, image_.island_columns[static_cast<std::size_t>(v)]);
      }
      islands[j] = columns.empty() ? columns
                                   : PixelRange{std::max(columns.begin / kStep * kStep - 3, 0),
                                                std::min((columns.end + kStep - 1) / kStep * kStep, first.width)};
    }
    for (std::size_t l = 1; l < image_.levels.size(); ++l) {
      const PyramidLevel& below = image_.levels[l - 1];
      PixelRange* above = islands + below.height;
      for (int j = 0; j < image_.levels[l].height; ++j) {
        // Columns 2 i and 2 i + 4 of the rows 2 j and 2 j + 4.
        const PixelRange columns = joined(islands[std::ptrdiff_t{2} * j],
                                          2 * j + 4 < below.height ? islands[std::ptrdiff_t{2} * j + 4] : PixelRange{});
        above[j] =
            columns.empty() ? columns : PixelRange{(std::max(columns.begin - 4, 0) + 1) / 2, (columns.end + 1) / 2};
      }
      islands = above;
    }
  }

  /// Rows from which one with islands can be reached.
  [[nodiscard]] static HWY_INLINE PixelRange rows_with(const PixelRange* islands, int height) {
    PixelRange rows;
    for (int j = 0; j < height; ++j) {
      if (!islands[j].empty()) {
        rows = joined(rows, {j, j + 1});
      }
    }
    return rows.empty() ? rows : PixelRange{std::max(rows.begin - kReach, 0), std::min(rows.end + kReach, height)};
  }

  [[nodiscard]] static HWY_INLINE PixelRange around(const PixelRange* islands, const PyramidLevel& level, int j) {
    PixelRange columns;
    for (int row = std::max(j - kReach, 0); row <= std::min(j + kReach, level.height - 1); ++row) {
      columns = joined(columns, islands[row]);
    }
    return columns.empty() ? columns : in_steps({std::max(columns.begin - kReach, 0), columns.end + kReach}, level);
  }

  /// What lies beside `islands`: as if no texel covered islands. Overwrites what stands there.
  HWY_INLINE void finish_row(const PyramidLevel& level, int j, const PixelRange& old, const PixelRange& now,
                             const PixelRange& islands) {
    const std::ptrdiff_t offset = level.offset + std::ptrdiff_t{j} * level.width;
    float* near_m = image_.second_near_maxima_m.data() + offset;
    float* far_m = image_.second_far_minima_m.data() + offset;
    clear_row(old, now, Smaller::kNeutral, near_m);
    clear_row(old, now, Larger::kNeutral, far_m);
    const Floats d;
    const V after_blind = hn::Set(d, after_blind_m_);
    const float* minima_m = image_.minima_m.data() + offset;
    const auto without = [&](const PixelRange& columns) HWY_ATTR {
      for_columns(columns, lanes(d), [&](int i, const auto& part) HWY_ATTR {
        part.store(after_blind, d, near_m + i);
        part.store(part.load(d, minima_m + i, 0.0F), d, far_m + i);
      });
    };
    if (now.empty()) {
      return;
    }
    without({now.begin, islands.empty() ? now.end : islands.begin});
    if (!islands.empty()) {
      without({islands.end, now.end});
    }
  }

  /// One row of pixels, for windows of four columns.
  HWY_INLINE void pixel_intervals(int v, const PixelRange& columns) {
    const Floats d;
    const int width_px = image_.levels[0].width;
    const float* island_near_m = pixel_row(image_.island_near_m.data(), width_px, v);
    const float* island_far_m = pixel_row(image_.island_far_m.data(), width_px, v);
    const float* free_m = pixel_row(image_.free_m.data(), width_px, v);
    float* near_m = rows_.second_m(v, false);
    float* far_m = rows_.second_m(v, true);
    const V blind = hn::Set(d, blind_m_);
    const V after_blind = hn::Set(d, after_blind_m_);
    const PixelRange read{columns.begin, std::min(columns.end + kStep, width_px)};
    const float* second_near_m = pixel_row(image_.second_near_maxima_m.data(), width_px, v);
    const float* second_far_m = pixel_row(image_.second_far_minima_m.data(), width_px, v);
    const std::ptrdiff_t ahead_bytes = kRowsAhead * std::ptrdiff_t{width_px} * std::ptrdiff_t{sizeof(float)};
    for_columns(read, lanes(d), [&](int u, const auto& part) HWY_ATTR {
      // These few columns of every row lie far from each other: nothing else brings them near.
      ask_for(second_near_m + u, ahead_bytes);
      ask_for(second_far_m + u, ahead_bytes);
      ask_for(island_near_m + u, ahead_bytes);
      ask_for(island_far_m + u, ahead_bytes);
      ask_for(free_m + u, ahead_bytes);
      const V near = part.load(d, island_near_m + u, kInf);
      const V far = part.load(d, island_far_m + u, -kInf);
      const V free = part.load(d, free_m + u, 0.0F);
      // An island that ends in the blind zone does not meet what is free beyond it: the one or the other.
      const M island = hn::And(hn::Le(near, far), hn::Or(hn::Ge(far, blind), hn::Lt(free, far)));
      part.store(hn::IfThenElse(island, near, after_blind), d, near_m + u);
      part.store(hn::IfThenElse(island, hn::Max(far, free), free), d, far_m + u);
    });
  }

  template <class Extremum>
  HWY_INLINE void texels_of_windows(const Extremum& extremum, int j, const PixelRange& columns, bool far,
                                    float* texels) {
    const Floats d;
    const PyramidLevel& level = image_.levels[0];
    const int end = std::min(j + 4, level.height);
    float* row_m = texels + std::ptrdiff_t{j} * level.width;
    for_columns(columns, lanes(d), [&](int u, const auto& part) HWY_ATTR {
      V best = hn::LoadU(d, rows_.second_window_m(j, far) + u);
      for (int v = j + 1; v < end; ++v) {
        best = extremum(best, hn::LoadU(d, rows_.second_window_m(v, far) + u));
      }
      part.store(best, d, row_m + u);
    });
  }

  /// Columns of the texels that a row of pixels belongs to.
  [[nodiscard]] HWY_INLINE PixelRange pixel_columns(const PixelRange* islands, int v) const {
    PixelRange columns;
    for (int j = std::max(v - 3, 0); j <= v; ++j) {
      columns = joined(columns, islands[j]);
    }
    return columns.empty() ? columns : in_steps(columns, image_.levels[0]);
  }

  /// A few rows in each pass: one that reads what the one before has just written, but at other columns, waits until it
  /// has reached the cache.
  HWY_INLINE void first_level(const PixelRange* islands, const PixelRange& tall) {
    constexpr int kRows = PreparationRows::kSecondRows;
    const int height = image_.levels[0].height;
    // Rows of texels lag behind by three.
    for (int v = tall.begin; v < std::min(tall.end, height) + 3; v += kRows) {
      const int end = std::min(v + kRows, height);
      std::array<PixelRange, kRows> columns;
      for (int row = v; row < end; ++row) {
        columns[row - v] = pixel_columns(islands, row);
        pixel_intervals(row, columns[row - v]);
      }
      for (int row = v; row < end; ++row) {
        window_row(Larger(), rows_.second_m(row, false), image_.levels[0].width, columns[row - v],
                   rows_.second_window_m(row, false));
        window_row(Smaller(), rows_.second_m(row, true), image_.levels[0].width, columns[row - v],
                   rows_.second_window_m(row, true));
      }
      for (int j = std::max(v - 3, 0); j < std::min(v + kRows - 3, height); ++j) {
        if (!islands[j].empty()) {
          const PixelRange whole = in_steps(islands[j], image_.levels[0]);
          texels_of_windows(Larger(), j, whole, false, image_.second_near_maxima_m.data());
          texels_of_windows(Smaller(), j, whole, true, image_.second_far_minima_m.data());
        }
      }
    }
  }

  PreparedImage& image_;
  PreparationRows& rows_;
  float blind_m_;
  float after_blind_m_;
};

void build_second_pyramids(float blind_m, PreparationRows& rows, PreparedImage& image) {
  SecondPyramids(blind_m, rows, image).run();
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::views {

HWY_EXPORT(minimum_rows_above);
HWY_EXPORT(build_second_pyramids);

void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* texels) noexcept {
  HWY_DYNAMIC_DISPATCH(minimum_rows_above)(levels, j, texels);
}

void build_second_pyramids(float blind_m, PreparationRows& rows, PreparedImage& image) noexcept {
  HWY_DYNAMIC_DISPATCH(build_second_pyramids)(blind_m, rows, image);
}

}  // namespace depthgrid::views
#endif
