#include "depthgrid/search/cube_split.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/cube_split.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: they must be seen once for each target.
#include "depthgrid/search/known_free-inl.hpp"
#include "depthgrid/search/proximities-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::HWY_NAMESPACE {
alignas(64) constexpr std::array<float, kSplit> kSignX{-1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1};
alignas(64) constexpr std::array<float, kSplit> kSignY{-1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1, 1};
alignas(64) constexpr std::array<float, kSplit> kSignZ{-1, -1, -1, -1, 1, 1, 1, 1, -1, -1, -1, -1, 1, 1, 1, 1};

/// Cubes of at most so many resolutions half a side are asked whether they touch: larger ones hardly ever end a search.
constexpr float kHintSides = 2.5F;

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
HWY_INLINE M not_known_free(CubeQuery& query, std::span<const Cube> parents, float half_m, const Boxes& boxes, M open) {
  const Floats d;
  const V zero = hn::Zero(d);
  M uncovered = query.uncovered_ignored ? open : hn::Lt(zero, zero);
  for (std::size_t n = 0; n < query.camera_count; ++n) {
    const std::uint8_t k = query.order[n];
    const LocalCamera& camera = query.cameras[k];
    const Bounds bounds = bounds_in(camera, boxes);
    const PixelBounds pixels = pixel_bounds(camera, parents, half_m);
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

/// Lanes of `open` whose point nearest to the axis seems to lie at or near not known free space in every camera.
HWY_INLINE std::uint32_t tight_witness(const CubeQuery& query, const Axis& axis, const Boxes& boxes,
                                       std::uint32_t lanes) {
  const Proximities near = proximities(axis, boxes);
  for (std::size_t n = 0; n < query.camera_count && lanes != 0; ++n) {
    const LocalCamera& camera = query.cameras[query.order[n]];
    lanes &= bits_of(touches(camera, near.near_x, near.near_y, near.near_z, query.slack_m));
  }
  return lanes;
}

// NOLINTNEXTLINE(readability-function-cognitive-complexity): lanes, primitives and children are three nested loops
void split_lanes(CubeQuery& query, const Cube* parents, int parent_count, float half_m, Children& children) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V half = hn::Set(d, half_m);
  children.count = 0;
  const Cube& second = parents[parent_count - 1];
  const std::uint32_t wanted = parents[0].primitives | second.primitives;
  const std::uint32_t second_lanes = parent_count == 2 ? 0xFF00U : 0U;
  const bool hints = half_m <= kHintSides * query.slack_m;
  alignas(64) std::array<float, kSplit> parent_x;  // NOLINT(*-member-init): written before it is read
  alignas(64) std::array<float, kSplit> parent_y;  // NOLINT(*-member-init): written before it is read
  alignas(64) std::array<float, kSplit> parent_z;  // NOLINT(*-member-init): written before it is read
  for (std::size_t i = 0; i < 8; ++i) {
    parent_x[i] = parents[0].x;
    parent_y[i] = parents[0].y;
    parent_z[i] = parents[0].z;
    parent_x[i + 8] = second.x;
    parent_y[i + 8] = second.y;
    parent_z[i + 8] = second.z;
  }
  alignas(64) std::array<std::array<float, kSplit>, kGroup> distances;  // NOLINT(*-member-init): as above
  alignas(64) std::array<float, kSplit> xs;  // NOLINT(*-member-init): written before it is read
  alignas(64) std::array<float, kSplit> ys;  // NOLINT(*-member-init): written before it is read
  alignas(64) std::array<float, kSplit> zs;  // NOLINT(*-member-init): written before it is read
  std::array<std::uint32_t, kGroup> nearer;  // NOLINT(*-member-init): as above
  const std::size_t end = parent_count == 2 ? 16 : 8;
  for (std::size_t first = 0; first < end; first += hn::Lanes(d)) {
    Boxes boxes{hn::Add(hn::Load(d, parent_x.data() + first), hn::Mul(hn::Load(d, kSignX.data() + first), half)),
                hn::Add(hn::Load(d, parent_y.data() + first), hn::Mul(hn::Load(d, kSignY.data() + first), half)),
                hn::Add(hn::Load(d, parent_z.data() + first), hn::Mul(hn::Load(d, kSignZ.data() + first), half)),
                half,
                half,
                half,
                hn::Set(d, half_m * 1.7320509F)};
    hn::Store(boxes.x, d, xs.data() + first);
    hn::Store(boxes.y, d, ys.data() + first);
    hn::Store(boxes.z, d, zs.data() + first);
    const M inside = query.boxed ? cut_to_space(query, boxes) : hn::Eq(zero, zero);
    M open = hn::Lt(zero, zero);
    for (std::uint32_t rest = wanted; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const Axis& axis = query.axes[i];
      const V distance = proximities(axis, boxes).distance;
      const M here = hn::And(inside, hn::Lt(distance, hn::Set(d, axis.bound_m)));
      hn::Store(distance, d, distances[i].data() + first);
      nearer[i] = bits_of(here);
      open = hn::Or(open, here);
    }
    if (hn::AllFalse(d, open)) {
      continue;
    }
    open = not_known_free(query, {parents, static_cast<std::size_t>(parent_count)}, half_m, boxes, open);
    // Lanes of the parents that there are, and of each primitive those whose parent asks for it.
    const std::uint32_t open_bits = bits_of(open) & ((0xFFU | second_lanes) >> first);
    if (open_bits == 0) {
      continue;
    }
    std::array<int, kSplit> child_of;  // NOLINT(*-member-init): as above
    for (std::uint32_t rest = open_bits; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      child_of[lane] = children.count;
      children.tight_witness[static_cast<std::size_t>(children.count)] = 0;
      const std::size_t at = first + lane;
      children.cubes[static_cast<std::size_t>(children.count++)] = {xs[at], ys[at], zs[at], 1e30F, parents[0].level + 1,
                                                                    0};
    }
    for (std::uint32_t rest = wanted; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const std::uint32_t asked =
          ((parents[0].primitives >> i) & 1U) * 0xFFU | ((second.primitives >> i) & 1U) * second_lanes;
      const std::uint32_t mine = nearer[i] & open_bits & (asked >> first);
      if (mine == 0) {
        continue;
      }
      for (std::uint32_t lanes = mine; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        Cube& child = children.cubes[static_cast<std::size_t>(child_of[lane])];
        child.primitives |= 1U << i;
        child.distance_m = std::min(child.distance_m, distances[i][first + lane]);
      }
      if (!hints) {
        continue;
      }
      for (std::uint32_t lanes = tight_witness(query, query.axes[i], boxes, mine); lanes != 0; lanes &= lanes - 1) {
        children.tight_witness[static_cast<std::size_t>(child_of[static_cast<std::size_t>(std::countr_zero(lanes))])] |=
            1U << i;
      }
    }
  }
}

}  // namespace depthgrid::search::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::search {

HWY_EXPORT(split_lanes);

void split(CubeQuery& query, const Cube* parents, int parent_count, float half_m, Children& children) noexcept {
  HWY_DYNAMIC_DISPATCH(split_lanes)(query, parents, parent_count, half_m, children);
}

}  // namespace depthgrid::search
#endif
