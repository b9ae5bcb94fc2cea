#include "depthgrid/search/cube_test.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/cube_test.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: highway.h must be seen once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No fused multiply-add anywhere: every instruction set gives the same bits.
using Floats = hn::CappedTag<float, kSplit>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
using M = hn::Mask<Floats>;

alignas(64) constexpr std::array<float, kSplit> kSignX{-1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1};
alignas(64) constexpr std::array<float, kSplit> kSignY{-1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1, 1};
alignas(64) constexpr std::array<float, kSplit> kSignZ{-1, -1, -1, -1, 1, 1, 1, 1, -1, -1, -1, -1, 1, 1, 1, 1};

/// Cubes of at most so many resolutions half a side are asked whether they touch: larger ones hardly ever end a search.
constexpr float kHintSides = 2.5F;

/// Boxes, one a lane: centre and half sides along the world's axes.
struct Boxes {
  V x, y, z;
  V half_x, half_y, half_z;
  V half_diagonal;
};

/// Bounds of the boxes in a camera's frame, a little more than rounding takes; grown by the camera's reach if asked
/// for.
struct Bounds {
  V x_low, x_high, y_low, y_high, z_low, z_high;
};

HWY_INLINE V weighted(const float* HWY_RESTRICT row, V x, V y, V z) {
  const Floats d;
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y)),
                 hn::Mul(hn::Set(d, row[2]), z));
}

HWY_INLINE Bounds bounds_in(const LocalCamera& camera, const Boxes& boxes, bool with_reach = true) {
  const Floats d;
  const V x = hn::Add(weighted(camera.rotation.data(), boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[0]));
  const V y = hn::Add(weighted(camera.rotation.data() + 3, boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[1]));
  const V z = hn::Add(weighted(camera.rotation.data() + 6, boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[2]));
  V grown = hn::Set(d, camera.guard_m);
  if (camera.has_reach && with_reach) {
    const V range =
        hn::Add(hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z))), boxes.half_diagonal);
    const V reach = hn::Add(hn::Set(d, camera.reach_m), hn::Mul(hn::Set(d, camera.reach_per_m), range));
    grown = hn::Add(grown, hn::Mul(reach, hn::Set(d, 1.00001F)));
  }
  const float* HWY_RESTRICT spread = camera.absolute_rotation.data();
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

/// What is known of the pixels of all lanes beforehand.
struct Expected {
  /// Pixels between the first and the last that any child projects to, at most.
  std::uint32_t widest_px = 0;
  bool islands = false;  ///< whether there may be some of the robot's islands among them
};

/// Rectangles of pixels, one a lane, and the few texels of one level that cover all of them.
struct Footprint {
  std::array<I, 3> column;
  std::array<I, 3> row;   ///< times the level's width
  int side = 0;           ///< how many of them there are: 1 to 3
  std::size_t level = 0;  ///< index into LocalCamera::texels
  int last = 0;           ///< pixels between the first and the last, at most
};

HWY_INLINE Footprint footprint(const LocalCamera& camera, I u0, I u1, I v0, I v1, Expected expected) {
  const Ints di;
  const auto largest =
      static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(di, hn::Max(hn::Sub(u1, u0), hn::Sub(v1, v0)))));
  // What the lanes need is never more than expected but for rounding; it must not decide, since instruction sets differ
  // in how many lanes they see at once.
  const std::uint32_t last = std::max(expected.widest_px, largest);
  // Up to three by three pixels are looked up one by one, so that not one too many counts; 6 2^l + 1 pixels lie in at
  // most eight texel columns of level l wherever they begin. The coarsest level has the whole image in eight.
  if (last <= 2) {
    const I width = hn::Set(di, camera.width_px);
    Footprint result;
    result.side = static_cast<int>(last) + 1;
    result.level = 0;
    result.last = static_cast<int>(last);
    for (int n = 0; n < result.side; ++n) {
      const auto at = static_cast<std::size_t>(n);
      result.column[at] = hn::Min(hn::Add(u0, hn::Set(di, n)), u1);
      result.row[at] = hn::Mul(hn::Min(hn::Add(v0, hn::Set(di, n)), v1), width);
    }
    return result;
  }
  const std::size_t level = std::min(1 + static_cast<std::size_t>(std::bit_width((last - 1) / 6)),
                                     static_cast<std::size_t>(camera.level_count));
  const Texels& texels = camera.texels[level];
  const I width = hn::Set(di, texels.width);
  const I back = hn::Set(di, texels.back);
  const I i0 = hn::ShiftRightSame(u0, texels.shift);
  const I j0 = hn::ShiftRightSame(v0, texels.shift);
  const I i1 = hn::Max(i0, hn::Sub(hn::ShiftRightSame(u1, texels.shift), back));
  const I j1 = hn::Max(j0, hn::Sub(hn::ShiftRightSame(v1, texels.shift), back));
  return {{i0, i1, i1}, {hn::Mul(j0, width), hn::Mul(j1, width), u0}, 2, level, static_cast<int>(last)};
}

