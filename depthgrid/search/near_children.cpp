#include "depthgrid/search/near_children.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/near_children.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: it must be seen once for each target.
#include "depthgrid/views/eight_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::octants::HWY_NAMESPACE {

using namespace views::octants::HWY_NAMESPACE;

/// Cubes, half a side each, and an axis.
struct CubesAndAxis {
  V x, y, z, half;
  V ax, ay, az, lx, ly, lz, inverse;
};

/// Where along the axis the point nearest to (x, y, z) lies, from 0 to 1.
HWY_INLINE V share_of(const CubesAndAxis& c, V x, V y, V z) {
  const Floats d;
  const V product = hn::Add(hn::Add(hn::Mul(hn::Sub(x, c.ax), c.lx), hn::Mul(hn::Sub(y, c.ay), c.ly)),
                            hn::Mul(hn::Sub(z, c.az), c.lz));
  return clamp(hn::Mul(product, c.inverse), hn::Zero(d), hn::Set(d, 1.0F));
}

/// Of a segment and a cube: whatever lies between them and a plane across the shortest way that a few projections find,
/// or around the cube's ball, whichever is more.
HWY_INLINE V segment_distance(const CubesAndAxis& c) {
  const Floats d;
  const V zero = hn::Zero(d);
  V bx = c.x;
  V by = c.y;
  V bz = c.z;
  V sx = c.ax;
  V sy = c.ay;
  V sz = c.az;
  V to_centre = zero;
  for (int i = 0; i < 3; ++i) {
    const V t = share_of(c, bx, by, bz);
    sx = hn::Add(c.ax, hn::Mul(t, c.lx));
    sy = hn::Add(c.ay, hn::Mul(t, c.ly));
    sz = hn::Add(c.az, hn::Mul(t, c.lz));
    if (i == 0) {
      to_centre = length(hn::Sub(c.x, sx), hn::Sub(c.y, sy), hn::Sub(c.z, sz));
    }
    bx = clamp(sx, hn::Sub(c.x, c.half), hn::Add(c.x, c.half));
    by = clamp(sy, hn::Sub(c.y, c.half), hn::Add(c.y, c.half));
    bz = clamp(sz, hn::Sub(c.z, c.half), hn::Add(c.z, c.half));
  }
  const V nx = hn::Sub(sx, bx);
  const V ny = hn::Sub(sy, by);
  const V nz = hn::Sub(sz, bz);
  const V norm = length(nx, ny, nz);
  // Both ends of the axis, and as much as the cube extends, along n.
  const V at_a = hn::Add(hn::Add(hn::Mul(nx, hn::Sub(c.ax, c.x)), hn::Mul(ny, hn::Sub(c.ay, c.y))),
                         hn::Mul(nz, hn::Sub(c.az, c.z)));
  const V on = hn::Add(hn::Add(hn::Mul(nx, c.lx), hn::Mul(ny, c.ly)), hn::Mul(nz, c.lz));
  const V support = hn::Mul(c.half, hn::Add(hn::Add(hn::Abs(nx), hn::Abs(ny)), hn::Abs(nz)));
  const V least = hn::Sub(hn::Add(at_a, hn::Min(on, zero)), support);
  // Where they nearly touch n is made of roundings: nothing is claimed.
  constexpr float kTouching = 5e-4F;
  const V plane =
      hn::IfThenElseZero(hn::Gt(norm, hn::Set(d, kTouching)), hn::Div(least, hn::Max(norm, hn::Set(d, kTouching))));
  const V ball = hn::Sub(to_centre, hn::Mul(c.half, hn::Set(d, 1.7320509F)));
  return hn::Max(hn::Max(plane, ball), zero);
}

HWY_INLINE V point_distance(const CubesAndAxis& c) {
  const Floats d;
  const V zero = hn::Zero(d);
  return length(hn::Max(hn::Sub(hn::Abs(hn::Sub(c.x, c.ax)), c.half), zero),
                hn::Max(hn::Sub(hn::Abs(hn::Sub(c.y, c.ay)), c.half), zero),
                hn::Max(hn::Sub(hn::Abs(hn::Sub(c.z, c.az)), c.half), zero));
}

std::uint32_t near_lanes(const Axis& axis, const Cube& cube, float half_m, float bound_m,
                         std::array<float, 8>& distances_m) {
  const Floats d;
  const V half = hn::Set(d, half_m);
  std::uint32_t result = 0;
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    const CubesAndAxis c{child_centre(cube.x, kSignX.data() + first, half),
                         child_centre(cube.y, kSignY.data() + first, half),
                         child_centre(cube.z, kSignZ.data() + first, half),
                         half,
                         hn::Set(d, axis.a[0]),
                         hn::Set(d, axis.a[1]),
                         hn::Set(d, axis.a[2]),
                         hn::Set(d, axis.along[0]),
                         hn::Set(d, axis.along[1]),
                         hn::Set(d, axis.along[2]),
                         hn::Set(d, axis.inverse_square)};
    const V distance = axis.inverse_square != 0 ? segment_distance(c) : point_distance(c);
    hn::StoreU(distance, d, distances_m.data() + first);
    result |= bits_of(hn::Lt(distance, hn::Set(d, bound_m))) << first;
  }
  return result;
}

}  // namespace depthgrid::search::octants::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::search {
namespace octants {

HWY_EXPORT(near_lanes);

std::uint32_t near(const Axis& axis, const Cube& cube, float half_m, float bound_m,
                   std::array<float, 8>& distances_m) noexcept {
  return HWY_DYNAMIC_DISPATCH(near_lanes)(axis, cube, half_m, bound_m, distances_m);
}

}  // namespace octants

std::uint32_t near_children(const Axis& axis, const Cube& cube, float half_m, float bound_m,
                            std::array<float, 8>& distances_m) noexcept {
  return octants::near(axis, cube, half_m, bound_m, distances_m);
}

}  // namespace depthgrid::search
#endif
