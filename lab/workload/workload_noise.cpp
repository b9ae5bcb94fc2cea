#include "lab/workload/workload_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depthgrid/core/depth_image.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kNoiseConstant = 0.0005;
constexpr double kNoiseQuadratic = 0.0015;
constexpr double kStepQuadratic = 0.0028;
constexpr double kLargestDeviation = 3.0;
constexpr double kInvalidShare = 0.01;

/// splitmix64: repeatable, and quick enough for a hundred million pixels.
class Stream {
 public:
  explicit Stream(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15U) {}
  /// In (0, 1].
  double uniform() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return static_cast<double>(((z ^ (z >> 31U)) >> 11U) + 1) * 0x1p-53;
  }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return std::clamp(radius * std::cos(2 * std::numbers::pi * uniform()), -kLargestDeviation, kLargestDeviation);
  }

 private:
  std::uint64_t state_;
};

std::uint16_t noisy_mm(std::uint16_t depth_mm, Stream& stream) {
  const bool valid = stream.uniform() > kInvalidShare;
  const double deviation = stream.normal();
  if (depth_mm == 0 || !valid) {
    return 0;
  }
  const double z_m = depth_mm * 1e-3;
  const double noisy_m = z_m + deviation * (kNoiseConstant + kNoiseQuadratic * z_m * z_m);
  // Equal steps of 1/z are steps of kStepQuadratic z^2 in z.
  const double quantised_m = 1 / (kStepQuadratic * std::round(1 / (noisy_m * kStepQuadratic)));
  return static_cast<std::uint16_t>(std::clamp(std::lround(1000 * quantised_m), 1L, 65534L));
}

}  // namespace

SensorMargin noise_margin() noexcept {
  SensorMargin margin;
  // A measured depth is too large by at most this, which grows with depth, so taking it at the measured one is enough.
  // The half millimetre is the last rounding.
  margin.constant_m = kLargestDeviation * kNoiseConstant + 0.0005;
  margin.quadratic_per_m = kLargestDeviation * kNoiseQuadratic + 0.5 * kStepQuadratic;
  margin.lateral_px = 1;
  return margin;
}

NoisyWorkload::NoisyWorkload(const Workload& clean) : cameras_(clean.rig().cameras.size()) {
  const std::size_t images = cameras_ * static_cast<std::size_t>(clean.frame_sets());
  depth_mm_.reserve(images);
  frames_.reserve(images);
  for (int set = 0; set < clean.frame_sets(); ++set) {
    for (const Frame& frame : clean.frames(set)) {
      Stream stream(depth_mm_.size() + 1);
      const auto pixels =
          static_cast<std::size_t>(frame.depth.width_px) * static_cast<std::size_t>(frame.depth.height_px);
      const std::span depth_mm(static_cast<const std::uint16_t*>(frame.depth.data), pixels);
      std::vector<std::uint16_t>& noisy = depth_mm_.emplace_back(pixels);
      std::transform(depth_mm.begin(), depth_mm.end(), noisy.begin(),
                     [&stream](std::uint16_t mm) { return noisy_mm(mm, stream); });
      Frame copy = frame;
      copy.depth = depth_view(std::span<const std::uint16_t>(noisy), frame.depth.width_px, frame.depth.height_px,
                              frame.depth.metres_per_unit);
      frames_.push_back(copy);
    }
  }
}

std::span<const Frame> NoisyWorkload::frames(int frame_set) const noexcept {
  return std::span(frames_).subspan(static_cast<std::size_t>(frame_set) * cameras_, cameras_);
}

}  // namespace depthgrid::lab
