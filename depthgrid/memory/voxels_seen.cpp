#include <algorithm>
#include <bit>
#include <cmath>

#include "depthgrid/memory/carving.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/memory/voxels_seen.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: they must be seen once for each target.
#include "depthgrid/memory/ball_pixels-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::memory::HWY_NAMESPACE {

using namespace views::octants::HWY_NAMESPACE;

/// Windows of an image, one a lane, and the planes of each.
struct Planes {
  V x, y, z_near, z_far, nearest, farthest;
};

/// Of the smallest windows that hold these rectangles of pixels. Lanes that are not asked do not make them larger.
HWY_INLINE Planes planes_of(const Carver& carver, M asked, const Rectangle& r) {
  const Floats d;
  const Ints di;
  const V zero = hn::Zero(d);
  const auto pixel = [&](V at, float size) HWY_ATTR {
    return hn::ConvertTo(di, hn::IfThenElseZero(asked, clamp(at, zero, hn::Set(d, size - 1))));
  };
  const I u0 = pixel(r.u_low, carver.camera.width);
  const I u1 = pixel(r.u_high, carver.camera.width);
  const I v0 = pixel(r.v_low, carver.camera.height);
  const I v1 = pixel(r.v_high, carver.camera.height);
  const std::int32_t last = hn::GetLane(hn::MaxOfLanes(di, hn::Max(hn::Sub(u1, u0), hn::Sub(v1, v0))));
  const DepthPlanes& planes = *carver.planes;
  std::size_t n = 0;
  while (n + 1 < planes.level_count() && last > (DepthPlanes::kTiles - 1) << planes.levels()[n].shift) {
    ++n;
  }
  const DepthPlanes::Level& level = planes.levels()[n];
  const I i = hn::Min(hn::ShiftRightSame(u0, level.shift), hn::Set(di, level.width - DepthPlanes::kTiles));
  const I j = hn::Min(hn::ShiftRightSame(v0, level.shift), hn::Set(di, level.height - DepthPlanes::kTiles));
  const I at = hn::Add(hn::Set(di, level.offset), hn::Add(hn::Mul(j, hn::Set(di, level.width)), i));
  return {hn::GatherIndex(d, planes.x(), at),       hn::GatherIndex(d, planes.y(), at),
          hn::GatherIndex(d, planes.z_near(), at),  hn::GatherIndex(d, planes.z_far(), at),
          hn::GatherIndex(d, planes.nearest(), at), hn::GatherIndex(d, planes.farthest(), at)};
}

/// More than single precision takes in the distance of a point from a plane, at most range_m from the camera.
HWY_INLINE V guard_of(const Carver& carver, V range_m) {
  const Floats d;
  return hn::Add(hn::Set(d, 2 * carver.camera.guard_m), hn::Mul(range_m, hn::Set(d, 3e-5F)));
}

/// The planes through the camera's centre that bound its image, and the end of its blind zone: how far a point lies
/// within, weighted(row, p) - beyond.
constexpr std::size_t kBorders = 5;
struct Border {
  std::array<float, 3> row;
  float beyond;
};
HWY_INLINE std::array<Border, kBorders> borders_of(const views::LocalCamera& camera) {
  const auto side = [](float f, float from, float sign, bool along_u) {
    const float by = sign / std::sqrt(1 + (from / f) * (from / f));
    return along_u ? Border{{by, 0, -from / f * by}, 0} : Border{{0, by, -from / f * by}, 0};
  };
  return {side(camera.fx, -camera.cx, 1, true), side(camera.fx, camera.width - camera.cx, -1, true),
          side(camera.fy, -camera.cy, 1, false), side(camera.fy, camera.height - camera.cy, -1, false),
          // The robot may be seen in the blind zone.
          Border{{0, 0, 1}, camera.has_islands ? 0.0F : static_cast<float>(camera.near_m)}};
}

/// Up to eight blocks.
struct EightBlocks {
  alignas(64) std::array<float, 8> x, y, z, near_limit, far_limit, plane_x, plane_y, plane_z_near, plane_z_far,
      plane_near, plane_far, least, most, near_z, far_z, range;
};

/// What an image shows of the voxels of one block; the others are not free.
struct BlockSeen {
  Block freed = 0;
  Block open = 0;  ///< left to the exact test
};

