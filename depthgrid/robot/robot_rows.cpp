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

/// What the two radii have in common.
struct Feet {
  Foot a, b, axis;
  V along;          ///< of the ray's direction, its part along the axis
  V inverse_across; ///< 1 / square of its part across
};

HWY_INLINE Feet feet_of(const Rays& rays, const RowCapsule& capsule) {
  const Floats d;
  Feet feet;
  feet.a = foot_of_ball(rays, capsule.a);
  feet.b = foot_of_ball(rays, capsule.b);
  feet.along = dot(rays, capsule.axis);
  const V x = hn::Sub(rays.x, hn::Mul(feet.along, hn::Set(d, capsule.axis[0])));
  const V y = hn::Sub(rays.y, hn::Mul(feet.along, hn::Set(d, capsule.axis[1])));
  const V z = hn::Sub(hn::Set(d, 1.0F), hn::Mul(feet.along, hn::Set(d, capsule.axis[2])));
  const V square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
  // A ray along the axis meets the cylinder far beyond both ends, so that the balls decide.
  feet.inverse_across = hn::Div(hn::Set(d, 1.0F), hn::Max(square, hn::Set(d, 1e-12F)));
  const V across = hn::Add(hn::Add(hn::Mul(x, hn::Set(d, capsule.a_across[0])), hn::Mul(y, hn::Set(d, capsule.a_across[1]))),
                           hn::Mul(z, hn::Set(d, capsule.a_across[2])));
  feet.axis.depth = hn::Mul(across, feet.inverse_across);
  feet.axis.square = square_distance(capsule.a_across, feet.axis.depth, x, y, z);
  return feet;
}

/// One end of the ray's part in the capsule: on the endless cylinder where that lies between the two balls' centres,
/// else on the ball of that side. `sign`: -1 entry, 1 exit. Sets `met` where the ray meets the surface that counts.
HWY_INLINE V end_of(const Rays& rays, const RowCapsule& capsule, const Feet& feet, V radius_square, V half, float sign,
                    M* met) {
  const Floats d;
  const V on_cylinder = hn::Add(feet.axis.depth, hn::Mul(hn::Set(d, sign), half));
  const V place = hn::Sub(hn::Mul(feet.along, on_cylinder), hn::Set(d, capsule.a_along));
  const M before = hn::Lt(place, hn::Zero(d));
  const M beyond = hn::Gt(place, hn::Set(d, capsule.length));
  const V depth = hn::IfThenElse(before, feet.a.depth, feet.b.depth);
  const V rest = hn::Sub(radius_square, hn::IfThenElse(before, feet.a.square, feet.b.square));
  const V on_ball = hn::Add(depth, hn::Mul(hn::Set(d, sign), hn::Sqrt(hn::Mul(hn::Max(rest, hn::Zero(d)),
                                                                             rays.inverse_square))));
  const M by_ball = hn::Or(before, beyond);
  *met = hn::Or(hn::Not(by_ball), hn::Ge(rest, hn::Zero(d)));
  return hn::IfThenElse(by_ball, on_ball, on_cylinder);
}

/// The ray's part in the capsule of this radius, where that reaches in front of the camera.
HWY_INLINE Ends part_of(const Rays& rays, const RowCapsule& capsule, const Feet& feet, float square) {
  const Floats d;
  const V radius_square = hn::Set(d, square);
  const V rest = hn::Sub(radius_square, feet.axis.square);
  const V half = hn::Sqrt(hn::Mul(hn::Max(rest, hn::Zero(d)), feet.inverse_across));
  M enters;
  M leaves;
  const V near = end_of(rays, capsule, feet, radius_square, half, -1.0F, &enters);
  const V far = end_of(rays, capsule, feet, radius_square, half, 1.0F, &leaves);
  // Both or none, but for rounding where the ray only just touches.
  const M met = hn::And(hn::And(hn::Ge(rest, hn::Zero(d)), hn::Or(enters, leaves)), hn::Gt(far, hn::Zero(d)));
  return {hn::IfThenElse(met, hn::Min(near, far), hn::Set(d, kInf)), hn::IfThenElse(met, far, hn::Set(d, -kInf))};
}

/// Grows the part around `start` over all the capsules' parts that touch it.
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

void write_row(const RobotRow& row) {
  const Floats d;
  const int n = static_cast<int>(hn::Lanes(d));
  for (int u = row.pixels.begin; u < row.pixels.end; u += n) {
    Rays rays{hn::Load(d, row.x_ray + u), hn::Set(d, row.y_ray), hn::Zero(d)};
    rays.inverse_square =
        hn::Div(hn::Set(d, 1.0F),
                hn::Add(hn::Add(hn::Mul(rays.x, rays.x), hn::Mul(rays.y, rays.y)), hn::Set(d, 1.0F)));
    const V reading = row.reading_m != nullptr ? hn::Load(d, row.reading_m + u) : hn::Zero(d);
    V first = hn::Set(d, kInf);    // where the padding begins
    V surface = hn::Set(d, kInf);  // where the robot itself begins
    M read = hn::Lt(surface, surface);
    std::size_t met = 0;
    for (std::size_t i = 0; i < row.count; ++i) {
      if (row.spans[i].begin >= u + n || row.spans[i].end <= u) {
        continue;
      }
      const RowCapsule& capsule = row.capsules[i];
      const Feet feet = feet_of(rays, capsule);
      const Ends padded = part_of(rays, capsule, feet, capsule.padded_square);
      if (hn::AllTrue(d, hn::Gt(padded.near, padded.far))) {
        continue;
      }
      hn::Store(padded.near, d, row.scratch + 2 * kLanes * met);
      hn::Store(padded.far, d, row.scratch + 2 * kLanes * met + kLanes);
      ++met;
      first = hn::Min(first, padded.near);
      surface = hn::Min(surface, part_of(rays, capsule, feet, capsule.body_square).near);
      read = hn::Or(read, hn::And(hn::Le(padded.near, reading), hn::Ge(padded.far, reading)));
    }
    V near = hn::Zero(d);
    V far = hn::Zero(d);
    if (met > 0) {
      V start = hn::IfThenElse(hn::Lt(surface, hn::Set(d, kInf)), surface, first);
      if (row.reading_m != nullptr) {
        start = hn::IfThenElse(read, reading, start);
      }
      const Ends part = part_around(start, row.scratch, met);
      const M robot = hn::Lt(first, hn::Set(d, kInf));
      near = hn::IfThenElseZero(robot, hn::Max(part.near, hn::Set(d, std::numeric_limits<float>::min())));
      far = hn::IfThenElseZero(robot, part.far);
    }
    hn::Store(near, d, row.near_m + u);
    hn::Store(far, d, row.far_m + u);
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
