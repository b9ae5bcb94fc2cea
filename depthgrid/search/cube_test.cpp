#include "depthgrid/search/cube_test.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/cube_test.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: highway.h must be seen once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No fused multiply-add anywhere: every instruction set gives the same bits.
using Floats = hn::CappedTag<float, 8>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
using M = hn::Mask<Floats>;

alignas(64) constexpr float kSignX[8] = {-1, 1, -1, 1, -1, 1, -1, 1};
alignas(64) constexpr float kSignY[8] = {-1, -1, 1, 1, -1, -1, 1, 1};
alignas(64) constexpr float kSignZ[8] = {-1, -1, -1, -1, 1, 1, 1, 1};

/// Boxes, one a lane: centre and half sides along the world's axes.
struct Boxes {
  V x, y, z;
  V half_x, half_y, half_z;
  V half_diagonal;
};

/// Bounds of the boxes in a camera's frame, grown by the camera's reach.
struct Bounds {
  V x_low, x_high, y_low, y_high, z_low, z_high;
};

HWY_INLINE V weighted(const float* HWY_RESTRICT row, V x, V y, V z) {
  const Floats d;
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y)),
                 hn::Mul(hn::Set(d, row[2]), z));
}

HWY_INLINE Bounds bounds_in(const LocalCamera& camera, const Boxes& boxes) {
  const Floats d;
  const V x = hn::Add(weighted(camera.rotation, boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[0]));
  const V y = hn::Add(weighted(camera.rotation + 3, boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[1]));
  const V z = hn::Add(weighted(camera.rotation + 6, boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[2]));
  V grown = hn::Set(d, camera.guard_m);
  if (camera.has_reach) {
    const V range = hn::Add(hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z))),
                            boxes.half_diagonal);
    const V reach = hn::Add(hn::Set(d, camera.reach_m), hn::Mul(hn::Set(d, camera.reach_per_m), range));
    grown = hn::Add(grown, hn::Mul(reach, hn::Set(d, 1.00001F)));
  }
  const float* HWY_RESTRICT spread = camera.absolute_rotation;
  const V half_x = hn::Add(weighted(spread, boxes.half_x, boxes.half_y, boxes.half_z), grown);
  const V half_y = hn::Add(weighted(spread + 3, boxes.half_x, boxes.half_y, boxes.half_z), grown);
  const V half_z = hn::Add(weighted(spread + 6, boxes.half_x, boxes.half_y, boxes.half_z), grown);
  return {hn::Sub(x, half_x), hn::Add(x, half_x), hn::Sub(y, half_y),
          hn::Add(y, half_y), hn::Sub(z, half_z), hn::Add(z, half_z)};
}

/// Continuous pixel coordinates of the rectangle around the boxes' projections, guards included.
struct Rectangle {
  V u_low, u_high, v_low, v_high;
};

HWY_INLINE Rectangle project(const LocalCamera& camera, const Bounds& b, V z_low, V z_high) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0F);
  const V by_low = hn::Div(one, z_low);
  const V by_high = hn::Div(one, z_high);
  const V fx = hn::Set(d, camera.fx);
  const V fy = hn::Set(d, camera.fy);
  const auto least = [&](V low) HWY_ATTR { return hn::Mul(low, hn::IfThenElse(hn::Lt(low, zero), by_low, by_high)); };
  const auto most = [&](V high) HWY_ATTR { return hn::Mul(high, hn::IfThenElse(hn::Lt(high, zero), by_high, by_low)); };
  return {hn::Add(hn::Mul(least(b.x_low), fx), hn::Set(d, camera.cx - camera.guard_px)),
          hn::Add(hn::Mul(most(b.x_high), fx), hn::Set(d, camera.cx + camera.guard_px)),
          hn::Add(hn::Mul(least(b.y_low), fy), hn::Set(d, camera.cy - camera.guard_px)),
          hn::Add(hn::Mul(most(b.y_high), fy), hn::Set(d, camera.cy + camera.guard_px))};
}

