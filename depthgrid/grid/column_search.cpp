#include "depthgrid/grid/column_search.hpp"

#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/grid/column_search.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: it must be seen once for each target.
#include "depthgrid/core/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::grid::HWY_NAMESPACE {
using namespace lanes::HWY_NAMESPACE;
using Line = ClosedFormMap::Line;
static_assert(ClosedFormMap::kPadding >= hn::MaxLanes(Floats()), "what is read beside the cells is padding");

constexpr int kNone = std::numeric_limits<int>::max();

/// Lanes whose cell this camera denies. The operations and their order are those of ClosedFormMap::Ray::pixel.
HWY_INLINE M denied(const Line& line, const float* HWY_RESTRICT depth_m, int n) {
  const Floats d;
  const Ints di;
  const auto zero = hn::Zero(d);
  const auto centre = hn::LoadU(d, line.centre_m + n);
  const auto front = hn::LoadU(d, line.front_m + n);
  const auto b_z = hn::Set(d, line.b_z);
  const auto d_start = hn::Add(hn::Mul(front, hn::Set(d, line.a_z_smallest)), b_z);
  const auto inverse = hn::Div(hn::Set(d, 1.0F), hn::Add(hn::Mul(centre, hn::Set(d, line.a_z)), b_z));
  const auto x = hn::Mul(hn::Add(hn::Mul(centre, hn::Set(d, line.a_x)), hn::Set(d, line.b_x)), inverse);
  const auto y = hn::Mul(hn::Add(hn::Mul(centre, hn::Set(d, line.a_y)), hn::Set(d, line.b_y)), inverse);
  const auto from_left = hn::And(hn::Ge(x, zero), hn::Lt(x, hn::Set(d, line.width_px)));
  const auto from_top = hn::And(hn::Ge(y, zero), hn::Lt(y, hn::Set(d, line.height_px)));
  const auto involved = hn::And(hn::Gt(d_start, zero), hn::And(from_left, from_top));
  const auto u = hn::ConvertTo(di, hn::IfThenElseZero(involved, x));
  const auto v = hn::ConvertTo(di, hn::IfThenElseZero(involved, y));
  const auto index = hn::Add(hn::Mul(v, hn::Set(di, static_cast<int32_t>(line.width_px))), u);
  const auto measured = hn::GatherIndex(d, depth_m, index);
  return hn::And(involved, hn::Not(hn::Lt(measured, d_start)));
}

/// Bit i: cell n + i lies in [low, high] and no camera denies it.
HWY_INLINE std::uint32_t confirmed_lanes(std::span<const ClosedFormMap::Ray> rays,
                                         std::span<const float* const> depths_m, int n, int low, int high) {
  const auto lanes = static_cast<int>(hn::Lanes(Floats()));
  const int skip = std::max(low - n, 0);
  const int end = std::min(high - n + 1, lanes);
  if (skip >= end) {
    return 0;
  }
  const std::uint32_t below_end = end >= 32 ? ~0U : (1U << end) - 1U;
  std::uint32_t alive = below_end & ~((1U << skip) - 1U);
  for (std::size_t k = 0; k < rays.size() && alive != 0; ++k) {
    alive &= ~bits_of(denied(rays[k].line(), depths_m[k], n));
  }
  return alive;
}

ColumnHit search_outwards_wide(std::span<const ClosedFormMap::Ray> rays, std::span<const float* const> depths_m,
                               int start, int first, int last) {
  const auto lanes = static_cast<int>(hn::Lanes(Floats()));
  for (int j = 0; start + j <= last || start - j >= first; j += lanes) {
    int beyond = kNone;
    int before = kNone;
    if (start + j <= last) {
      const std::uint32_t bits = confirmed_lanes(rays, depths_m, start + j, first, last);
      beyond = bits == 0 ? kNone : j + std::countr_zero(bits);
    }
    if (start - j >= first && beyond != 0) {
      const int lowest = start - j - lanes + 1;  // at least 1 - lanes: inside the padding
      const std::uint32_t bits = confirmed_lanes(rays, depths_m, lowest, first, std::min({start - 1, start - j, last}));
      before = bits == 0 ? kNone : start - (lowest + 31 - std::countl_zero(bits));
    }
    if (beyond != kNone || before != kNone) {
      const int nearest = std::min(beyond, before);
      return {nearest, beyond == nearest, before == nearest};
    }
  }
  return {std::max(last - start, start - first), false, false};
}

}  // namespace depthgrid::grid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::grid {

HWY_EXPORT(search_outwards_wide);

ColumnHit search_outwards_wide(std::span<const ClosedFormMap::Ray> rays, std::span<const float* const> depths_m,
                               int start, int first, int last) noexcept {
  return HWY_DYNAMIC_DISPATCH(search_outwards_wide)(rays, depths_m, start, first, last);
}

}  // namespace depthgrid::grid
#endif