/// The extremum of a pyramid over a footprint of its texels.
template <class Pick>
HWY_INLINE V extremum(const LocalCamera& camera, const Footprint& at, const float* pyramid, Pick pick) {
  const Floats d;
  const float* HWY_RESTRICT texels = pyramid + camera.texels[at.level].offset;
  const V upper = pick(hn::GatherIndex(d, texels, hn::Add(at.row[0], at.column[0])),
                       hn::GatherIndex(d, texels, hn::Add(at.row[0], at.column[1])));
  const V lower = pick(hn::GatherIndex(d, texels, hn::Add(at.row[1], at.column[0])),
                       hn::GatherIndex(d, texels, hn::Add(at.row[1], at.column[1])));
  return pick(upper, lower);
}

/// Lanes of `left` in whose every pixel the box is free or lies in the robot's island: such pixels lie side by side
/// where one link is seen before another.
HWY_INLINE M free_or_island_pixels(const LocalCamera& camera, M left, I u0, I u1, I v0, I v1, int side, V z_low,
                                   V z_high) {
  const Floats d;
  const Ints di;
  const View& view = *camera.view;
  const M near_blind = hn::Le(z_low, hn::Set(d, camera.blind_m));
  const I width = hn::Set(di, camera.width_px);
  for (int j = 0; j < side; ++j) {
    const I row = hn::Mul(hn::Min(hn::Add(v0, hn::Set(di, j)), v1), width);
    for (int i = 0; i < side; ++i) {
      const I pixel = hn::Add(row, hn::Min(hn::Add(u0, hn::Set(di, i)), u1));
      const M shadowed = hn::And(left, hn::Or(near_blind, hn::Ge(z_high, hn::GatherIndex(d, camera.free_m, pixel))));
      if (hn::AllFalse(d, shadowed)) {
        continue;
      }
      const V near_m = hn::GatherIndex(d, view.island_near_m().data(), pixel);
      const V far_m = hn::GatherIndex(d, view.island_far_m().data(), pixel);
      left = hn::AndNot(hn::And(shadowed, hn::Or(hn::Lt(z_low, near_m), hn::Gt(z_high, far_m))), left);
      if (hn::AllFalse(d, left)) {
        return left;
      }
    }
  }
  return left;
}

/// Lanes of `left` that lie in islands in every texel.
HWY_INLINE M island_texels(const LocalCamera& camera, M left, const Footprint& at, V z_low, V z_high) {
  const Floats d;
  const View& view = *camera.view;
  const auto min = [](V a, V b) HWY_ATTR { return hn::Min(a, b); };
  const auto max = [](V a, V b) HWY_ATTR { return hn::Max(a, b); };
  left = hn::And(left, hn::Ge(z_low, extremum(camera, at, view.island_near_maxima_m(), max)));
  if (hn::AllFalse(d, left)) {
    return left;
  }
  return hn::And(left, hn::Le(z_high, extremum(camera, at, view.island_far_minima_m(), min)));
}

