// The two ways to find the largest scale of one task, once it stands in orthonormal rows. Internal.
#pragma once

#include <optional>
#include <span>

#include "depthgrid/control/joint_box.hpp"
#include "depthgrid/control/projection.hpp"
#include "depthgrid/control/saturation.hpp"
#include "depthgrid/control/task_rows.hpp"

namespace depthgrid::control {

/// Find qd in the box and the largest s in [0, 1] with
///   taken qd = taken base,   rows qd = rows base + offset + s slope
struct ScaleProblem {
  const JointRows& taken;
  const JointRows& rows;
  JointVector base;
  TaskVector offset;
  TaskVector slope;
};

struct ScaleAnswer {
  JointVector velocity_rad_s;
  double scale = 0;
};

/// Nothing when the algorithm finds no scale; then there may still be one.
[[nodiscard]] std::optional<ScaleAnswer> basic_scale(const ScaleProblem& problem, const JointBox& box) noexcept;

/// Nothing when there is none. `projection` is scratch memory.
[[nodiscard]] std::optional<ScaleAnswer> optimal_scale(const ScaleProblem& problem, const JointBox& box,
                                                       const JointVector& preferred,
                                                       std::span<const ApproachLimit> limits,
                                                       Projection& projection) noexcept;

}  // namespace depthgrid::control
