#include "depthgrid/views/ball_scan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/views/ball_scan.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: it must be seen once for each target.
#include "depthgrid/core/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {
using namespace lanes::HWY_NAMESPACE;
constexpr float kNever = -1e30F;
/// A window of at most so many pixels a side is looked at pixel by pixel; larger ones by blocks first.
constexpr int kFewPixels = 64;
constexpr int kFewBlocks = 10;
/// Columns, and rows, that share vectors.
constexpr int kFew = 8;
using FewLanes = hn::CappedTag<float, kFew>;

/// Bit i of the result: lane i.
HWY_INLINE std::uint32_t few_bits_of(hn::Mask<FewLanes> mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(FewLanes(), mask, bytes.data());
  return bytes[0];
}

/// Columns (or rows) of pixels or of blocks, one an element: the plane through the camera's centre and the border on
/// the ball's side. n is its normal towards the column.
struct Sides {
  static constexpr std::size_t kRoom = kMaxScanned + 16;
  alignas(64) std::array<float, kRoom> distance_m;  ///< of the ball's centre from the plane; not positive: inside
  alignas(64) std::array<float, kRoom> slant;       ///< n.z
  alignas(64) std::array<float, kRoom> deepest_m;   ///< nothing of the ball is deeper there; kNever: it is not there
  alignas(64) std::array<float, kRoom> nearest_m;   ///< nor less deep than this
};

/// Columns (or rows) of one axis of the image: the ball's centre on that axis, and where they begin.
struct Lines {
  V across_m;
  V per_focal;  ///< 1 / f
  V step;       ///< how many pixels one of them is wide, over f
  V size_px;
  V centre_px;
};

HWY_INLINE Lines lines_of(float across_m, float focal_px, float centre_px, int size) {
  const Floats d;
  return {hn::Set(d, across_m), hn::Set(d, 1.0F / focal_px), hn::Set(d, static_cast<float>(size) / focal_px),
          hn::Set(d, static_cast<float>(size)), hn::Set(d, centre_px)};
}

/// One vector of columns, whose numbers are in `column`, to the place `at` of sides.
HWY_INLINE void measure_vector(const Lines& lines, V column, V z, V radius, std::size_t at, Sides& sides) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0F);
  const V x = lines.across_m;
  const V low = hn::Mul(hn::Sub(hn::Mul(column, lines.size_px), lines.centre_px), lines.per_focal);
  const M beyond = hn::Gt(hn::Mul(low, z), x);
  const V slope = hn::IfThenElse(beyond, low, hn::Add(low, lines.step));
  const V cosine = hn::Div(one, hn::Sqrt(hn::Add(one, hn::Mul(slope, slope))));
  const V off = hn::Mul(hn::Sub(hn::Mul(slope, z), x), cosine);
  const V distance = hn::IfThenElse(beyond, off, hn::Neg(off));
  const V tilt = hn::Mul(slope, cosine);
  const V slant = hn::IfThenElse(beyond, hn::Neg(tilt), tilt);
  const V square = hn::Sub(hn::Mul(radius, radius), hn::Mul(distance, distance));
  // The cap of the ball beyond the plane: its pole, or the rim's point that is farthest along the optical axis.
  const V centre = hn::Mul(distance, slant);
  const V spread = hn::Mul(hn::Sqrt(hn::Max(square, zero)), cosine);
  const V pole = hn::Mul(radius, slant);
  const M inside = hn::Le(distance, zero);
  const M has_far_pole = hn::Or(inside, hn::Ge(pole, distance));
  const M has_near_pole = hn::Or(inside, hn::Ge(hn::Neg(pole), distance));
  const V deepest = hn::Add(z, hn::IfThenElse(has_far_pole, radius, hn::Add(centre, spread)));
  const V nearest = hn::Add(z, hn::IfThenElse(has_near_pole, hn::Neg(radius), hn::Sub(centre, spread)));
  const M missed = hn::Gt(distance, radius);
  hn::Store(distance, d, sides.distance_m.data() + at);
  hn::Store(slant, d, sides.slant.data() + at);
  hn::Store(hn::IfThenElse(missed, hn::Set(d, kNever), deepest), d, sides.deepest_m.data() + at);
  hn::Store(nearest, d, sides.nearest_m.data() + at);
}

