#include <algorithm>
#include <array>
#include <bit>

#include "depthgrid/search/cube_query.hpp"
#include "depthgrid/search/exact_tests.hpp"
#include "depthgrid/views/pixel_bounds.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/open_children.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: they must be seen once for each target.
#include "depthgrid/views/known_free-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::octants::HWY_NAMESPACE {

using namespace views::octants::HWY_NAMESPACE;

/// Lanes wholly outside the view between the two depths.
HWY_INLINE M outside_view(const CubeQuery& query, const LocalCamera& camera, const Bounds& b) {
  const Floats d;
  const V zero = hn::Zero(d);
  const auto beyond = [&](V low, V high, float first, float last) HWY_ATTR {
    // low - s z > 0 for every z: right of the plane x = s z; the same on the other side.
    const V right = hn::Set(d, last);
    const V left = hn::Set(d, first);
    const V right_most = hn::Max(hn::Mul(right, b.z_low), hn::Mul(right, b.z_high));
    const V left_least = hn::Min(hn::Mul(left, b.z_low), hn::Mul(left, b.z_high));
    const V guard = hn::Set(d, camera.guard_m);
    return hn::Or(hn::Gt(hn::Sub(low, right_most), guard), hn::Lt(hn::Add(high, guard), left_least));
  };
  const M in_depth = hn::Or(hn::Gt(b.z_low, hn::Set(d, query.d_max_m)), hn::Lt(b.z_high, hn::Set(d, query.d_min_m)));
  const M behind = hn::Lt(b.z_high, zero);
  return hn::Or(hn::Or(in_depth, behind), hn::Or(beyond(b.x_low, b.x_high, (-camera.cx - camera.guard_px) / camera.fx,
                                                        (camera.width - camera.cx + camera.guard_px) / camera.fx),
                                                 beyond(b.y_low, b.y_high, (-camera.cy - camera.guard_px) / camera.fy,
                                                        (camera.height - camera.cy + camera.guard_px) / camera.fy)));
}

/// Lanes of `open` that stay open after every camera has been asked.
HWY_INLINE M not_known_free(CubeQuery& query, const Cube& parent, float half_m, const Boxes& boxes, M open) {
  const Floats d;
  const V zero = hn::Zero(d);
  M uncovered = query.uncovered_ignored ? open : hn::Lt(zero, zero);
  for (std::size_t n = 0; n < query.camera_count; ++n) {
    const std::uint8_t k = query.order[n];
    const LocalCamera& camera = query.cameras[k];
    const Bounds bounds = bounds_in(camera, boxes);
    const views::PixelBounds pixels = pixel_bounds(camera, parent, half_m);
    M gone = known_free_whole(camera, open, bounds, pixels);
    // W and what a camera covers have nothing to do with its pose error.
    const bool plain = query.principal == static_cast<int>(k) || query.uncovered_ignored;
    const Bounds own = plain && camera.has_pose_error ? bounds_in(camera, boxes, false) : bounds;
    if (query.principal == static_cast<int>(k)) {
      gone = hn::Or(gone, outside_view(query, camera, own));
    }
    if (camera.space.to_view) {
      gone = hn::Or(gone, known_free_in_view(camera, camera.space, bounds, pixels));
    }
    if (query.uncovered_ignored) {
      uncovered = hn::And(uncovered, known_free_in_view(camera, camera.coverage, own, pixels));
    }
    open = hn::AndNot(gone, open);
    if (hn::AllFalse(d, open)) {
      // This camera sees what the others do not: ask it first from now on.
      query.order[n] = query.order[0];
      query.order[0] = k;
      return open;
    }
  }
  return hn::AndNot(uncovered, open);
}

/// What stays within W.
HWY_INLINE M cut_to_space(const CubeQuery& query, Boxes& boxes) {
  const Floats d;
  const V zero = hn::Zero(d);
  M inside = hn::Eq(zero, zero);
  const auto cut = [&](V& centre, V& half_side, float low, float high) HWY_ATTR {
    const V from = hn::Max(hn::Sub(centre, half_side), hn::Set(d, low));
    const V to = hn::Min(hn::Add(centre, half_side), hn::Set(d, high));
    inside = hn::And(inside, hn::Le(from, to));
    centre = hn::Mul(hn::Add(from, to), hn::Set(d, 0.5F));
    // A little larger: the centre has been rounded. Never negative: what projects has to be a rectangle even where the
    // box lies outside W and its lane is not wanted.
    half_side = hn::Add(hn::Max(hn::Mul(hn::Sub(to, from), hn::Set(d, 0.5F)), zero), hn::Set(d, 1e-6F));
  };
  cut(boxes.x, boxes.half_x, query.box_low[0], query.box_high[0]);
  cut(boxes.y, boxes.half_y, query.box_low[1], query.box_high[1]);
  cut(boxes.z, boxes.half_z, query.box_low[2], query.box_high[2]);
  return inside;
}

std::uint32_t open_lanes(CubeQuery& query, const Cube& cube, float half_m) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V half = hn::Set(d, half_m);
  std::uint32_t result = 0;
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    Boxes boxes{child_centre(cube.x, kSignX.data() + first, half),
                child_centre(cube.y, kSignY.data() + first, half),
                child_centre(cube.z, kSignZ.data() + first, half),
                half,
                half,
                half,
                hn::Set(d, half_m * 1.7320509F)};
    const M inside = query.boxed ? cut_to_space(query, boxes) : hn::Eq(zero, zero);
    if (!hn::AllFalse(d, inside)) {
      result |= bits_of(not_known_free(query, cube, half_m, boxes, inside)) << first;
    }
  }
  return result;
}

}  // namespace depthgrid::search::octants::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::search {
namespace octants {

HWY_EXPORT(open_lanes);

std::uint32_t open(CubeQuery& query, const Cube& cube, float half_m) noexcept {
  return HWY_DYNAMIC_DISPATCH(open_lanes)(query, cube, half_m);
}

}  // namespace octants

std::uint32_t open_children(CubeQuery& query, const Cube& cube) noexcept {
  const float half_m = query.lattice.half_side_m(cube.level + 1);
  std::uint32_t open = octants::open(query, cube, half_m);
  if (query.possible == nullptr) {
    return open;
  }
  for (std::uint32_t rest = open; rest != 0; rest &= rest - 1) {
    constexpr std::array<float, 2> kSigns{-1, 1};
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
    const Cube child{cube.x + kSigns[lane & 1U] * half_m, cube.y + kSigns[(lane >> 1U) & 1U] * half_m,
                     cube.z + kSigns[(lane >> 2U) & 1U] * half_m, cube.level + 1};
    open &= may_be_occupied(query, box_of(query, child)) ? open : ~(1U << lane);
  }
  return open;
}

}  // namespace depthgrid::search
#endif
