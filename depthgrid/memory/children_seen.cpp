#include <algorithm>
#include <bit>
#include <limits>

#include "depthgrid/memory/carving.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/memory/children_seen.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: they must be seen once for each target.
#include "depthgrid/views/known_free-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::memory::HWY_NAMESPACE {

using namespace views::octants::HWY_NAMESPACE;

/// The largest of the texels that cover the rectangles of pixels: a few too many, so never too small.
HWY_INLINE V most_free(const FreeMaxima& maxima, I u0, I u1, I v0, I v1) {
  const Floats d;
  const Ints di;
  const I largest = hn::MaxOfLanes(di, hn::Max(hn::Sub(u1, u0), hn::Sub(v1, v0)));
  const auto span = static_cast<std::uint32_t>(hn::GetLane(largest));
  // 2^shift pixels and fewer lie in at most two texels of that side.
  std::size_t n = 0;
  while (n + 1 < maxima.levels().size() && (span >> maxima.levels()[n].shift) != 0) {
    ++n;
  }
  const FreeMaxima::Level& level = maxima.levels()[n];
  const float* HWY_RESTRICT texels = maxima.texels_m() + level.offset;
  const I width = hn::Set(di, level.width);
  const I i0 = hn::ShiftRightSame(u0, level.shift);
  const I i1 = hn::ShiftRightSame(u1, level.shift);
  const I j0 = hn::Mul(hn::ShiftRightSame(v0, level.shift), width);
  const I j1 = hn::Mul(hn::ShiftRightSame(v1, level.shift), width);
  return hn::Max(hn::Max(hn::GatherIndex(d, texels, hn::Add(j0, i0)), hn::GatherIndex(d, texels, hn::Add(j0, i1))),
                 hn::Max(hn::GatherIndex(d, texels, hn::Add(j1, i0)), hn::GatherIndex(d, texels, hn::Add(j1, i1))));
}

/// Lanes in which no ball around any point of the box is free: the point itself is not in the image or in the blind
/// zone, or the ball's point behind it, in the same pixel, lies beyond what any pixel of the box has free.
HWY_INLINE M none_is_free(const Carver& carver, const Boxes& boxes) {
  const Floats d;
  const Ints di;
  const V zero = hn::Zero(d);
  const views::LocalCamera& camera = carver.camera;
  const Bounds b = bounds_in(camera, boxes, false);
  const V tiny = hn::Set(d, 1e-3F);
  const M in_front = hn::Gt(b.z_low, tiny);
  const V z_low = hn::Max(b.z_low, tiny);
  const Rectangle r = project(camera, b, z_low, hn::Max(b.z_high, tiny));
  const V last_u = hn::Set(d, camera.width - 1);
  const V last_v = hn::Set(d, camera.height - 1);
  const M outside =
      hn::And(in_front, hn::Or(hn::Or(hn::Lt(r.u_high, zero), hn::Ge(r.u_low, hn::Set(d, camera.width))),
                               hn::Or(hn::Lt(r.v_high, zero), hn::Ge(r.v_low, hn::Set(d, camera.height)))));
  // The robot may be seen in the blind zone.
  const M behind = hn::Lt(b.z_high, hn::Set(d, camera.has_islands ? 0.0F : camera.blind_m));
  const I u0 = hn::ConvertTo(di, hn::Min(hn::Max(r.u_low, zero), last_u));
  const I u1 = hn::ConvertTo(di, hn::Min(hn::Max(r.u_high, zero), last_u));
  const I v0 = hn::ConvertTo(di, hn::Min(hn::Max(r.v_low, zero), last_v));
  const I v1 = hn::ConvertTo(di, hn::Min(hn::Max(r.v_high, zero), last_v));
  const auto farther = [&](V low, V high) HWY_ATTR { return hn::Max(hn::Abs(low), hn::Abs(high)); };
  const V range = length(farther(b.x_low, b.x_high), farther(b.y_low, b.y_high), farther(b.z_low, b.z_high));
  const V behind_m = hn::Mul(hn::Div(z_low, range), hn::Set(d, carver.least_radius_m));
  const V reached = hn::Mul(hn::Add(z_low, behind_m), hn::Set(d, 0.99999F));
  const M beyond = hn::And(in_front, hn::Lt(most_free(*carver.maxima, u0, u1, v0, v1), reached));
  return hn::Or(hn::Or(outside, behind), beyond);
}

/// Balls around single voxels, one a lane, in the camera's frame.
struct Balls {
  V x, y, z, range, radius;
};

