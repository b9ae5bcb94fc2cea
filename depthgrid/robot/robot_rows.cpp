#include "depthgrid/robot/robot_rows.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/robot/robot_rows.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: it must be seen once for each target.
#include "depthgrid/robot/capsule_ray-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::robot::HWY_NAMESPACE {

/// Parts in the scratch memory: the nearer ends of kLanes rays, then the farther ones.
HWY_INLINE const float* near_ends(const float* parts, std::size_t i) {
  constexpr std::size_t kPart = 2 * std::size_t{kLanes};
  return parts + kPart * i;
}
HWY_INLINE const float* far_ends(const float* parts, std::size_t i) { return near_ends(parts, i) + kLanes; }

/// Grows the part around `start` over all the capsules' parts that touch it. Infinity stays: no part is there.
HWY_INLINE Ends part_around(V start, const float* HWY_RESTRICT parts, std::size_t count) {
  const Floats d;
  Ends part{start, start};
  for (std::size_t pass = 0; pass < count; ++pass) {
    const Ends before = part;
    for (std::size_t i = 0; i < count; ++i) {
      const V near = hn::Load(d, near_ends(parts, i));
      const V far = hn::Load(d, far_ends(parts, i));
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
      const V near = hn::Load(d, near_ends(row.scratch, i));
      const V far = hn::Load(d, far_ends(row.scratch, i));
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
  float* next = row.scratch;
  for (std::size_t i = 0; i < row.count; ++i) {
    Ends padded;
    if (in_span(row, i, u, n) && part_of(rays, row.capsules[i], row.capsules[i].padded_square, &padded)) {
      hn::Store(padded.near, d, next);
      hn::Store(padded.far, d, next + kLanes);
      next += 2 * std::ptrdiff_t{kLanes};
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
