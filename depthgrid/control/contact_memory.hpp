// Where an obstacle stood before it was touched.
//
// At contact no answer has a direction, and without one a law can only stop. So the last direction is kept for a while.
#pragma once

#include <array>
#include <cstddef>

#include "depthgrid/control/obstacle.hpp"

namespace depthgrid::control {

/// Directions of the points of a robot, by their index. Nothing allocates, locks or throws.
class ContactMemory {
 public:
  /// Most points that are remembered; those after them are passed on unchanged.
  static constexpr std::size_t kMaxPoints = 64;

  /// The obstacle with its last directions put in where it has none; none older than `longest_s`. A point that has
  /// something to name is remembered. An unknown distance stays unknown. Call it once a period for every point.
  [[nodiscard]] Obstacle completed(const Obstacle& obstacle, std::size_t point, double period_s,
                                   double longest_s) noexcept;

  void forget() noexcept { *this = {}; }

 private:
  struct Kept {
    Obstacle obstacle;
    double age_s = 0;
  };
  std::array<Kept, kMaxPoints> kept_{};
};

}  // namespace depthgrid::control
