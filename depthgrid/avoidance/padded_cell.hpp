// An empty cell seen with one padding of the robot: what is nearest to its links, and what each camera says of a place.
// Internal.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "depthgrid/avoidance/least_padding.hpp"
#include "depthgrid/core/answer.hpp"

namespace depthgrid::avoidance {

/// What is asked, checked once.
struct PaddingProblem {
  Rig rig;
  std::span<const EmptyCell> cells;
  LeastPaddingSettings settings;
  std::vector<robot::LinkCapsule> removed;  ///< all of the robot
  std::vector<robot::LinkCapsule> asked;    ///< those of one link stand together
};

/// Throws Error as least_padding() says.
[[nodiscard]] PaddingProblem padding_problem(const Rig& rig, const robot::RobotModel& model,
                                             std::span<const EmptyCell> cells, const LeastPaddingSettings& settings);

/// The robot taken out of the images with one padding. Its removal's buffers hold one cell at a time.
class PaddedCell {
 public:
  PaddedCell(const PaddingProblem& problem, double padding_m);

  /// The frames of a cell with the robot in them; good until the next call.
  [[nodiscard]] std::span<const Frame> frames(std::size_t cell);

  /// Of the camera alone: what it says of a place, and `around_m`, how far from there on it sees free, at most 5 cm.
  struct Alone {
    CameraSays says;
    double around_m = 0;
  };
  [[nodiscard]] Alone alone(std::size_t cell, std::size_t camera, const Eigen::Vector3d& place_world);

 private:
  const PaddingProblem& problem_;
  std::vector<robot::RobotRemoval> removals_;
  std::vector<Frame> frames_;
};

/// Newest exposure of all; times are finite.
[[nodiscard]] double newest_s(std::span<const Frame> frames) noexcept;

/// Of each cell after the warm-up, in their order: one answer an asked capsule, at the newest exposure. Throws Error
/// where a frame cannot be used.
[[nodiscard]] std::vector<std::vector<Answer>> answers_with(const PaddingProblem& problem, double padding_m);

/// The farthest part of the padded robot from a camera, metres.
[[nodiscard]] double reach_m(const PaddingProblem& problem, double padding_m);

}  // namespace depthgrid::avoidance
