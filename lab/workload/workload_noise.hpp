// The moving scene of workload W as a real sensor would deliver it: noise, quantisation and holes.
//
// Axial noise of standard deviation 0.5 mm + 1.5 mm/m^2 z^2 (a structured-light sensor of the first generation: 10 mm
// at 2.5 m), cut off at three standard deviations; quantised in steps of 2.8 mm/m^2 z^2 (11 mm at 2 m, steps of equal
// disparity); then to whole millimetres; one pixel in a hundred without measurement, each for itself. Every image has
// noise of its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/core/margin.hpp"
#include "lab/workload/workload.hpp"

namespace depthgrid::lab {

/// Metres around the robot in its near and far images: more than noise and margin of a sensor 2.7 m away, so that the
/// robot's own pixels are recognised.
inline constexpr double kNoisyRobotPadding = 0.10;

/// Covers the noise above: three standard deviations and half a step of quantisation, in terms of the measured depth.
[[nodiscard]] SensorMargin noise_margin() noexcept;

/// Noisy copies of a workload's images; refers to its robot intervals, so the workload must outlive it.
class NoisyWorkload {
 public:
  explicit NoisyWorkload(const Workload& clean);

  [[nodiscard]] std::span<const Frame> frames(int frame_set) const noexcept;

 private:
  std::size_t cameras_;
  std::vector<std::vector<std::uint16_t>> depth_mm_;
  std::vector<Frame> frames_;
};

}  // namespace depthgrid::lab