/// The extremum of an image over a rectangle of pixels in each lane.
template <class Pick>
HWY_INLINE V extremum(const LocalCamera& camera, const float* image, const float* pyramid, int level, I u0, I u1, I v0,
                      I v1, Pick pick) {
  const Floats d;
  const Ints di;
  if (level == 0) {
    // At most two by two pixels.
    const I width = hn::Set(di, camera.width_px);
    const I row0 = hn::Mul(v0, width);
    const I row1 = hn::Mul(v1, width);
    return pick(pick(hn::GatherIndex(d, image, hn::Add(row0, u0)), hn::GatherIndex(d, image, hn::Add(row0, u1))),
                pick(hn::GatherIndex(d, image, hn::Add(row1, u0)), hn::GatherIndex(d, image, hn::Add(row1, u1))));
  }
  const PyramidLevel& texels = camera.levels[level];
  const I index = hn::Add(hn::Mul(hn::ShiftRightSame(v0, level), hn::Set(di, texels.width)),
                          hn::ShiftRightSame(u0, level));
  return hn::GatherIndex(d, pyramid + texels.offset, index);
}

/// Lanes of `inside` whose pixel rectangle's frusta are free from z_low to z_high.
HWY_INLINE M freed(const LocalCamera& camera, M inside, const Rectangle& r, V z_low, V z_high) {
  const Floats d;
  const Ints di;
  const I u0 = hn::ConvertTo(di, hn::IfThenElseZero(inside, r.u_low));
  const I u1 = hn::ConvertTo(di, hn::IfThenElseZero(inside, r.u_high));
  const I v0 = hn::ConvertTo(di, hn::IfThenElseZero(inside, r.v_low));
  const I v1 = hn::ConvertTo(di, hn::IfThenElseZero(inside, r.v_high));
  const int32_t span = hn::GetLane(hn::MaxOfLanes(di, hn::Max(hn::Sub(u1, u0), hn::Sub(v1, v0))));
  // The smallest level whose 2^level reaches the span; the coarsest reaches the whole image.
  const int level = span <= 1 ? 0 : static_cast<int>(std::bit_width(static_cast<std::uint32_t>(span - 1)));
  const auto min = [](V a, V b) HWY_ATTR { return hn::Min(a, b); };
  const auto max = [](V a, V b) HWY_ATTR { return hn::Max(a, b); };
  const V free_m = extremum(camera, camera.free_m, camera.minima_m, level, u0, u1, v0, v1, min);
  const M seen_free = hn::And(hn::Gt(z_low, hn::Set(d, camera.blind_m)), hn::Lt(z_high, free_m));
  if (!camera.has_islands) {
    return hn::And(inside, seen_free);
  }
  const View& view = *camera.view;
  const V near_m =
      extremum(camera, view.island_near_m().data(), view.island_near_maxima_m(), level, u0, u1, v0, v1, max);
  const V far_m = extremum(camera, view.island_far_m().data(), view.island_far_minima_m(), level, u0, u1, v0, v1, min);
  const M in_robot = hn::And(hn::Ge(z_low, near_m), hn::Le(z_high, far_m));
  return hn::And(inside, hn::Or(seen_free, in_robot));
}

/// Lanes that the camera frees wholly.
HWY_INLINE M freed_whole(const LocalCamera& camera, const Bounds& b) {
  const Floats d;
  const V zero = hn::Zero(d);
  const M in_front = hn::Gt(b.z_low, hn::Set(d, 1e-6F));
  const Rectangle r = project(camera, b, b.z_low, b.z_high);
  const M inside = hn::And(
      hn::And(hn::And(hn::Ge(r.u_low, zero), hn::Lt(r.u_high, hn::Set(d, camera.width))), in_front),
      hn::And(hn::Ge(r.v_low, zero), hn::Lt(r.v_high, hn::Set(d, camera.height))));
  if (hn::AllFalse(d, inside)) {
    return inside;
  }
  return freed(camera, inside, r, b.z_low, b.z_high);
}