HWY_INLINE Balls balls_around(const Carver& carver, V x_local, V y_local, V z_local) {
  const Floats d;
  const views::LocalCamera& camera = carver.camera;
  const auto in_camera = [&](std::size_t row) HWY_ATTR {
    return hn::Add(weighted(camera.rotation.data() + 3 * row, x_local, y_local, z_local),
                   hn::Set(d, camera.offset_m[row]));
  };
  Balls balls{in_camera(0), in_camera(1), in_camera(2), hn::Zero(d), hn::Zero(d)};
  balls.range = length(balls.x, balls.y, balls.z);
  balls.radius = hn::Add(hn::Set(d, camera.pose_error_m), hn::Mul(hn::Set(d, camera.pose_error_per_m), balls.range));
  return balls;
}

/// Lanes of `asked` in which the ball's point (x + right, y + down) of depth z + behind, all in radii, lies in a pixel
/// that shows nothing free there. Points a little within the ball, so that their pixels need no guard.
HWY_INLINE M shows_not_free(const views::LocalCamera& camera, const Balls& b, M asked, float right, float down,
                            V behind) {
  const Floats d;
  const Ints di;
  const V by_z = hn::Div(hn::Set(d, 1.0F), b.z);
  const auto pixel = [&](V x, float away, float f, float c, float size) HWY_ATTR {
    const V at =
        hn::Add(hn::Mul(hn::Mul(hn::Add(x, hn::Mul(hn::Set(d, away), b.radius)), by_z), hn::Set(d, f)), hn::Set(d, c));
    return hn::ConvertTo(di, hn::IfThenElseZero(asked, clamp(at, hn::Zero(d), hn::Set(d, size - 1))));
  };
  const I u = pixel(b.x, right, camera.fx, camera.cx, camera.width);
  const I v = pixel(b.y, down, camera.fy, camera.cy, camera.height);
  const I at = hn::Add(hn::Mul(v, hn::Set(di, camera.width_px)), u);
  V free_m = hn::GatherIndex(d, camera.free_m, at);
  if (camera.has_islands) {
    free_m = hn::Max(free_m, hn::GatherIndex(d, camera.image->island_far_m.data(), at));
  }
  return hn::And(asked, hn::Lt(free_m, hn::Add(b.z, behind)));
}

/// Lanes of `asked` in which some pixel in the middle of the ball's disc shows nothing free at its centre's depth:
/// where single pixels have no reading, mostly. Not where the robot is near.
HWY_INLINE M middle_shows_not_free(const views::LocalCamera& camera, const Balls& b, M asked) {
  const Floats d;
  const Ints di;
  const V by_z = hn::Div(hn::Set(d, 1.0F), b.z);
  const V disc = hn::Mul(hn::Mul(b.radius, by_z), hn::Set(d, std::min(camera.fx, camera.fy)));
  const float radius_px = hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(asked, disc, hn::Set(d, 1e5F))));
  // A texel of 4 n pixels that begins at a multiple of n, up to n before two of them to the left of the centre, has
  // pixels up to 3 n away, and sqrt(2) times that across.
  const float n_px = (radius_px - 2) / 4.25F;
  if (!(n_px >= 1)) {
    return hn::Lt(hn::Zero(d), hn::Zero(d));
  }
  const auto level = std::min(static_cast<std::size_t>(std::bit_width(static_cast<std::uint32_t>(n_px))),
                              static_cast<std::size_t>(camera.level_count));
  const views::Texels& texels = camera.texels[level];
  const I back = hn::Set(di, 2 << texels.shift);
  const auto first = [&](V x, float f, float c) HWY_ATTR {
    const V at = hn::Add(hn::Mul(hn::Mul(x, by_z), hn::Set(d, f)), hn::Set(d, c));
    const I pixel = hn::ConvertTo(di, hn::IfThenElseZero(asked, hn::Max(at, hn::Zero(d))));
    return hn::ShiftRightSame(hn::Max(hn::Sub(pixel, back), hn::Zero(di)), texels.shift);
  };
  const I at =
      hn::Add(hn::Mul(first(b.y, camera.fy, camera.cy), hn::Set(di, texels.width)), first(b.x, camera.fx, camera.cx));
  if (camera.has_islands) {
    const V nearest = hn::GatherIndex(d, camera.image->second_near_maxima_m.data() + texels.offset, at);
    asked = hn::And(asked, hn::Gt(nearest, hn::Set(d, std::numeric_limits<float>::max())));
  }
  return hn::And(asked, hn::Lt(hn::GatherIndex(d, camera.minima_m + texels.offset, at), b.z));
}

