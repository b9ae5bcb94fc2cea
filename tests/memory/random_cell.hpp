// Cameras around a small region, and images of it: walls, things before them, holes, and a robot.
#pragma once

#include <optional>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/memory/settings.hpp"
#include "depthgrid/views/view_store.hpp"
#include "reference/random_problem.hpp"

namespace depthgrid::memory {

/// Everything but the images. Cameras look at the region from all sides.
struct RandomCell {
  explicit RandomCell(reference::Random& random);

  Rig rig;
  views::Settings settings;
  MemorySettings memory;
};

/// An image of one of the cell's cameras, which may stand a little beside where the rig says.
class RandomImage {
 public:
  RandomImage(const RandomCell& cell, std::size_t camera, double time_s, reference::Random& random);

  [[nodiscard]] const Frame& frame() const { return frame_; }
  [[nodiscard]] const Pose& T_world_camera() const { return T_world_camera_; }

 private:
  std::vector<float> depth_m_, near_m_, far_m_;
  std::vector<Capsule> links_;
  Frame frame_;
  Pose T_world_camera_;
};

}  // namespace depthgrid::memory