/// Lanes of which the camera frees the part in its view between the clip's depths; where there is no such part it is
/// free.
HWY_INLINE M freed_in_view(const LocalCamera& camera, const Clip& clip, const Bounds& b) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V z_low = hn::Max(b.z_low, hn::Set(d, clip.low_m));
  const V z_high = hn::Min(b.z_high, hn::Set(d, clip.high_m));
  const V tiny = hn::Set(d, 1e-6F);
  const Rectangle whole = project(camera, b, hn::Max(z_low, tiny), hn::Max(z_high, tiny));
  const M empty = hn::Or(
      hn::Or(hn::Or(hn::Lt(z_high, z_low), hn::Lt(z_high, tiny)),
             hn::Or(hn::Lt(whole.u_high, zero), hn::Ge(whole.u_low, hn::Set(d, camera.width)))),
      hn::Or(hn::Lt(whole.v_high, zero), hn::Ge(whole.v_low, hn::Set(d, camera.height))));
  if (hn::AllTrue(d, empty) || camera.has_reach) {
    return empty;
  }
  const V last_u = hn::Set(d, camera.width - 1);
  const V last_v = hn::Set(d, camera.height - 1);
  const Rectangle r{hn::Min(hn::Max(whole.u_low, zero), last_u), hn::Min(hn::Max(whole.u_high, zero), last_u),
                    hn::Min(hn::Max(whole.v_low, zero), last_v), hn::Min(hn::Max(whole.v_high, zero), last_v)};
  return hn::Or(empty, freed(camera, hn::Not(empty), r, z_low, z_high));
}

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
  return hn::Or(hn::Or(in_depth, behind),
                hn::Or(beyond(b.x_low, b.x_high, -camera.cx / camera.fx, (camera.width - camera.cx) / camera.fx),
                       beyond(b.y_low, b.y_high, -camera.cy / camera.fy, (camera.height - camera.cy) / camera.fy)));
}

/// Lower bound of the distance from the axis to the boxes.
HWY_INLINE V axis_distance(const CubeQuery& query, const Boxes& boxes) {
  const Floats d;
  const V zero = hn::Zero(d);
  const auto length = [&](V x, V y, V z) HWY_ATTR {
    return hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
  };
  if (query.inverse_square == 0) {
    return length(hn::Max(hn::Sub(hn::Abs(boxes.x), boxes.half_x), zero),
                  hn::Max(hn::Sub(hn::Abs(boxes.y), boxes.half_y), zero),
                  hn::Max(hn::Sub(hn::Abs(boxes.z), boxes.half_z), zero));
  }
  const V ax = hn::Sub(boxes.x, hn::Set(d, query.axis_a[0]));
  const V ay = hn::Sub(boxes.y, hn::Set(d, query.axis_a[1]));
  const V az = hn::Sub(boxes.z, hn::Set(d, query.axis_a[2]));
  const V t0 = hn::Mul(weighted(query.axis_along, ax, ay, az), hn::Set(d, query.inverse_square));
  const V t = hn::Min(hn::Max(t0, zero), hn::Set(d, 1.0F));
  const V dx = hn::Sub(ax, hn::Mul(t, hn::Set(d, query.axis_along[0])));
  const V dy = hn::Sub(ay, hn::Mul(t, hn::Set(d, query.axis_along[1])));
  const V dz = hn::Sub(az, hn::Mul(t, hn::Set(d, query.axis_along[2])));
  const V distance = length(dx, dy, dz);
  // Two lower bounds: the ball around the box, and the slab between the box and the axis seen along their distance.
  const V by_ball = hn::Sub(distance, boxes.half_diagonal);
  return hn::Max(by_ball, zero);
}

