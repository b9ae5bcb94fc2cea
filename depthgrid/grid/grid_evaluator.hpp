// Distances from points on the depth grid, by the letter's section VI, literally or with its errors mended.
#pragma once

#include <memory>

#include "depthgrid/core/distance_evaluator.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/depth_grid_map.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/memory/memory_store.hpp"

namespace depthgrid::grid {

/// Why the grid does not answer a capsule, as a static string: it has a radius, a length (the letter knows points
/// only), or a coordinate that is not finite. Null: it is a point, and answered.
[[nodiscard]] const char* why_refused(const Capsule& capsule) noexcept;

/// Evaluates distances on one rig.
/// - Takes: frames of the rig's cameras; points (capsules without radius and length) in the world frame, metres.
/// - Gives: an Answer for each point.
/// - Errors: the constructor throws Error; update() says what became of a frame, why_refused() why there is no answer.
/// - Threads: evaluate() and distance() from many at once, but not while update() runs.
///
/// The letter does not ask how old an image is: distance_now_m is the distance at the time of the images,
/// min(D, known_to). Only when one is older than max_image_age_s at `now_s`, distance_now_m is NaN and the answer
/// stale.
class GridEvaluator final : public DistanceEvaluator {
 public:
  /// `principal` indexes rig.cameras; all other cameras are secondary. Images must be free of lens distortion already.
  /// Throws Error when rig, grid or settings are invalid, or when `map` was made for another calibration.
  GridEvaluator(const Rig& rig, std::size_t principal, const DepthQuantisation& quantisation,
                const EvaluationSettings& settings, std::shared_ptr<const DepthGridMap> map = nullptr);
  ~GridEvaluator() override;
  GridEvaluator(GridEvaluator&&) noexcept;
  GridEvaluator& operator=(GridEvaluator&&) noexcept;
  GridEvaluator(const GridEvaluator&) = delete;
  GridEvaluator& operator=(const GridEvaluator&) = delete;

  [[nodiscard]] std::string_view name() const noexcept override { return "grid"; }
  [[nodiscard]] std::size_t camera_count() const noexcept override;
  [[nodiscard]] double image_time_s(std::size_t camera) const noexcept override;

  /// Only with a memory (EvaluationSettings::memory).
  [[nodiscard]] ImpossibleSurfaces impossible() const noexcept override;
  [[nodiscard]] Past past(const Proximity& nearest) const noexcept override;
  /// Null without memory. What the robot puts down or lets go has to be said to it: MemoryStore::occupy().
  [[nodiscard]] memory::MemoryStore* memory() noexcept;

  /// A frame that is missing (no data), has another size or depth scale than the rig says, or half a robot view is
  /// `unusable`; a camera without a frame so far has measured nothing. With `T_world_camera` too, unless it is the
  /// rig's: the grid's cameras do not move.
  [[nodiscard]] FrameUpdate update(std::size_t camera, const Frame& frame) noexcept override;
  [[nodiscard]] FrameUpdate update(std::size_t camera, const Frame& frame,
                                   const Pose& T_world_camera) noexcept override;

  /// Capsules that why_refused() names are not_evaluated.
  void evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept override;

  /// Of one point. `count` must not be shared between threads.
  [[nodiscard]] Answer distance(const Capsule& capsule, EvaluationCount* count = nullptr) const noexcept;

  [[nodiscard]] const DepthGrid& grid() const noexcept;
  [[nodiscard]] const EvaluationSettings& settings() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::grid
