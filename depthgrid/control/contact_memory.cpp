#include "depthgrid/control/contact_memory.hpp"

namespace depthgrid::control {

Obstacle ContactMemory::completed(const Obstacle& obstacle, std::size_t point, double period_s,
                                  double longest_s) noexcept {
  if (point >= kMaxPoints) {
    return obstacle;
  }
  Kept& kept = kept_[point];
  // Where nothing is known there is nothing to come away from.
  if (!obstacle.pushes || !obstacle.distance_m) {
    kept = {};
    return obstacle;
  }
  if (obstacle.direction_world) {
    kept = {obstacle, 0};
    return obstacle;
  }
  kept.age_s += period_s;
  if (!kept.obstacle.direction_world || kept.age_s > longest_s) {
    return obstacle;
  }
  Obstacle completed = obstacle;
  completed.direction_world = kept.obstacle.direction_world;
  completed.hybrid_direction_world = kept.obstacle.hybrid_direction_world;
  return completed;
}

}  // namespace depthgrid::control