void split_lanes(CubeQuery& query, const Cube& parent, float half_m, float bound_m, Children& children) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V half = hn::Set(d, half_m);
  children.count = 0;
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    Boxes boxes{hn::Add(hn::Set(d, parent.x), hn::Mul(hn::Load(d, kSignX + first), half)),
                hn::Add(hn::Set(d, parent.y), hn::Mul(hn::Load(d, kSignY + first), half)),
                hn::Add(hn::Set(d, parent.z), hn::Mul(hn::Load(d, kSignZ + first), half)),
                half,
                half,
                half,
                hn::Set(d, half_m * 1.7320509F)};
    const V x = boxes.x;
    const V y = boxes.y;
    const V z = boxes.z;
    M open = hn::Eq(zero, zero);
    if (query.boxed) {
      const auto cut = [&](V& centre, V& half_side, float low, float high) HWY_ATTR {
        const V from = hn::Max(hn::Sub(centre, half_side), hn::Set(d, low));
        const V to = hn::Min(hn::Add(centre, half_side), hn::Set(d, high));
        open = hn::And(open, hn::Le(from, to));
        centre = hn::Mul(hn::Add(from, to), hn::Set(d, 0.5F));
        // A little larger: the centre has been rounded.
        half_side = hn::Add(hn::Mul(hn::Sub(to, from), hn::Set(d, 0.5F)), hn::Set(d, 5e-7F));
      };
      cut(boxes.x, boxes.half_x, query.box_low[0], query.box_high[0]);
      cut(boxes.y, boxes.half_y, query.box_low[1], query.box_high[1]);
      cut(boxes.z, boxes.half_z, query.box_low[2], query.box_high[2]);
    }
    const V distance = axis_distance(query, boxes);
    open = hn::And(open, hn::Lt(distance, hn::Set(d, bound_m)));
    M uncovered = query.uncovered_ignored ? open : hn::Lt(zero, zero);
    for (std::size_t n = 0; n < query.camera_count && !hn::AllFalse(d, open); ++n) {
      const std::uint8_t k = query.order[n];
      const LocalCamera& camera = query.cameras[k];
      const Bounds bounds = bounds_in(camera, boxes);
      M gone = freed_whole(camera, bounds);
      if (query.principal == static_cast<int>(k)) {
        gone = hn::Or(gone, outside_view(query, camera, bounds));
      }
      if (camera.space.to_view) {
        gone = hn::Or(gone, freed_in_view(camera, camera.space, bounds));
      }
      if (query.uncovered_ignored) {
        uncovered = hn::And(uncovered, freed_in_view(camera, camera.coverage, bounds));
      }
      const M rest = hn::AndNot(gone, open);
      if (n > 0 && hn::AllFalse(d, rest)) {
        // This camera sees what the others do not: ask it first from now on.
        query.order[n] = query.order[0];
        query.order[0] = k;
      }
      open = rest;
    }
    open = hn::AndNot(uncovered, open);
    if (hn::AllFalse(d, open)) {
      continue;
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, open, bits);
    alignas(64) float xs[8];
    alignas(64) float ys[8];
    alignas(64) float zs[8];
    alignas(64) float distances[8];
    hn::Store(x, d, xs);
    hn::Store(y, d, ys);
    hn::Store(z, d, zs);
    hn::Store(distance, d, distances);
    for (unsigned rest = bits[0]; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      children.cubes[static_cast<std::size_t>(children.count++)] = {xs[i], ys[i], zs[i], distances[i],
                                                                    parent.level + 1};
    }
  }
}

}  // namespace depthgrid::search::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::search {

HWY_EXPORT(split_lanes);

void split(CubeQuery& query, const Cube& parent, float half_m, float bound_m, Children& children) noexcept {
  HWY_DYNAMIC_DISPATCH(split_lanes)(query, parent, half_m, bound_m, children);
}

}  // namespace depthgrid::search
#endif