/// Lanes of `asked` that the camera frees: seen free, or robot. Their rectangles lie in the image.
HWY_INLINE M freed(const LocalCamera& camera, M asked, const Rectangle& r, V z_low, V z_high, Expected expected) {
  const Floats d;
  const Ints di;
  const I u0 = hn::ConvertTo(di, hn::IfThenElseZero(asked, r.u_low));
  const I u1 = hn::ConvertTo(di, hn::IfThenElseZero(asked, r.u_high));
  const I v0 = hn::ConvertTo(di, hn::IfThenElseZero(asked, r.v_low));
  const I v1 = hn::ConvertTo(di, hn::IfThenElseZero(asked, r.v_high));
  const Footprint at = footprint(camera, u0, u1, v0, v1, expected);
  M free = hn::And(asked, hn::Gt(z_low, hn::Set(d, camera.blind_m)));
  const float* HWY_RESTRICT values = at.level == 0 ? camera.free_m : camera.minima_m + camera.texels[at.level].offset;
  for (int j = 0; j < at.side && !hn::AllFalse(d, free); ++j) {
    const I row = at.row[static_cast<std::size_t>(j)];
    V free_m = hn::GatherIndex(d, values, hn::Add(row, at.column[0]));
    for (int i = 1; i < at.side; ++i) {
      free_m = hn::Min(free_m, hn::GatherIndex(d, values, hn::Add(row, at.column[static_cast<std::size_t>(i)])));
    }
    free = hn::And(free, hn::Lt(z_high, free_m));
  }
  if (!expected.islands) {
    return free;
  }
  const M left = hn::AndNot(free, asked);
  if (hn::AllFalse(d, left)) {
    return free;
  }
  constexpr int kFewPixels = 4;
  return hn::Or(free, at.last < kFewPixels
                          ? free_or_island_pixels(camera, left, u0, u1, v0, v1, at.last + 1, z_low, z_high)
                          : island_texels(camera, left, at, z_low, z_high));
}

/// Lanes that the camera frees wholly.
HWY_INLINE M freed_whole(const LocalCamera& camera, M asked, const Bounds& b, Expected expected) {
  const Floats d;
  const V zero = hn::Zero(d);
  const M in_front = hn::Gt(b.z_low, hn::Set(d, 1e-6F));
  const Rectangle r = project(camera, b, b.z_low, b.z_high);
  const M inside =
      hn::And(hn::And(hn::And(hn::Ge(r.u_low, zero), hn::Lt(r.u_high, hn::Set(d, camera.width))), in_front),
              hn::And(hn::Ge(r.v_low, zero), hn::Lt(r.v_high, hn::Set(d, camera.height))));
  return freed(camera, hn::And(asked, inside), r, b.z_low, b.z_high, expected);
}

/// Lanes of which the camera frees the part in its view between the clip's depths; where there is no such part it is
/// free.
HWY_INLINE M freed_in_view(const LocalCamera& camera, const Clip& clip, const Bounds& b, Expected expected) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V z_low = hn::Max(b.z_low, hn::Set(d, clip.low_m));
  const V z_high = hn::Min(b.z_high, hn::Set(d, clip.high_m));
  const V tiny = hn::Set(d, 1e-6F);
  const Rectangle whole = project(camera, b, hn::Max(z_low, tiny), hn::Max(z_high, tiny));
  const M empty = hn::Or(hn::Or(hn::Or(hn::Lt(z_high, z_low), hn::Lt(z_high, tiny)),
                                hn::Or(hn::Lt(whole.u_high, zero), hn::Ge(whole.u_low, hn::Set(d, camera.width)))),
                         hn::Or(hn::Lt(whole.v_high, zero), hn::Ge(whole.v_low, hn::Set(d, camera.height))));
  if (hn::AllTrue(d, empty) || camera.has_reach) {
    return empty;
  }
  const V last_u = hn::Set(d, camera.width - 1);
  const V last_v = hn::Set(d, camera.height - 1);
  const Rectangle r{hn::Min(hn::Max(whole.u_low, zero), last_u), hn::Min(hn::Max(whole.u_high, zero), last_u),
                    hn::Min(hn::Max(whole.v_low, zero), last_v), hn::Min(hn::Max(whole.v_high, zero), last_v)};
  return hn::Or(empty, freed(camera, hn::Not(empty), r, z_low, z_high, expected));
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
  return hn::Or(hn::Or(in_depth, behind), hn::Or(beyond(b.x_low, b.x_high, (-camera.cx - camera.guard_px) / camera.fx,
                                                        (camera.width - camera.cx + camera.guard_px) / camera.fx),
                                                 beyond(b.y_low, b.y_high, (-camera.cy - camera.guard_px) / camera.fy,
                                                        (camera.height - camera.cy + camera.guard_px) / camera.fy)));
}

HWY_INLINE V length(V x, V y, V z) { return hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z))); }

HWY_INLINE V clamp(V x, V low, V high) { return hn::Min(hn::Max(x, low), high); }

/// The axis and the boxes.
struct Proximities {
  V distance;  ///< no point of the box is nearer to the axis
  /// A point at that distance from the axis, towards the box's centre: where an answer of that distance may point to.
  V near_x, near_y, near_z;
};

