// Several structured-light sensors in one room: where the patterns of two overlap, a sensor loses measurements in black
// spots. An assumption, with published shares; nothing about interference can be learned from it.
#pragma once

#include <cstdint>
#include <span>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::simulation {

/// Maimone and Fuchs (VR 2012) lost 16.6 % of the pixels with six units, and 1.4 % when the units vibrated. Spread
/// evenly over the five others, each for itself: 1 - (1 - 0.166)^(1/5), and so on.
struct InterferenceModel {
  double lost_share = 0.0357;            ///< of the pixels that one other unit lights too
  double lost_share_vibrating = 0.0028;  ///< the same when either of the two vibrates
  double spot_radius_px = 2.5;
};

/// A structured-light unit. Its projector is taken to stand at its camera.
struct StructuredLightUnit {
  PinholeCamera camera;
  Pose T_world_camera = Pose::Identity();
  const DepthImage* ideal_m = nullptr;  ///< what it sees, and so lights; has its camera's size
  bool vibrating = false;
};

/// Deletes the measurements that unit `self` loses to the others in this frame, in spots where both patterns fall on
/// the same surface. `measured_m` has the size of its camera. Reproducible: seed and frame decide. Throws Error when a
/// share is not in [0, 1), the radius not in [0, 16], an image is missing or has another size.
void apply_interference(std::span<const StructuredLightUnit> units, std::size_t self, const InterferenceModel& model,
                        std::uint64_t seed, std::uint64_t frame, DepthImage& measured_m);

}  // namespace depthgrid::simulation