/// Of `count` columns (rounded up to whole vectors) from `first` on.
HWY_INLINE void measure(const Lines& lines, const ScannedBall& ball, int first, int count, Sides& sides) {
  const Floats d;
  const V z = hn::Set(d, ball.z_m);
  const V radius = hn::Set(d, ball.radius_m);
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    measure_vector(lines, hn::Iota(d, static_cast<float>(first + i)), z, radius, static_cast<std::size_t>(i), sides);
  }
}

/// A row of pixels or blocks: where their depths stand.
struct Depths {
  const float* free_m;
  const float* second_near_m;  ///< null without islands; of pixels the island itself
  const float* second_far_m;
};

/// Lanes in which the ball may meet what is not known free. Indices into the row's depths: at `index` if strided, else
/// from `index` of the first lane on.
template <bool kStrided, class D>
HWY_INLINE hn::Mask<D> may_meet(D d, const Sides& columns, std::size_t column, const Sides& rows, std::size_t row,
                                hn::Vec<D> square_radius, const Depths& depths, hn::Vec<hn::RebindToSigned<D>> index) {
  using V = hn::Vec<D>;   // NOLINT(*-shadow): of this many lanes
  using M = hn::Mask<D>;  // NOLINT(*-shadow): likewise
  const V zero = hn::Zero(d);
  const auto read = [&](const float* HWY_RESTRICT from) HWY_ATTR {
    if constexpr (kStrided) {
      return hn::GatherIndex(d, from, index);
    } else {
      return hn::LoadU(d, from + column);
    }
  };
  const V row_distance = hn::Set(d, rows.distance_m[row]);
  const V distance = hn::Load(d, columns.distance_m.data() + column);
  const V deepest = hn::Min(hn::Load(d, columns.deepest_m.data() + column), hn::Set(d, rows.deepest_m[row]));
  M met = hn::Ge(deepest, read(depths.free_m));
  if (hn::AllFalse(d, met)) {
    return met;
  }
  if (depths.second_near_m != nullptr) {
    const V nearest = hn::Max(hn::Load(d, columns.nearest_m.data() + column), hn::Set(d, rows.nearest_m[row]));
    met = hn::AndNot(hn::And(hn::Gt(nearest, read(depths.second_near_m)), hn::Lt(deepest, read(depths.second_far_m))),
                     met);
  }
  // Where the centre lies outside both planes the edge between them may be out of reach though neither plane is.
  const V c = hn::Mul(hn::Load(d, columns.slant.data() + column), hn::Set(d, rows.slant[row]));
  const M corner =
      hn::And(hn::And(hn::Gt(distance, zero), hn::Gt(row_distance, zero)),
              hn::And(hn::Gt(distance, hn::Mul(c, row_distance)), hn::Gt(row_distance, hn::Mul(c, distance))));
  const V product = hn::Mul(distance, row_distance);
  const V edge = hn::Sub(hn::Add(hn::Mul(distance, distance), hn::Mul(row_distance, row_distance)),
                         hn::Mul(hn::Add(c, c), product));
  const V limit = hn::Sub(square_radius, hn::Mul(hn::Mul(c, c), square_radius));
  return hn::AndNot(hn::And(corner, hn::Gt(edge, limit)), met);
}

HWY_INLINE int whole_vectors(int count) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  return (count + lanes - 1) / lanes * lanes;
}

struct Asked {
  bool (*meets)(const void* context, int u, int v);
  const void* context;
};