/// Block i of eight, of which something may be free and something not: voxel by voxel.
HWY_INLINE BlockSeen look_into_block(const views::LocalCamera& camera, const std::array<Border, kBorders>& borders,
                                     const EightBlocks& eight, std::size_t i, float voxel_m, Block voxels,
                                     std::int16_t* blocking, bool is_inside, bool is_in_front) {
  BlockSeen seen{0, voxels};
  Block within = kWholeBlock;
  if (!is_inside) {
    for (const Border& border : borders) {
      const float middle =
          border.row[0] * eight.x[i] + border.row[1] * eight.y[i] + border.row[2] * eight.z[i] - border.beyond;
      const Slope slope = slope_in_block(camera, voxel_m, border.row, middle);
      within &= above(slope, eight.most[i]);
      seen.open &= above(slope, eight.least[i]);
    }
  }
  if (is_in_front) {
    const Places places{slope_in_block(camera, voxel_m, {1, 0, 0}, eight.x[i]),
                        slope_in_block(camera, voxel_m, {0, 1, 0}, eight.y[i]),
                        slope_in_block(camera, voxel_m, {0, 0, 1}, eight.z[i])};
    const auto plane = [&](float by_z, float middle) {
      return slope_in_block(camera, voxel_m, {eight.plane_x[i], eight.plane_y[i], by_z}, middle);
    };
    seen.open &= ~above(places[2], eight.far_z[i]);
    seen.open &= ~above(plane(eight.plane_z_far[i], eight.plane_far[i]), eight.far_limit[i]);
    seen.freed = ~above(places[2], eight.near_z[i]);
    seen.freed |= ~above(plane(eight.plane_z_near[i], eight.plane_near[i]), eight.near_limit[i]);
    seen.freed &= within & seen.open;
    seen.open &= ~seen.freed;
    if (seen.open != 0) {
      seen.open &= ~centre_shows_not_free(camera, places, seen.open, eight.least[i], eight.range[i]);
    }
    Block rest_inside = seen.open & within;
    seen.open &= ~rest_inside;
    if (rest_inside != 0) {
      seen.freed |= look_at_voxels(camera, places, eight.least[i], eight.most[i], blocking, rest_inside);
    }
    seen.open |= rest_inside;
  }
  seen.freed &= voxels;
  seen.open &= ~seen.freed;
  return seen;
}

