// Where a ray enters and leaves a capsule, a vector register of rays at a time. Included once for each instruction set.
// Internal.
#if defined(DEPTHGRID_ROBOT_CAPSULE_RAY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_ROBOT_CAPSULE_RAY_INL
#undef DEPTHGRID_ROBOT_CAPSULE_RAY_INL
#else
#define DEPTHGRID_ROBOT_CAPSULE_RAY_INL
#endif

#include <array>
#include <limits>

#include "depthgrid/core/lanes-inl.hpp"
#include "depthgrid/robot/robot_rows.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::robot::HWY_NAMESPACE {
using namespace lanes::HWY_NAMESPACE;
static_assert(kLanes >= hn::MaxLanes(Floats()), "rows are padded to whole vectors");

constexpr float kInf = std::numeric_limits<float>::infinity();

/// Rays (x, y, 1); a depth is the parameter along them.
struct Rays {
  V x, y;
  V inverse_square;  ///< 1 / |(x, y, 1)|^2
};

struct Ends {
  V near, far;  ///< infinity and -infinity where empty
};

/// Where a line is nearest to a point or an axis: the depth there, and the square of how near.
struct Foot {
  V depth, square;
};

HWY_INLINE V dot(const Rays& rays, const std::array<float, 3>& c) {
  const Floats d;
  return hn::Add(hn::Add(hn::Mul(rays.x, hn::Set(d, c[0])), hn::Mul(rays.y, hn::Set(d, c[1]))), hn::Set(d, c[2]));
}

/// |c - depth (x, y, z)|^2: a small number by differences of coordinates, not of large squares.
HWY_INLINE V square_distance(const std::array<float, 3>& c, V depth, V x, V y, V z) {
  const Floats d;
  const V dx = hn::Sub(hn::Set(d, c[0]), hn::Mul(depth, x));
  const V dy = hn::Sub(hn::Set(d, c[1]), hn::Mul(depth, y));
  const V dz = hn::Sub(hn::Set(d, c[2]), hn::Mul(depth, z));
  return hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
}

HWY_INLINE Foot foot_of_ball(const Rays& rays, const std::array<float, 3>& centre) {
  const V depth = hn::Mul(dot(rays, centre), rays.inverse_square);
  return {depth, square_distance(centre, depth, rays.x, rays.y, hn::Set(Floats(), 1.0F))};
}

/// A ray beside a capsule's axis; what all radii have in common.
struct Beside {
  Foot axis;
  V along;           ///< of the ray's direction, its part along the axis
  V inverse_across;  ///< 1 / square of its part across
};

HWY_INLINE Beside beside(const Rays& rays, const RowCapsule& capsule) {
  const Floats d;
  Beside result;
  result.along = dot(rays, capsule.axis);
  const V x = hn::Sub(rays.x, hn::Mul(result.along, hn::Set(d, capsule.axis[0])));
  const V y = hn::Sub(rays.y, hn::Mul(result.along, hn::Set(d, capsule.axis[1])));
  const V z = hn::Sub(hn::Set(d, 1.0F), hn::Mul(result.along, hn::Set(d, capsule.axis[2])));
  const V square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
  // A ray along the axis meets the cylinder far beyond both ends, so that the balls decide.
  result.inverse_across = hn::Div(hn::Set(d, 1.0F), hn::Max(square, hn::Set(d, 1e-12F)));
  const V across =
      hn::Add(hn::Add(hn::Mul(x, hn::Set(d, capsule.a_across[0])), hn::Mul(y, hn::Set(d, capsule.a_across[1]))),
              hn::Mul(z, hn::Set(d, capsule.a_across[2])));
  result.axis.depth = hn::Mul(across, result.inverse_across);
  result.axis.square = square_distance(capsule.a_across, result.axis.depth, x, y, z);
  return result;
}

/// One end of the ray's part in the capsule: on the endless cylinder where that lies between the two balls' centres,
/// else on the ball of that side. `sign`: -1 entry, 1 exit. Sets `met` where the ray meets the surface that counts.
HWY_INLINE V end_of(const Rays& rays, const RowCapsule& capsule, const Beside& ray, const Foot& a, const Foot& b,
                    V radius_square, V half, float sign, M* met) {
  const Floats d;
  const V on_cylinder = hn::Add(ray.axis.depth, hn::Mul(hn::Set(d, sign), half));
  const V place = hn::Sub(hn::Mul(ray.along, on_cylinder), hn::Set(d, capsule.a_along));
  const M before = hn::Lt(place, hn::Zero(d));
  const M beyond = hn::Gt(place, hn::Set(d, capsule.length));
  const V depth = hn::IfThenElse(before, a.depth, b.depth);
  const V rest = hn::Sub(radius_square, hn::IfThenElse(before, a.square, b.square));
  const V deep = hn::Sqrt(hn::Mul(hn::Max(rest, hn::Zero(d)), rays.inverse_square));
  const M by_ball = hn::Or(before, beyond);
  *met = hn::Or(hn::Not(by_ball), hn::Ge(rest, hn::Zero(d)));
  return hn::IfThenElse(by_ball, hn::Add(depth, hn::Mul(hn::Set(d, sign), deep)), on_cylinder);
}

/// The ray's part in the capsule of this radius, where that reaches in front of the camera. False where no ray has one.
HWY_INLINE bool part_of(const Rays& rays, const RowCapsule& capsule, float square, Ends* part) {
  const Floats d;
  const Beside ray = beside(rays, capsule);
  const V radius_square = hn::Set(d, square);
  const V rest = hn::Sub(radius_square, ray.axis.square);
  const M near_axis = hn::Ge(rest, hn::Zero(d));
  if (hn::AllFalse(d, near_axis)) {
    return false;
  }
  const V half = hn::Sqrt(hn::Mul(hn::Max(rest, hn::Zero(d)), ray.inverse_across));
  const Foot a = foot_of_ball(rays, capsule.a);
  const Foot b = foot_of_ball(rays, capsule.b);
  M enters;
  M leaves;
  const V near = end_of(rays, capsule, ray, a, b, radius_square, half, -1.0F, &enters);
  const V far = end_of(rays, capsule, ray, a, b, radius_square, half, 1.0F, &leaves);
  // Both or none, but for rounding where the ray only just touches.
  const M met = hn::And(hn::And(near_axis, hn::Or(enters, leaves)), hn::Gt(far, hn::Zero(d)));
  *part = {hn::IfThenElse(met, hn::Min(near, far), hn::Set(d, kInf)), hn::IfThenElse(met, far, hn::Set(d, -kInf))};
  return !hn::AllFalse(d, met);
}

}  // namespace depthgrid::robot::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