bool scan_pixels(const LocalCamera& camera, const ScannedBall& ball, const Window& window, Asked asked) {
  const Floats d;
  // Columns beyond the window make whole vectors. They have to lie in the image, and may be asked about twice.
  const int count = whole_vectors(window.u1 - window.u0 + 1);
  const int first = std::min(window.u0, camera.width_px - count);
  const int rows = window.v1 - window.v0 + 1;
  Sides across;  // NOLINT(*-member-init): written before it is read
  Sides down;    // NOLINT(*-member-init): written before it is read
  measure(lines_of(ball.x_m, camera.fx, camera.cx, 1), ball, first, count, across);
  measure(lines_of(ball.y_m, camera.fy, camera.cy, 1), ball, window.v0, rows, down);
  const V square_radius = hn::Set(d, ball.radius_m * ball.radius_m);
  const float* const island_near_m = camera.has_islands ? camera.image->island_near_m.data() : nullptr;
  const float* const island_far_m = camera.has_islands ? camera.image->island_far_m.data() : nullptr;
  for (int v = window.v0; v <= window.v1; ++v) {
    const auto row = static_cast<std::size_t>(v - window.v0);
    const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(v) * camera.width_px + first;
    const Depths depths{camera.free_m + start, camera.has_islands ? island_near_m + start : nullptr,
                        camera.has_islands ? island_far_m + start : nullptr};
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
      const M met =
          may_meet<false>(d, across, static_cast<std::size_t>(i), down, row, square_radius, depths, hn::Zero(Ints()));
      for (std::uint32_t bits = hn::AllFalse(d, met) ? 0 : bits_of(met); bits != 0; bits &= bits - 1) {
        if (asked.meets(asked.context, first + i + std::countr_zero(bits), v)) {
          return true;
        }
      }
    }
  }
  return false;
}

/// A window of at most kFew columns and rows, which most are: columns and rows in the same vectors.
bool scan_few(const LocalCamera& camera, const ScannedBall& ball, Asked asked) {
  const Floats d;
  const FewLanes few;
  const int n = static_cast<int>(hn::Lanes(d));
  const Window& window = ball.window;
  // Columns beyond the window have to lie in the image, and may be asked about.
  const int leftmost = std::min(window.u0, camera.width_px - kFew);
  const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(window.v0) * camera.width_px + leftmost;
  Sides sides;  // NOLINT(*-member-init): written before it is read
  const Lines across = lines_of(ball.x_m, camera.fx, camera.cx, 1);
  const Lines down = lines_of(ball.y_m, camera.fy, camera.cy, 1);
  for (int i = 0; i < 2 * kFew; i += n) {
    const V at = hn::Iota(d, static_cast<float>(i));
    const M is_column = hn::Lt(at, hn::Set(d, static_cast<float>(kFew)));
    const auto either = [&](V column, V row) HWY_ATTR { return hn::IfThenElse(is_column, column, row); };
    const Lines lines{either(across.across_m, down.across_m), either(across.per_focal, down.per_focal),
                      either(across.step, down.step), across.size_px, either(across.centre_px, down.centre_px)};
    const V number =
        hn::Add(at, either(hn::Set(d, static_cast<float>(leftmost)), hn::Set(d, static_cast<float>(window.v0 - kFew))));
    measure_vector(lines, number, hn::Set(d, ball.z_m), hn::Set(d, ball.radius_m), static_cast<std::size_t>(i), sides);
  }
  const auto square_radius = hn::Set(few, ball.radius_m * ball.radius_m);
  const float* const island_near_m = camera.has_islands ? camera.image->island_near_m.data() + start : nullptr;
  const float* const island_far_m = camera.has_islands ? camera.image->island_far_m.data() + start : nullptr;
  for (int v = window.v0; v <= window.v1; ++v) {
    const auto row = static_cast<std::size_t>(v - window.v0);
    const std::ptrdiff_t behind = static_cast<std::ptrdiff_t>(v - window.v0) * camera.width_px;
    const Depths depths{camera.free_m + start + behind, camera.has_islands ? island_near_m + behind : nullptr,
                        camera.has_islands ? island_far_m + behind : nullptr};
    for (int i = 0; i < kFew; i += static_cast<int>(hn::Lanes(few))) {
      const auto met = may_meet<false>(few, sides, static_cast<std::size_t>(i), sides, kFew + row, square_radius,
                                       depths, hn::Zero(hn::RebindToSigned<FewLanes>()));
      for (std::uint32_t bits = hn::AllFalse(few, met) ? 0 : few_bits_of(met); bits != 0; bits &= bits - 1) {
        if (asked.meets(asked.context, leftmost + i + std::countr_zero(bits), v)) {
          return true;
        }
      }
    }
  }
  return false;
}