std::int64_t look_at_row(const Carver& carver, const BlockRow& row) {
  const Floats d;
  const views::LocalCamera& camera = carver.camera;
  const std::array<Border, kBorders> borders = borders_of(camera);
  const float half_m = 1.5F * row.voxel_m;
  const V half = hn::Set(d, half_m);
  const V diagonal = hn::Set(d, 1.7320509F * half_m);
  std::int64_t removed = 0;
  EightBlocks eight;  // NOLINT(*-member-init): written before each block is looked into
  for (std::size_t begin = 0; begin < row.count; begin += hn::Lanes(d)) {
    const std::size_t count = std::min(row.count - begin, hn::Lanes(d));
    std::uint32_t here = 0;
    for (std::size_t i = 0; i < count; ++i) {
      here |= row.voxels[begin + i] != 0 ? 1U << i : 0U;
      row.open[begin + i] = 0;
    }
    if (here == 0) {
      continue;
    }
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(here)};
    M asked = hn::LoadMaskBits(d, bytes.data());
    const V x_local =
        hn::Add(hn::Set(d, row.x_m), hn::Mul(hn::Iota(d, static_cast<float>(begin)), hn::Set(d, 4 * row.voxel_m)));
    const V y_local = hn::Set(d, row.y_m);
    const V z_local = hn::Set(d, row.z_m);
    const auto in_camera = [&](std::size_t n) HWY_ATTR {
      return hn::Add(weighted(camera.rotation.data() + 3 * n, x_local, y_local, z_local),
                     hn::Set(d, camera.offset_m[n]));
    };
    const V x = in_camera(0);
    const V y = in_camera(1);
    const V z = in_camera(2);
    const V range = length(x, y, z);
    const V far_range = hn::Add(range, diagonal);
    const V guard = guard_of(carver, far_range);
    const V per_m = hn::Set(d, camera.pose_error_per_m);
    // No ball is larger, and none smaller.
    const V most = hn::Add(hn::Add(hn::Set(d, camera.pose_error_m), hn::Mul(per_m, far_range)), guard);
    const V least = hn::Sub(
        hn::Add(hn::Set(d, carver.least_radius_m), hn::Mul(per_m, hn::Max(hn::Sub(range, diagonal), hn::Zero(d)))),
        guard);
    const float* HWY_RESTRICT rotation = camera.rotation.data();
    const auto extent = [&](V a, V b, V c) HWY_ATTR {
      V sum = hn::Zero(d);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sum = hn::Add(
            sum,
            hn::Abs(hn::Add(hn::Add(hn::Mul(a, hn::Set(d, rotation[axis])), hn::Mul(b, hn::Set(d, rotation[3 + axis]))),
                            hn::Mul(c, hn::Set(d, rotation[6 + axis])))));
      }
      return hn::Mul(sum, half);
    };
    M inside = asked;
    M none = hn::AndNot(asked, asked);
    for (const Border& border : borders) {
      const V within = hn::Sub(weighted(border.row.data(), x, y, z), hn::Set(d, border.beyond));
      const V spread = extent(hn::Set(d, border.row[0]), hn::Set(d, border.row[1]), hn::Set(d, border.row[2]));
      inside = hn::And(inside, hn::Gt(hn::Sub(within, spread), most));
      none = hn::Or(none, hn::Lt(hn::Add(within, spread), least));
    }
    asked = hn::AndNot(none, asked);
    if (hn::AllFalse(d, asked)) {
      continue;
    }
    const float* HWY_RESTRICT spread = camera.absolute_rotation.data();
    const auto grown = [&](std::size_t n)
                           HWY_ATTR { return hn::Add(weighted(spread + 3 * n, half, half, half), most); };
    const Bounds b{hn::Sub(x, grown(0)), hn::Add(x, grown(0)), hn::Sub(y, grown(1)),
                   hn::Add(y, grown(1)), hn::Sub(z, grown(2)), hn::Add(z, grown(2))};
    const V before = hn::Set(d, std::max(camera.blind_m, 2e-3F));
    const M in_front = hn::And(asked, hn::Gt(b.z_low, before));
    inside = hn::And(inside, in_front);
    const Planes planes =
        planes_of(carver, in_front, project(camera, b, hn::Max(b.z_low, before), hn::Max(b.z_high, before)));
    const V one = hn::Set(d, 1.0F);
    const V across = hn::Add(hn::Mul(planes.x, x), hn::Mul(planes.y, y));
    const V at_near = hn::Add(across, hn::Mul(planes.z_near, z));
    const V at_far = hn::Add(across, hn::Mul(planes.z_far, z));
    const V near_limit = hn::Sub(one, hn::Mul(length(planes.x, planes.y, planes.z_near), most));
    const V far_limit = hn::Sub(one, hn::Mul(length(planes.x, planes.y, planes.z_far), least));
    const V near_z = hn::Sub(hn::Div(one, planes.nearest), most);
    const V far_z = hn::Sub(hn::Div(one, planes.farthest), least);
    const V deep = extent(hn::Zero(d), hn::Zero(d), one);
    const M free =
        hn::And(inside, hn::Or(hn::Lt(hn::Add(at_near, extent(planes.x, planes.y, planes.z_near)), near_limit),
                               hn::Lt(hn::Add(z, deep), near_z)));
    const M behind =
        hn::And(in_front, hn::Or(hn::Gt(hn::Sub(at_far, extent(planes.x, planes.y, planes.z_far)), far_limit),
                                 hn::Gt(hn::Sub(z, deep), far_z)));
    for (std::uint32_t rest = bits_of(free); rest != 0; rest &= rest - 1) {
      Block& voxels = row.voxels[begin + static_cast<std::size_t>(std::countr_zero(rest))];
      removed += std::popcount(voxels);
      voxels = 0;
    }
    const std::uint32_t split = bits_of(hn::AndNot(hn::Or(free, behind), asked));
    if (split == 0) {
      continue;
    }
    const std::uint32_t is_inside = bits_of(inside);
    const std::uint32_t is_in_front = bits_of(in_front);
    hn::Store(x, d, eight.x.data());
    hn::Store(y, d, eight.y.data());
    hn::Store(z, d, eight.z.data());
    hn::Store(at_near, d, eight.plane_near.data());
    hn::Store(at_far, d, eight.plane_far.data());
    hn::Store(near_limit, d, eight.near_limit.data());
    hn::Store(far_limit, d, eight.far_limit.data());
    hn::Store(planes.x, d, eight.plane_x.data());
    hn::Store(planes.y, d, eight.plane_y.data());
    hn::Store(least, d, eight.least.data());
    hn::Store(most, d, eight.most.data());
    hn::Store(far_range, d, eight.range.data());
    hn::Store(near_z, d, eight.near_z.data());
    hn::Store(far_z, d, eight.far_z.data());
    hn::Store(planes.z_near, d, eight.plane_z_near.data());
    hn::Store(planes.z_far, d, eight.plane_z_far.data());
    for (std::uint32_t rest = split; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      Block& voxels = row.voxels[begin + i];
      const BlockSeen seen = look_into_block(camera, borders, eight, i, row.voxel_m, voxels,
                                             row.blocking + BlockingPixels::kVoxels * (begin + i),
                                             ((is_inside >> i) & 1U) != 0, ((is_in_front >> i) & 1U) != 0);
      removed += std::popcount(seen.freed);
      voxels &= ~seen.freed;
      row.open[begin + i] = seen.open;
    }
  }
  return removed;
}

}  // namespace depthgrid::memory::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::memory {

HWY_EXPORT(look_at_row);

std::int64_t see_row(const Carver& carver, const BlockRow& row) noexcept {
  return HWY_DYNAMIC_DISPATCH(look_at_row)(carver, row);
}

}  // namespace depthgrid::memory
#endif
