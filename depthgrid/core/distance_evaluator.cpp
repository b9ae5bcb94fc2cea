#include "depthgrid/core/distance_evaluator.hpp"

#include <algorithm>

namespace depthgrid {

FrameUpdate update_all(DistanceEvaluator& evaluator, std::span<const Frame> frames) noexcept {
  FrameUpdate first;
  for (std::size_t k = 0; k < std::max(frames.size(), evaluator.camera_count()); ++k) {
    const FrameUpdate one = evaluator.update(k, k < frames.size() ? frames[k] : Frame{});
    first = first.taken() ? one : first;
  }
  return first;
}

}  // namespace depthgrid