/// Blocks of 2^level pixels a side, level at least 2, first; then the pixels of those that may be met.
bool scan_blocks(const LocalCamera& camera, const ScannedBall& ball, int level, Asked asked) {
  const Floats d;
  const Ints di;
  const Window& window = ball.window;
  const int i0 = window.u0 >> level;
  const int j0 = window.v0 >> level;
  const int j1 = window.v1 >> level;
  const int last = window.u1 >> level;
  const int count = whole_vectors(last - i0 + 1);
  Sides across;  // NOLINT(*-member-init): written before it is read
  Sides down;    // NOLINT(*-member-init): written before it is read
  measure(lines_of(ball.x_m, camera.fx, camera.cx, 1 << level), ball, i0, count, across);
  measure(lines_of(ball.y_m, camera.fy, camera.cy, 1 << level), ball, j0, j1 - j0 + 1, down);
  const V square_radius = hn::Set(d, ball.radius_m * ball.radius_m);
  // The texel two levels down covers a block exactly.
  const PyramidLevel& texels = camera.levels[level - 2];
  for (int j = j0; j <= j1; ++j) {
    const auto row = static_cast<std::size_t>(j - j0);
    const std::ptrdiff_t start = texels.offset + static_cast<std::ptrdiff_t>(4) * j * texels.width;
    const Depths depths{camera.minima_m + start,
                        camera.has_islands ? camera.image->second_near_maxima_m.data() + start : nullptr,
                        camera.has_islands ? camera.image->second_far_minima_m.data() + start : nullptr};
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
      const I block = hn::Min(hn::Iota(di, i0 + i), hn::Set(di, last));
      const M met = may_meet<true>(d, across, static_cast<std::size_t>(i), down, row, square_radius, depths,
                                   hn::ShiftLeft<2>(block));
      for (std::uint32_t bits = hn::AllFalse(d, met) ? 0 : bits_of(met); bits != 0; bits &= bits - 1) {
        const int at = i0 + i + std::countr_zero(bits);
        const Window pixels{std::max(at << level, window.u0), std::max(j << level, window.v0),
                            std::min(((at + 1) << level) - 1, window.u1), std::min(((j + 1) << level) - 1, window.v1)};
        if (at <= last && scan_pixels(camera, ball, pixels, asked)) {
          return true;
        }
      }
    }
  }
  return false;
}

bool scan_lanes(const LocalCamera& camera, const ScannedBall& ball, bool (*meets)(const void*, int, int),
                const void* context) {
  const Window& window = ball.window;
  const int side = std::max(window.u1 - window.u0, window.v1 - window.v0) + 1;
  if (side <= kFew) {
    return scan_few(camera, ball, {meets, context});
  }
  int level = 0;
  if (side > kFewPixels) {
    level = 2;
    while ((side >> level) > kFewBlocks && level < camera.level_count + 1) {
      ++level;
    }
  }
  return level == 0 ? scan_pixels(camera, ball, window, {meets, context})
                    : scan_blocks(camera, ball, level, {meets, context});
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::views {

HWY_EXPORT(scan_lanes);

bool can_scan(const LocalCamera& camera, const Window& window) noexcept {
  const int columns = window.u1 - window.u0 + 1;
  const int rows = window.v1 - window.v0 + 1;
  return columns <= kMaxScanned && rows <= kMaxScanned && columns + 16 <= camera.width_px;
}

bool scan(const LocalCamera& camera, const ScannedBall& ball, bool (*meets)(const void* context, int u, int v),
          const void* context) noexcept {
  return HWY_DYNAMIC_DISPATCH(scan_lanes)(camera, ball, meets, context);
}

}  // namespace depthgrid::views
#endif
