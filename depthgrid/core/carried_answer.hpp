// What an answer that was given for one place and time still says about another.
#pragma once

#include "depthgrid/core/answer.hpp"
#include "depthgrid/core/capsule.hpp"

namespace depthgrid {

/// - Takes: an answer for the capsule `asked` at the time it was asked for, the capsule as it is now, both in the world
///   frame in metres; how many seconds later that is; v_max of the evaluator, m/s.
/// - Gives: a valid answer for `now`, never above the distance. No point of the capsule is farther from the old one
/// than
///   the ends are and than the radius has grown: both bounds get smaller by that, distance_now_m also by v_max
///   elapsed_s.
/// - nearest_world and state stay; on_axis_world and direction_world are those of the new capsule;
///   hybrid_direction_world and blind_m are the old ones.
/// - not_evaluated: a capsule that is not finite. distance_now_m is NaN when elapsed_s is negative or NaN.
/// - Threads: any.
[[nodiscard]] Answer carried_over(const Answer& answer, const Capsule& asked, const Capsule& now, double elapsed_s,
                                  double v_max_m_s) noexcept;

/// How far a point of `now` may be from every point of `before`, metres; NaN for capsules that are not finite. 0 where
/// it has only shrunk.
[[nodiscard]] double greatest_displacement_m(const Capsule& before, const Capsule& now) noexcept;

}  // namespace depthgrid
