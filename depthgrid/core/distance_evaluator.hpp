// The interface of everything that turns depth images into distances: images in, answers out.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "depthgrid/core/answer.hpp"
#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/frame_update.hpp"
#include "depthgrid/core/impossible_surfaces.hpp"
#include "depthgrid/core/past.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid {

/// - Takes: frames of a rig's cameras; capsules in the world frame, metres; times in seconds on the frames' clock.
/// - Gives: an Answer for each capsule.
/// - Errors: only constructors throw; update() says what became of a frame.
/// - Threads: one, unless the evaluator says more. Nothing but construction locks or allocates.
class DistanceEvaluator {
 public:
  DistanceEvaluator() = default;
  virtual ~DistanceEvaluator() = default;

  [[nodiscard]] virtual std::string_view name() const noexcept = 0;
  [[nodiscard]] virtual std::size_t camera_count() const noexcept = 0;
  /// Exposure of the camera's image behind the newest answers, seconds on the frames' clock; NaN where there is none,
  /// or it has no time. For the thread that evaluates.
  [[nodiscard]] virtual double image_time_s(std::size_t camera) const noexcept = 0;

  /// What the evaluator's memory found impossible so far, as of the newest answers; nothing where it has no memory. It
  /// stays at 0 images unless something that was declared is not true: tell a person. For the thread that evaluates.
  [[nodiscard]] virtual ImpossibleSurfaces impossible() const noexcept { return {}; }

  /// What the evaluator's memory knows of an answer's nearest point: since when something may be there, and from where.
  /// By the newest image; not_told without a memory, and of surfaces that are measured. reason_text() makes words of
  /// it. For one thread at a time; others may update and evaluate meanwhile.
  [[nodiscard]] virtual Past past(const Proximity& /*nearest*/) const noexcept { return {}; }

  /// A camera's newest image; its buffers need not outlive the call. With `T_world_camera` the camera has moved,
  /// without it stands where the rig says. `camera` beyond the rig is `unusable`.
  [[nodiscard]] virtual FrameUpdate update(std::size_t camera, const Frame& frame) noexcept = 0;
  [[nodiscard]] virtual FrameUpdate update(std::size_t camera, const Frame& frame,
                                           const Pose& T_world_camera) noexcept = 0;

  /// One answer a capsule (world frame), for the time `now_s` on the frames' clock. answers.size() should equal
  /// capsules.size(): answers without a capsule are not_evaluated, as are those of capsules that the evaluator refuses
  /// or that are not finite.
  virtual void evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept = 0;

 protected:
  DistanceEvaluator(const DistanceEvaluator&) = default;
  DistanceEvaluator(DistanceEvaluator&&) = default;
  DistanceEvaluator& operator=(const DistanceEvaluator&) = default;
  DistanceEvaluator& operator=(DistanceEvaluator&&) = default;
};

/// The newest frame of every camera, in the rig's order; a camera without one has seen nothing. When not all were taken
/// it says what became of the first that was not.
[[nodiscard]] FrameUpdate update_all(DistanceEvaluator& evaluator, std::span<const Frame> frames) noexcept;

}  // namespace depthgrid