HWY_INLINE Proximities proximities(const Axis& axis, const Boxes& boxes) {
  const Floats d;
  const V zero = hn::Zero(d);
  V px = hn::Set(d, axis.a[0]);
  V py = hn::Set(d, axis.a[1]);
  V pz = hn::Set(d, axis.a[2]);
  const bool segment = axis.inverse_square != 0;
  if (segment) {
    const V ax = hn::Sub(boxes.x, px);
    const V ay = hn::Sub(boxes.y, py);
    const V az = hn::Sub(boxes.z, pz);
    const V t0 = hn::Mul(weighted(axis.along.data(), ax, ay, az), hn::Set(d, axis.inverse_square));
    const V t = clamp(t0, zero, hn::Set(d, 1.0F));
    px = hn::Add(px, hn::Mul(t, hn::Set(d, axis.along[0])));
    py = hn::Add(py, hn::Mul(t, hn::Set(d, axis.along[1])));
    pz = hn::Add(pz, hn::Mul(t, hn::Set(d, axis.along[2])));
  }
  const V x = hn::Sub(boxes.x, px);
  const V y = hn::Sub(boxes.y, py);
  const V z = hn::Sub(boxes.z, pz);
  const V to_centre = length(x, y, z);
  Proximities result;
  if (segment) {
    // The ball around the box: another point of the axis may be nearer to the box than the one nearest to its centre.
    result.distance = hn::Max(hn::Sub(to_centre, boxes.half_diagonal), zero);
  } else {
    result.distance =
        length(hn::Max(hn::Sub(hn::Abs(x), boxes.half_x), zero), hn::Max(hn::Sub(hn::Abs(y), boxes.half_y), zero),
               hn::Max(hn::Sub(hn::Abs(z), boxes.half_z), zero));
  }
  const V share = hn::Div(result.distance, hn::Max(to_centre, hn::Set(d, 1e-9F)));
  result.near_x = hn::Add(px, hn::Mul(x, share));
  result.near_y = hn::Add(py, hn::Mul(y, share));
  result.near_z = hn::Add(pz, hn::Mul(z, share));
  return result;
}