/// Lanes of `asked` whose balls are free as far as the rectangle of pixels tells that they project to, and lanes whose
/// balls certainly are not. The rest needs the exact test.
HWY_INLINE void ask_balls(const views::LocalCamera& camera, const Balls& b, M asked, M& free, M& undecided) {
  const Floats d;
  const Ints di;
  const V zero = hn::Zero(d);
  const V guard = hn::Set(d, camera.guard_m);
  const V grown = hn::Add(b.radius, guard);
  const V z_low = hn::Sub(b.z, grown);
  const V z_high = hn::Add(b.z, grown);
  free = hn::Lt(zero, zero);
  // With the robot in the blind zone, or a ball about the camera's plane, the exact test knows.
  const M before = hn::Gt(z_low, hn::Set(d, std::max(camera.blind_m, 1e-3F)));
  const M nearly_before = hn::Gt(hn::Add(z_low, hn::Mul(guard, hn::Set(d, 4.0F))), hn::Set(d, camera.blind_m));
  undecided = hn::AndNot(before, camera.has_islands ? asked : hn::And(asked, nearly_before));
  asked = hn::And(asked, before);
  // Tangents from the camera's centre: exact, with the squares' rounding in the guard.
  const V square = hn::Mul(grown, grown);
  const V by = hn::Div(hn::Set(d, 1.0F), hn::Max(hn::Sub(hn::Mul(b.z, b.z), square), hn::Set(d, 1e-9F)));
  const auto tangents = [&](V x, float f, float c, V& low, V& high) HWY_ATTR {
    const V rest = hn::Max(hn::Sub(hn::Add(hn::Mul(x, x), hn::Mul(b.z, b.z)), square), zero);
    const V root = hn::Mul(grown, hn::Sqrt(rest));
    const V product = hn::Mul(x, b.z);
    const V scale = hn::Mul(hn::Set(d, f), by);
    low = hn::Add(hn::Mul(hn::Sub(product, root), scale), hn::Set(d, c - 2 * camera.guard_px));
    high = hn::Add(hn::Mul(hn::Add(product, root), scale), hn::Set(d, c + 2 * camera.guard_px));
  };
  V u_low, u_high, v_low, v_high;  // NOLINT(*-isolate-declaration, *-init-variables): written at once
  tangents(b.x, camera.fx, camera.cx, u_low, u_high);
  tangents(b.y, camera.fy, camera.cy, v_low, v_high);
  const M inside = hn::And(hn::And(hn::Ge(u_low, zero), hn::Lt(u_high, hn::Set(d, camera.width))),
                           hn::And(hn::Ge(v_low, zero), hn::Lt(v_high, hn::Set(d, camera.height))));
  // Nearly in the image: within the guards.
  const V wide = hn::Set(d, 8 * camera.guard_px);
  const M nearly =
      hn::And(hn::And(hn::Ge(u_low, hn::Sub(zero, wide)), hn::Lt(u_high, hn::Add(hn::Set(d, camera.width), wide))),
              hn::And(hn::Ge(v_low, hn::Sub(zero, wide)), hn::Lt(v_high, hn::Add(hn::Set(d, camera.height), wide))));
  undecided = hn::Or(undecided, hn::And(asked, hn::AndNot(inside, nearly)));
  asked = hn::And(asked, inside);
  const V behind = hn::Mul(hn::Div(b.z, b.range), hn::Mul(b.radius, hn::Set(d, 0.999F)));
  asked = hn::AndNot(shows_not_free(camera, b, asked, 0, 0, behind), asked);
  asked = hn::AndNot(middle_shows_not_free(camera, b, asked), asked);
  if (hn::AllFalse(d, asked)) {
    return;
  }
  const I u0 = hn::ConvertTo(di, hn::IfThenElseZero(asked, u_low));
  const I u1 = hn::ConvertTo(di, hn::IfThenElseZero(asked, u_high));
  const I v0 = hn::ConvertTo(di, hn::IfThenElseZero(asked, v_low));
  const I v1 = hn::ConvertTo(di, hn::IfThenElseZero(asked, v_high));
  const auto last =
      static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(di, hn::Max(hn::Sub(u1, u0), hn::Sub(v1, v0)))));
  // Three texels of a level, of which each begins 2^level after the one before and is four times as wide, cover 10
  // 2^level + 1 pixels wherever they begin.
  const std::size_t level =
      std::min(1 + static_cast<std::size_t>(std::bit_width(last / 10)), static_cast<std::size_t>(camera.level_count));
  const views::Texels& texels = camera.texels[level];
  const float* HWY_RESTRICT values = camera.minima_m + texels.offset;
  const I width = hn::Set(di, texels.width);
  const I back = hn::Set(di, 3);
  const I four = hn::Set(di, 4);
  const I i0 = hn::ShiftRightSame(u0, texels.shift);
  const I j0 = hn::ShiftRightSame(v0, texels.shift);
  const I i2 = hn::Max(i0, hn::Sub(hn::ShiftRightSame(u1, texels.shift), back));
  const I j2 = hn::Max(j0, hn::Sub(hn::ShiftRightSame(v1, texels.shift), back));
  const std::array<I, 3> columns{i0, hn::Min(hn::Add(i0, four), i2), i2};
  const std::array<I, 3> rows{hn::Mul(j0, width), hn::Mul(hn::Min(hn::Add(j0, four), j2), width), hn::Mul(j2, width)};
  M all = asked;
  for (const I row : rows) {
    V free_m = hn::GatherIndex(d, values, hn::Add(row, columns[0]));
    free_m = hn::Min(free_m, hn::GatherIndex(d, values, hn::Add(row, columns[1])));
    free_m = hn::Min(free_m, hn::GatherIndex(d, values, hn::Add(row, columns[2])));
    all = hn::And(all, hn::Lt(z_high, free_m));
    if (hn::AllFalse(d, all)) {
      break;
    }
  }
  free = all;
  asked = hn::AndNot(all, asked);
  // Where things end beside the ball.
  constexpr float kRim = 0.98F;
  constexpr float kCorner = 0.45F;
  // 0.64 radii across and this along the pixel's ray are less than one.
  const V along = hn::Mul(behind, hn::Set(d, 0.3F));
  for (int i = 0; i < 8 && !hn::AllFalse(d, asked); ++i) {
    const float sign = (i & 1) != 0 ? 1.0F : -1.0F;
    const float other = (i & 2) != 0 ? 1.0F : -1.0F;
    const bool corner = i >= 4;
    const float right = corner ? kCorner * sign : (i < 2 ? kRim * sign : 0.0F);
    const float down = corner ? kCorner * other : (i < 2 ? 0.0F : kRim * sign);
    asked = hn::AndNot(shows_not_free(camera, b, asked, right, down, corner ? along : zero), asked);
  }
  undecided = hn::Or(undecided, asked);
}

