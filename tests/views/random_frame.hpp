// Random cameras and frames that meet every rule of the preparation of images.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::views {

/// A camera of this size with what the preparation needs to know.
struct RandomCamera {
  RigCamera camera;
  CameraMargins margins;
  Policies policies;
};

/// Owns the buffers of a frame: padded rows, bottom-up ones among them, both formats, with and without a robot.
class RandomFrame {
 public:
  RandomFrame(const RandomCamera& camera, std::mt19937_64& random);

  [[nodiscard]] const Frame& frame() const { return frame_; }

 private:
  std::vector<std::uint16_t> units_;
  std::vector<float> metres_;
  std::vector<float> near_m_, far_m_;
  Frame frame_;
};

RandomCamera random_camera(int width_px, int height_px, std::mt19937_64& random);

}  // namespace depthgrid::views
