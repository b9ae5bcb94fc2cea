// No avoidance.
#pragma once

#include "depthgrid/core/distance_evaluator.hpp"

namespace depthgrid::avoidance {

/// Knows, without cameras, that nothing is near.
class NothingNear final : public DistanceEvaluator {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "none"; }
  [[nodiscard]] std::size_t camera_count() const noexcept override { return 0; }
  [[nodiscard]] double image_time_s(std::size_t /*camera*/) const noexcept override { return Proximity::kNaN; }
  [[nodiscard]] FrameUpdate update(std::size_t /*camera*/, const Frame& /*frame*/) noexcept override { return {}; }
  [[nodiscard]] FrameUpdate update(std::size_t /*camera*/, const Frame& /*frame*/,
                                   const Pose& /*T_world_camera*/) noexcept override {
    return {};
  }
  void evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept override;
};

}  // namespace depthgrid::avoidance