/// Lanes around whose point a camera may have not-free space within slack and reach: the point lies out of its view, or
/// its pixel or one of the three nearest to it begins to be not free near enough. With t the tangent of the angle
/// between ray and optical axis, c its cosine and s the lateral distance to the pixel, a depth h beyond the point is
/// near enough on the worst side if (s + t h)^2 + h^2 <= slack^2, which is h <= c sqrt(slack^2 - s^2 c^2) - s t c^2.
HWY_INLINE M touches(const LocalCamera& camera, V x_local, V y_local, V z_local, float slack_m) {
  const Floats d;
  const Ints di;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0F);
  const V x = hn::Add(weighted(camera.rotation.data(), x_local, y_local, z_local), hn::Set(d, camera.offset_m[0]));
  const V y = hn::Add(weighted(camera.rotation.data() + 3, x_local, y_local, z_local), hn::Set(d, camera.offset_m[1]));
  const V z = hn::Add(weighted(camera.rotation.data() + 6, x_local, y_local, z_local), hn::Set(d, camera.offset_m[2]));
  const V range = length(x, y, z);
  V slack = hn::Set(d, slack_m);
  if (camera.has_reach) {
    slack = hn::Add(slack, hn::Add(hn::Set(d, camera.reach_m), hn::Mul(hn::Set(d, camera.reach_per_m), range)));
  }
  const V inverse = hn::Div(one, z);
  const V u = hn::Add(hn::Mul(hn::Mul(x, inverse), hn::Set(d, camera.fx)), hn::Set(d, camera.cx));
  const V v = hn::Add(hn::Mul(hn::Mul(y, inverse), hn::Set(d, camera.fy)), hn::Set(d, camera.cy));
  const M in_view = hn::And(hn::And(hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, camera.width))),
                                    hn::And(hn::Ge(v, zero), hn::Lt(v, hn::Set(d, camera.height)))),
                            hn::Gt(z, hn::Set(d, camera.blind_m)));
  const V inside_u = hn::IfThenElseZero(in_view, u);
  const V inside_v = hn::IfThenElseZero(in_view, v);
  const I column = hn::ConvertTo(di, inside_u);
  const I row = hn::ConvertTo(di, inside_v);
  const V part_u = hn::Sub(inside_u, hn::ConvertTo(d, column));
  const V part_v = hn::Sub(inside_v, hn::ConvertTo(d, row));
  // The neighbour on the nearer side; at the image's edge the pixel itself, which is no less true.
  const V half = hn::Set(d, 0.5F);
  const auto beside = [&](V coordinate, V part, float size) HWY_ATTR {
    const V next = hn::Add(coordinate, hn::IfThenElse(hn::Lt(part, half), hn::Neg(one), one));
    return hn::ConvertTo(di, clamp(next, zero, hn::Set(d, size - 1)));
  };
  const I column1 = beside(inside_u, part_u, camera.width);
  const I row1 = beside(inside_v, part_v, camera.height);
  const V side_u = hn::Mul(hn::Min(part_u, hn::Sub(one, part_u)), hn::Mul(z, hn::Set(d, 1.0F / camera.fx)));
  const V side_v = hn::Mul(hn::Min(part_v, hn::Sub(one, part_v)), hn::Mul(z, hn::Set(d, 1.0F / camera.fy)));
  const V cosine = hn::Div(z, range);
  const V square = hn::Mul(cosine, cosine);
  const V slant = hn::Sqrt(hn::Max(hn::Sub(one, square), zero));  // t c
  const auto reaches = [&](V free_m, V side) HWY_ATTR {
    const V rest = hn::Sub(hn::Mul(slack, slack), hn::Mul(hn::Mul(side, side), square));
    const V depth = hn::Sub(hn::Mul(cosine, hn::Sqrt(hn::Max(rest, zero))), hn::Mul(hn::Mul(side, slant), cosine));
    return hn::And(hn::Le(side, slack), hn::Le(free_m, hn::Add(z, hn::Max(depth, zero))));
  };
  const I width = hn::Set(di, camera.width_px);
  const I line0 = hn::Mul(row, width);
  const I line1 = hn::Mul(row1, width);
  const float* HWY_RESTRICT values = camera.free_m;
  const M own = reaches(hn::GatherIndex(d, values, hn::Add(line0, column)), zero);
  const M by_column = reaches(hn::GatherIndex(d, values, hn::Add(line0, column1)), side_u);
  const M by_row = reaches(hn::GatherIndex(d, values, hn::Add(line1, column)), side_v);
  return hn::Or(hn::Not(in_view), hn::Or(own, hn::Or(by_column, by_row)));
}

/// The cubes that are split together.
struct Family {
  const Cube* parents;
  int count;
  float half_m;  ///< of the children

  /// From the parents alone, in the same scalar arithmetic for every instruction set.
  [[nodiscard]] Expected expect(const LocalCamera& camera) const {
    Expected result;
    for (int i = 0; i < count; ++i) {
      const Cube& c = parents[i];
      const auto& r = camera.rotation;
      const auto& a = camera.absolute_rotation;
      const float x = r[0] * c.x + r[1] * c.y + r[2] * c.z + camera.offset_m[0];
      const float y = r[3] * c.x + r[4] * c.y + r[5] * c.z + camera.offset_m[1];
      const float z = r[6] * c.x + r[7] * c.y + r[8] * c.z + camera.offset_m[2];
      float grown = 2 * camera.guard_m;
      if (camera.has_reach) {
        // A child that W cuts has its centre up to 3.5 half sides from the parent's.
        const float range = std::sqrt(x * x + y * y + z * z) + 6 * half_m;
        grown += (camera.reach_m + camera.reach_per_m * range) * 1.0001F;
      }
      const float spread_x = (a[0] + a[1] + a[2]) * half_m;
      const float spread_y = (a[3] + a[4] + a[5]) * half_m;
      const float spread_z = (a[6] + a[7] + a[8]) * half_m;
      const float z_low = z - 2 * spread_z - grown;  // of the parent
      if (!(z_low > 1e-3F)) {
        return {1U << 20U, camera.has_islands};  // the coarsest level
      }
      // A box of half sides h at x has its edges at (x +- h_x) / (z -+ h_z).
      const float half_z = spread_z + grown;
      const float fx = camera.fx / z_low;
      const float fy = camera.fy / z_low;
      const float wide = 2 * fx * (spread_x + grown + (std::abs(x) + 2 * spread_x + grown) / z_low * half_z);
      const float high = 2 * fy * (spread_y + grown + (std::abs(y) + 2 * spread_y + grown) / z_low * half_z);
      const float side = std::min(std::max(wide, high) * 1.0001F + 4 * camera.guard_px, 1e5F);
      result.widest_px = std::max(result.widest_px, static_cast<std::uint32_t>(side) + 1);
      if (camera.has_islands && !result.islands) {
        // |X / Z - x / z| <= (|X - x| + |x| / z |Z - z|) / Z.
        const float parent_z = 2 * spread_z + grown;
        const float around_u = fx * (2 * spread_x + grown + std::abs(x) / z * parent_z) * 1.0001F + 4 * camera.guard_px;
        const float around_v = fy * (2 * spread_y + grown + std::abs(y) / z * parent_z) * 1.0001F + 4 * camera.guard_px;
        const float u = camera.fx * x / z + camera.cx;
        const float v = camera.fy * y / z + camera.cy;
        result.islands = may_have_islands(camera, u - around_u, u + around_u, v - around_v, v + around_v);
      }
    }
    return result;
  }

