// How near the children of a cube are to an axis. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_SEARCH_NEAR_CHILDREN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_SEARCH_NEAR_CHILDREN_INL
#undef DEPTHGRID_SEARCH_NEAR_CHILDREN_INL
#else
#define DEPTHGRID_SEARCH_NEAR_CHILDREN_INL
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include "depthgrid/search/near_children.hpp"
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

/// Points of the axis and of the cubes that project onto each other.
struct Projection {
  V sx, sy, sz;
  V bx, by, bz;
};

/// The axis' points nearest to (x, y, z), and the cubes' nearest to those.
HWY_INLINE Projection projected(const CubesAndAxis& c, V x, V y, V z) {
  const V t = share_of(c, x, y, z);
  const V sx = hn::Add(c.ax, hn::Mul(t, c.lx));
  const V sy = hn::Add(c.ay, hn::Mul(t, c.ly));
  const V sz = hn::Add(c.az, hn::Mul(t, c.lz));
  return {sx,
          sy,
          sz,
          clamp(sx, hn::Sub(c.x, c.half), hn::Add(c.x, c.half)),
          clamp(sy, hn::Sub(c.y, c.half), hn::Add(c.y, c.half)),
          clamp(sz, hn::Sub(c.z, c.half), hn::Add(c.z, c.half))};
}

/// Whatever lies between a plane across the way from b to s, norm long, and the cube: no part of the axis is nearer.
struct Plane {
  HWY_INLINE Plane(const CubesAndAxis& c, const Projection& p) {
    const Floats d;
    const V zero = hn::Zero(d);
    const V nx = hn::Sub(p.sx, p.bx);
    const V ny = hn::Sub(p.sy, p.by);
    const V nz = hn::Sub(p.sz, p.bz);
    norm = length(nx, ny, nz);
    // Both ends of the axis, and as much as the cube extends, along n.
    const V at_a = hn::Add(hn::Add(hn::Mul(nx, hn::Sub(c.ax, c.x)), hn::Mul(ny, hn::Sub(c.ay, c.y))),
                           hn::Mul(nz, hn::Sub(c.az, c.z)));
    const V on = hn::Add(hn::Add(hn::Mul(nx, c.lx), hn::Mul(ny, c.ly)), hn::Mul(nz, c.lz));
    const V support = hn::Mul(c.half, hn::Add(hn::Add(hn::Abs(nx), hn::Abs(ny)), hn::Abs(nz)));
    const V least = hn::Sub(hn::Add(at_a, hn::Min(on, zero)), support);
    // Where they nearly touch n is made of roundings: nothing is claimed.
    constexpr float kTouching = 5e-4F;
    distance =
        hn::IfThenElseZero(hn::Gt(norm, hn::Set(d, kTouching)), hn::Div(least, hn::Max(norm, hn::Set(d, kTouching))));
  }
  V norm;
  V distance;
};

/// From the axis to around the ball around each cube.
HWY_INLINE V ball_distance(const CubesAndAxis& c, V to_centre) {
  return hn::Sub(to_centre, hn::Mul(c.half, hn::Set(Floats(), 1.7320509F)));
}

HWY_INLINE V to_centres(const CubesAndAxis& c, const Projection& p) {
  return length(hn::Sub(c.x, p.sx), hn::Sub(c.y, p.sy), hn::Sub(c.z, p.sz));
}

/// Of a segment and a cube: whatever lies between them and a plane across the shortest way that a few projections find,
/// or around the cube's ball, whichever is more.
HWY_INLINE V segment_distance(const CubesAndAxis& c) {
  const Projection first = projected(c, c.x, c.y, c.z);
  const Projection second = projected(c, first.bx, first.by, first.bz);
  const Plane plane(c, projected(c, second.bx, second.by, second.bz));
  return hn::Max(hn::Max(plane.distance, ball_distance(c, to_centres(c, first))), hn::Zero(Floats()));
}

/// No more than that, and only as good as it takes to tell which of the lanes `wanted` are nearer than `bound`: those
/// whose result is less. Most are told by their ball or by the first plane, and each projection waits for the one
/// before.
HWY_INLINE V some_segment_distance(const CubesAndAxis& c, M wanted, V bound) {
  const Floats d;
  Projection p = projected(c, c.x, c.y, c.z);
  const V to_centre = to_centres(c, p);
  V least = hn::Max(ball_distance(c, to_centre), hn::Zero(d));
  M open = hn::And(wanted, hn::And(hn::Lt(least, bound), hn::Ge(to_centre, bound)));
  for (int i = 0; i < 3 && !hn::AllFalse(d, open); ++i) {
    if (i > 0) {
      p = projected(c, p.bx, p.by, p.bz);
    }
    const Plane plane(c, p);
    // What is told stays as it is: the result of a lane must not depend on how many others there are.
    least = hn::IfThenElse(open, hn::Max(least, plane.distance), least);
    open = hn::And(open, hn::And(hn::Lt(least, bound), hn::Ge(plane.norm, bound)));
  }
  return least;
}

HWY_INLINE V point_distance(const CubesAndAxis& c) {
  const Floats d;
  const V zero = hn::Zero(d);
  return length(hn::Max(hn::Sub(hn::Abs(hn::Sub(c.x, c.ax)), c.half), zero),
                hn::Max(hn::Sub(hn::Abs(hn::Sub(c.y, c.ay)), c.half), zero),
                hn::Max(hn::Sub(hn::Abs(hn::Sub(c.z, c.az)), c.half), zero));
}

/// The children of a cube from `first` on, as many as there are lanes.
HWY_INLINE CubesAndAxis children_and_axis(const Axis& axis, const Cube& cube, float half_m, std::size_t first) {
  const Floats d;
  const V half = hn::Set(d, half_m);
  return {child_centre(cube.x, kSignX.data() + first, half),
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
}

/// near_children() for this instruction set.
HWY_INLINE std::uint32_t near_lanes(const Axis& axis, const Cube& cube, float half_m, float bound_m,
                                    std::array<float, 8>& distances_m) {
  const Floats d;
  std::uint32_t result = 0;
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    const CubesAndAxis c = children_and_axis(axis, cube, half_m, first);
    const V distance = axis.inverse_square != 0 ? segment_distance(c) : point_distance(c);
    hn::StoreU(distance, d, distances_m.data() + first);
    result |= bits_of(hn::Lt(distance, hn::Set(d, bound_m))) << first;
  }
  return result;
}

/// The same for the children `wanted` alone, and distances may be less: no better than it takes to tell.
HWY_INLINE std::uint32_t near_of(std::uint32_t wanted, const Axis& axis, const Cube& cube, float half_m, float bound_m,
                                 std::array<float, 8>& distances_m) {
  const Floats d;
  const V bound = hn::Set(d, bound_m);
  std::uint32_t result = 0;
  for (std::size_t first = 0; first < 8; first += hn::Lanes(d)) {
    const CubesAndAxis c = children_and_axis(axis, cube, half_m, first);
    const std::array<std::uint8_t, 8> bits{static_cast<std::uint8_t>(wanted >> first)};
    const V distance = axis.inverse_square != 0 ? some_segment_distance(c, hn::LoadMaskBits(d, bits.data()), bound)
                                                : point_distance(c);
    hn::StoreU(distance, d, distances_m.data() + first);
    result |= bits_of(hn::Lt(distance, bound)) << first;
  }
  return result & wanted;
}

}  // namespace depthgrid::search::octants::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
