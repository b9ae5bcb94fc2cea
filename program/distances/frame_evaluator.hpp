// One way to answer the control points of a recording, frame by frame.
#pragma once

#include <span>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/files/control_points.hpp"
#include "program/distances/answer_writer.hpp"

namespace depthgrid::program {

class FrameEvaluator {
 public:
  FrameEvaluator() = default;
  FrameEvaluator(const FrameEvaluator&) = delete;
  FrameEvaluator& operator=(const FrameEvaluator&) = delete;
  virtual ~FrameEvaluator() = default;

  /// Takes one frame a camera, in the rig's order. False when one of them has no usable image.
  [[nodiscard]] virtual bool update(std::span<const Frame> frames) = 0;

  /// One answer a point, in their order; the points are in the world frame.
  [[nodiscard]] virtual std::vector<PointAnswer> evaluate(std::span<const files::ControlPoint> points_world) = 0;

  [[nodiscard]] virtual AnswerColumns columns() const = 0;
};

}  // namespace depthgrid::program
