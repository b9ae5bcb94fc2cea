// Where the loop takes its distances from: nothing, the letter's grid, or the sound search.
#pragma once

#include <span>
#include <string_view>

#include "depthgrid/control/obstacle.hpp"
#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/proximity.hpp"

namespace depthgrid::avoidance {

/// What is known about one part of the robot.
struct PartAnswer {
  Proximity nearest;                                   ///< as the evaluator gave it, at the time of the images
  control::Obstacle obstacle;                          ///< for the control laws, at the time asked for
  Eigen::Vector3d at_world = Eigen::Vector3d::Zero();  ///< the part's point that the answer is about
};

/// One thread. Neither take() nor evaluate() throws or locks; SearchDistances and NoDistances do not allocate either.
class DistanceSource {
 public:
  DistanceSource() = default;
  virtual ~DistanceSource() = default;
  DistanceSource(const DistanceSource&) = delete;
  DistanceSource& operator=(const DistanceSource&) = delete;

  [[nodiscard]] virtual std::string_view name() const noexcept = 0;

  /// The newest image of every camera, in the rig's order. The buffers need not outlive the call. False when one could
  /// not be used: that camera then has seen nothing; or, with the search, when held snapshots left no room for it: then
  /// its image before stays the newest.
  virtual bool take(std::span<const Frame> frames) noexcept = 0;

  /// parts_world and answers have the same size; `now_s` is on the frames' clock.
  virtual void evaluate(std::span<const Capsule> parts_world, double now_s, std::span<PartAnswer> answers) noexcept = 0;
};

/// No avoidance: nothing is ever near.
class NoDistances final : public DistanceSource {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "none"; }
  bool take(std::span<const Frame> frames) noexcept override;
  void evaluate(std::span<const Capsule> parts_world, double now_s, std::span<PartAnswer> answers) noexcept override;
};

}  // namespace depthgrid::avoidance