  /// Of a rectangle in continuous coordinates.
  [[nodiscard]] static bool may_have_islands(const LocalCamera& camera, float u_low, float u_high, float v_low,
                                             float v_high) {
    if (!(u_low < camera.width && u_high >= 0 && v_low < camera.height && v_high >= 0)) {
      return false;
    }
    const auto pixel = [](float at, float size) { return static_cast<int>(std::clamp(at, 0.0F, size - 1)); };
    const PixelRange columns{pixel(u_low, camera.width), pixel(u_high, camera.width) + 1};
    const int last = pixel(v_high, camera.height) / View::kBandRows;
    for (int band = pixel(v_low, camera.height) / View::kBandRows; band <= last; ++band) {
      if (!common(columns, camera.island_bands[band]).empty()) {
        return true;
      }
    }
    return false;
  }
};

/// Lanes of `open` that stay open after every camera has been asked.
HWY_INLINE M not_freed(CubeQuery& query, const Family& family, const Boxes& boxes, M open) {
  const Floats d;
  const V zero = hn::Zero(d);
  M uncovered = query.uncovered_ignored ? open : hn::Lt(zero, zero);
  for (std::size_t n = 0; n < query.camera_count; ++n) {
    const std::uint8_t k = query.order[n];
    const LocalCamera& camera = query.cameras[k];
    const Bounds bounds = bounds_in(camera, boxes);
    const Expected expected = family.expect(camera);
    M gone = freed_whole(camera, open, bounds, expected);
    // W and what a camera covers have nothing to do with its reach.
    const bool plain = query.principal == static_cast<int>(k) || query.uncovered_ignored;
    const Bounds own = plain && camera.has_reach ? bounds_in(camera, boxes, false) : bounds;
    if (query.principal == static_cast<int>(k)) {
      gone = hn::Or(gone, outside_view(query, camera, own));
    }
    if (camera.space.to_view) {
      gone = hn::Or(gone, freed_in_view(camera, camera.space, bounds, expected));
    }
    if (query.uncovered_ignored) {
      uncovered = hn::And(uncovered, freed_in_view(camera, camera.coverage, own, expected));
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

HWY_INLINE std::uint32_t bits_of(M mask) {
  const Floats d;
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, mask, bytes.data());
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8U;
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

/// Lanes of `open` whose point nearest to the axis seems to lie at or near not-free space in every camera.
HWY_INLINE std::uint32_t touching(const CubeQuery& query, const Axis& axis, const Boxes& boxes, std::uint32_t lanes) {
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
  const Family family{parents, parent_count, half_m};
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
    open = not_freed(query, family, boxes, open);
    // Lanes of the parents that there are, and of each primitive those whose parent asks for it.
    const std::uint32_t open_bits = bits_of(open) & ((0xFFU | second_lanes) >> first);
    if (open_bits == 0) {
      continue;
    }
    std::array<int, kSplit> child_of;  // NOLINT(*-member-init): as above
    for (std::uint32_t rest = open_bits; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      child_of[lane] = children.count;
      children.touching[static_cast<std::size_t>(children.count)] = 0;
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
      for (std::uint32_t lanes = touching(query, query.axes[i], boxes, mine); lanes != 0; lanes &= lanes - 1) {
        children.touching[static_cast<std::size_t>(child_of[static_cast<std::size_t>(std::countr_zero(lanes))])] |=
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
