#include "depthgrid/robot/robot_rows.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/robot/robot_rows.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: highway.h must be seen once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::robot::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No fused multiply-add anywhere: every instruction set gives the same bits.
using Floats = hn::CappedTag<float, kLanes>;
using V = hn::Vec<Floats>;
using M = hn::Mask<Floats>;

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

/// Grows the part around `start` over all the capsules' parts that touch it. Infinity stays: no part is there.
HWY_INLINE Ends part_around(V start, const float* HWY_RESTRICT parts, std::size_t count) {
  const Floats d;
  Ends part{start, start};
  for (std::size_t pass = 0; pass < count; ++pass) {
    const Ends before = part;
    for (std::size_t i = 0; i < count; ++i) {
      const V near = hn::Load(d, parts + 2 * kLanes * i);
      const V far = hn::Load(d, parts + 2 * kLanes * i + kLanes);
      const M touches = hn::And(hn::Le(near, part.far), hn::Ge(far, part.near));
      part.near = hn::IfThenElse(touches, hn::Min(part.near, near), part.near);
      part.far = hn::IfThenElse(touches, hn::Max(part.far, far), part.far);
    }
    if (hn::AllTrue(d, hn::And(hn::Eq(before.near, part.near), hn::Eq(before.far, part.far)))) {
      break;
    }
  }
  return part;
}

/// Whether the capsule may be seen in pixels [u, u + n).
HWY_INLINE bool in_span(const RobotRow& row, std::size_t i, int u, int n) {
  return row.spans[i].begin < u + n && row.spans[i].end > u;
}

/// Where the part to answer begins, if a ray has several: at the reading, else at the robot's first surface, else
/// where the padding does. parts, count: the padded capsules' parts.
HWY_INLINE V start_of(const RobotRow& row, int u, const Rays& rays, V first, std::size_t count) {
  const Floats d;
  const int n = static_cast<int>(hn::Lanes(d));
  V surface = hn::Set(d, kInf);
  for (std::size_t i = 0; i < row.count; ++i) {
    Ends body;
    if (in_span(row, i, u, n) && part_of(rays, row.capsules[i], row.capsules[i].body_square, &body)) {
      surface = hn::Min(surface, body.near);
    }
  }
  V start = hn::IfThenElse(hn::Lt(surface, hn::Set(d, kInf)), surface, first);
  if (row.reading_m != nullptr) {
    const V reading = hn::Load(d, row.reading_m + u);
    for (std::size_t i = 0; i < count; ++i) {
      const V near = hn::Load(d, row.scratch + 2 * kLanes * i);
      const V far = hn::Load(d, row.scratch + 2 * kLanes * i + kLanes);
      start = hn::IfThenElse(hn::And(hn::Le(near, reading), hn::Ge(far, reading)), reading, start);
    }
  }
  return start;
}

/// The answer for pixels [u, u + lanes): empty where the ray meets no padded capsule.
HWY_INLINE Ends answer_of(const RobotRow& row, int u) {
  const Floats d;
  const int n = static_cast<int>(hn::Lanes(d));
  Rays rays{hn::Load(d, row.x_ray + u), hn::Set(d, row.y_ray), hn::Zero(d)};
  const V square = hn::Add(hn::Add(hn::Mul(rays.x, rays.x), hn::Mul(rays.y, rays.y)), hn::Set(d, 1.0F));
  rays.inverse_square = hn::Div(hn::Set(d, 1.0F), square);
  Ends all{hn::Set(d, kInf), hn::Set(d, -kInf)};
  std::size_t count = 0;
  for (std::size_t i = 0; i < row.count; ++i) {
    Ends padded;
    if (in_span(row, i, u, n) && part_of(rays, row.capsules[i], row.capsules[i].padded_square, &padded)) {
      hn::Store(padded.near, d, row.scratch + 2 * kLanes * count);
      hn::Store(padded.far, d, row.scratch + 2 * kLanes * count + kLanes);
      ++count;
      all = {hn::Min(all.near, padded.near), hn::Max(all.far, padded.far)};
    }
  }
  if (count < 2) {
    return all;
  }
  const Ends first = part_around(all.near, row.scratch, count);
  if (hn::AllTrue(d, hn::Ge(first.far, all.far))) {
    return first;  // no ray has several parts
  }
  return part_around(start_of(row, u, rays, all.near, count), row.scratch, count);
}

void write_row(const RobotRow& row) {
  const Floats d;
  const int n = static_cast<int>(hn::Lanes(d));
  for (int u = row.pixels.begin; u < row.pixels.end; u += n) {
    const Ends part = answer_of(row, u);
    const M robot = hn::Lt(part.near, hn::Set(d, kInf));
    const V smallest = hn::Set(d, std::numeric_limits<float>::min());
    hn::Store(hn::IfThenElseZero(robot, hn::Max(part.near, smallest)), d, row.near_m + u);
    hn::Store(hn::IfThenElseZero(robot, part.far), d, row.far_m + u);
  }
}

}  // namespace depthgrid::robot::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::robot {

HWY_EXPORT(write_row);

void robot_row(const RobotRow& row) noexcept { HWY_DYNAMIC_DISPATCH(write_row)(row); }

}  // namespace depthgrid::robot
#endif
