// Surfaces that were measured where, by everything that was declared, nothing could be.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace depthgrid {

/// What a memory (docs/memory.md) found impossible so far. It counts as an obstacle all the same; but something that
/// was declared is not true: v_max is too low, a calibration or a clock is wrong, or something was dropped.
/// - Frame and units: world, metres, seconds on the frames' clock.
struct ImpossibleSurfaces {
  std::int64_t images = 0;  ///< that showed any
  std::int64_t voxels = 0;  ///< that held them, over all images
  /// Of the newest of these images: its camera, its exposure, and the middle of a voxel that held the surface.
  std::uint16_t camera = 0;
  double time_s = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector3d at_world = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// One sentence for people, with what to look at; empty where there is nothing to say. At most as long as the buffer;
/// 240 characters and the camera's name are enough. Locks and allocates nothing. Without a name the camera is called by
/// its number.
[[nodiscard]] std::string_view describe(const ImpossibleSurfaces& found, std::span<char> buffer,
                                        std::string_view camera_name = {}) noexcept;

}  // namespace depthgrid