ChildrenSeen look_at_voxels(const Carver& carver, const views::Cube& parent, float offset_m, std::uint32_t asked) {
  const Floats d;
  const V offset = hn::Set(d, offset_m);
  ChildrenSeen result;
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    const std::uint32_t here = (asked >> first) & ((1U << hn::Lanes(d)) - 1U);
    if (here == 0) {
      continue;
    }
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(here)};
    const Balls balls = balls_around(carver, child_centre(parent.x, kSignX.data() + first, offset),
                                     child_centre(parent.y, kSignY.data() + first, offset),
                                     child_centre(parent.z, kSignZ.data() + first, offset));
    M free = hn::LoadMaskBits(d, bytes.data());
    M undecided = free;
    ask_balls(carver.camera, balls, hn::LoadMaskBits(d, bytes.data()), free, undecided);
    result.free |= bits_of(free) << first;
    result.undecided |= bits_of(undecided) << first;
  }
  return result;
}

ChildrenSeen look(const Carver& carver, const views::Cube& parent, float offset_m, float half_m, std::uint32_t asked) {
  const Floats d;
  const V offset = hn::Set(d, offset_m);
  if (half_m == 0) {
    return look_at_voxels(carver, parent, offset_m, asked);
  }
  const V half = hn::Set(d, half_m);
  ChildrenSeen result;
  const views::PixelBounds pixels = pixel_bounds(carver.camera, parent, offset_m);
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    const std::uint32_t here = (asked >> first) & ((1U << hn::Lanes(d)) - 1U);
    if (here == 0) {
      continue;
    }
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(here)};
    const M wanted = hn::LoadMaskBits(d, bytes.data());
    const Boxes boxes{child_centre(parent.x, kSignX.data() + first, offset),
                      child_centre(parent.y, kSignY.data() + first, offset),
                      child_centre(parent.z, kSignZ.data() + first, offset),
                      half,
                      half,
                      half,
                      hn::Set(d, half_m * 1.7320509F)};
    const M open = hn::AndNot(none_is_free(carver, boxes), wanted);
    if (hn::AllFalse(d, open)) {
      continue;
    }
    const M free = known_free_whole(carver.camera, open, bounds_in(carver.camera, boxes), pixels);
    result.free |= bits_of(free) << first;
    result.undecided |= bits_of(hn::AndNot(free, open)) << first;
  }
  return result;
}

}  // namespace depthgrid::memory::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::memory {

HWY_EXPORT(look);

ChildrenSeen look_at_children(const Carver& carver, const views::Cube& parent, float offset_m, float half_m,
                              std::uint32_t asked) noexcept {
  return HWY_DYNAMIC_DISPATCH(look)(carver, parent, offset_m, half_m, asked);
}

}  // namespace depthgrid::memory
#endif
