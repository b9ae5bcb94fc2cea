// Which boxes a camera knows to be free. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_VIEWS_KNOWN_FREE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_VIEWS_KNOWN_FREE_INL
#undef DEPTHGRID_VIEWS_KNOWN_FREE_INL
#else
#define DEPTHGRID_VIEWS_KNOWN_FREE_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "depthgrid/views/boxes-inl.hpp"
#include "depthgrid/views/pixel_bounds.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::octants::HWY_NAMESPACE {

/// Rectangles of pixels, one a lane, and the few texels of one level that cover all of them.
struct Footprint {
  std::array<I, 3> column;
  std::array<I, 3> row;   ///< times the level's width
  int side = 0;           ///< how many of them there are: 1 to 3
  std::size_t level = 0;  ///< index into LocalCamera::texels
  int last = 0;           ///< pixels between the first and the last, at most: the same for every instruction set
  int last_here = 0;      ///< the same of these lanes
};

HWY_INLINE Footprint footprint(const LocalCamera& camera, I u0, I u1, I v0, I v1, PixelBounds pixels) {
  const Ints di;
  const auto largest =
      static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(di, hn::Max(hn::Sub(u1, u0), hn::Sub(v1, v0)))));
  // What the lanes need is never more than these bounds but for rounding; it must not decide, since instruction sets
  // differ in how many lanes they see at once.
  const std::uint32_t last = std::max(pixels.widest_px, largest);
  // Up to three by three pixels are looked up one by one, so that not one too many counts; 6 2^l + 1 pixels lie in at
  // most eight texel columns of level l wherever they begin. The coarsest level has the whole image in eight.
  if (last <= 2) {
    const I width = hn::Set(di, camera.width_px);
    Footprint result;
    // Of pixels one by one it makes no difference how many more the other lanes have.
    result.side = static_cast<int>(largest) + 1;
    result.level = 0;
    result.last = static_cast<int>(last);
    result.last_here = static_cast<int>(largest);
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
  return {{i0, i1, i1},
          {hn::Mul(j0, width), hn::Mul(j1, width), u0},
          2,
          level,
          static_cast<int>(last),
          static_cast<int>(largest)};
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
  const PreparedImage& image = *camera.image;
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
      const V near_m = hn::GatherIndex(d, image.island_near_m.data(), pixel);
      const V far_m = hn::GatherIndex(d, image.island_far_m.data(), pixel);
      left = hn::AndNot(hn::And(shadowed, hn::Or(hn::Lt(z_low, near_m), hn::Gt(z_high, far_m))), left);
      if (hn::AllFalse(d, left)) {
        return left;
      }
    }
  }
  return left;
}

/// Lanes of `left` that lie in the second interval of every pixel of every texel.
HWY_INLINE M in_second_interval(const LocalCamera& camera, M left, const Footprint& at, V z_low, V z_high) {
  const Floats d;
  const PreparedImage& image = *camera.image;
  const auto min = [](V a, V b) HWY_ATTR { return hn::Min(a, b); };
  const auto max = [](V a, V b) HWY_ATTR { return hn::Max(a, b); };
  left = hn::And(left, hn::Ge(z_low, extremum(camera, at, image.second_near_maxima_m.data(), max)));
  if (hn::AllFalse(d, left)) {
    return left;
  }
  return hn::And(left, hn::Lt(z_high, extremum(camera, at, image.second_far_minima_m.data(), min)));
}

/// Lanes of `asked` that are known free to the camera: seen free, or robot. Their rectangles lie in the image.
HWY_INLINE M known_free(const LocalCamera& camera, M asked, const Rectangle& r, V z_low, V z_high, PixelBounds pixels) {
  const Floats d;
  const Ints di;
  const I u0 = hn::ConvertTo(di, hn::IfThenElseZero(asked, r.u_low));
  const I u1 = hn::ConvertTo(di, hn::IfThenElseZero(asked, r.u_high));
  const I v0 = hn::ConvertTo(di, hn::IfThenElseZero(asked, r.v_low));
  const I v1 = hn::ConvertTo(di, hn::IfThenElseZero(asked, r.v_high));
  const Footprint at = footprint(camera, u0, u1, v0, v1, pixels);
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
  if (!pixels.islands) {
    return free;
  }
  const M left = hn::AndNot(free, asked);
  if (hn::AllFalse(d, left)) {
    return free;
  }
  constexpr int kFewPixels = 4;
  return hn::Or(free, at.last < kFewPixels
                          ? free_or_island_pixels(camera, left, u0, u1, v0, v1, at.last_here + 1, z_low, z_high)
                          : in_second_interval(camera, left, at, z_low, z_high));
}

/// Lanes that are known free to the camera as a whole.
HWY_INLINE M known_free_whole(const LocalCamera& camera, M asked, const Bounds& b, PixelBounds pixels) {
  const Floats d;
  const V zero = hn::Zero(d);
  const M in_front = hn::Gt(b.z_low, hn::Set(d, 1e-6F));
  const Rectangle r = project(camera, b, b.z_low, b.z_high);
  const M inside =
      hn::And(hn::And(hn::And(hn::Ge(r.u_low, zero), hn::Lt(r.u_high, hn::Set(d, camera.width))), in_front),
              hn::And(hn::Ge(r.v_low, zero), hn::Lt(r.v_high, hn::Set(d, camera.height))));
  return known_free(camera, hn::And(asked, inside), r, b.z_low, b.z_high, pixels);
}

/// Lanes whose part in the camera's view, between the clip's depths, is known free to it; so is no part at all.
HWY_INLINE M known_free_in_view(const LocalCamera& camera, const Clip& clip, const Bounds& b, PixelBounds pixels) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V z_low = hn::Max(b.z_low, hn::Set(d, clip.low_m));
  const V z_high = hn::Min(b.z_high, hn::Set(d, clip.high_m));
  const V tiny = hn::Set(d, kFirstDepth_m);
  const Rectangle whole = project(camera, b, hn::Max(z_low, tiny), hn::Max(z_high, tiny));
  const M empty = hn::Or(hn::Or(hn::Or(hn::Lt(z_high, z_low), hn::Lt(z_high, tiny)),
                                hn::Or(hn::Lt(whole.u_high, zero), hn::Ge(whole.u_low, hn::Set(d, camera.width)))),
                         hn::Or(hn::Lt(whole.v_high, zero), hn::Ge(whole.v_low, hn::Set(d, camera.height))));
  if (hn::AllTrue(d, empty) || camera.has_pose_error) {
    return empty;
  }
  const V last_u = hn::Set(d, camera.width - 1);
  const V last_v = hn::Set(d, camera.height - 1);
  const Rectangle r{hn::Min(hn::Max(whole.u_low, zero), last_u), hn::Min(hn::Max(whole.u_high, zero), last_u),
                    hn::Min(hn::Max(whole.v_low, zero), last_v), hn::Min(hn::Max(whole.v_high, zero), last_v)};
  return hn::Or(empty, known_free(camera, hn::Not(empty), r, z_low, z_high, pixels));
}

}  // namespace depthgrid::views::octants::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
