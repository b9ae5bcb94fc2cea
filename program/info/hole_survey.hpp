// How much of a camera's images frees nothing, how wide the holes are, and which smallest obstacle would help.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::program {

/// One camera's images, prepared as the search would with the margins that the rig file states, else with a filter
/// radius of 1 px and no noise, and with several smallest obstacles.
class HoleSurvey {
 public:
  static constexpr std::array<double, 5> kSizes_m{0, 0.01, 0.02, 0.03, 0.05};

  explicit HoleSurvey(RigCamera camera) : camera_(std::move(camera)) {}
  /// An image of the camera, without lens distortion. Takes some 50 ms for 640 x 480 pixels.
  void add(const Frame& frame);

  [[nodiscard]] std::int64_t pixels() const noexcept { return pixels_; }
  /// Pixels along whose rays nothing beyond the blind zone is free, with each of kSizes_m.
  [[nodiscard]] const std::array<std::int64_t, kSizes_m.size()>& freeing_nothing() const noexcept { return nothing_; }
  /// Pixels without reading in holes less than 2^(n+1) px wide and not less than 2^n; the last n: all wider ones.
  static constexpr std::size_t kWidths = 6;
  [[nodiscard]] const std::array<std::int64_t, kWidths>& by_width() const noexcept { return by_width_; }
  /// The least of kSizes_m that frees at least three quarters of what the largest does; 0 where that is hardly
  /// anything.
  [[nodiscard]] double useful_size_m() const noexcept;

 private:
  RigCamera camera_;
  std::int64_t pixels_ = 0;
  std::array<std::int64_t, kSizes_m.size()> nothing_{};
  std::array<std::int64_t, kWidths> by_width_{};
};

/// Up to which depth each pixel frees space with this smallest obstacle; 0: nothing beyond the blind zone. An image of
/// zeros where the frame is unusable.
[[nodiscard]] DepthImage freed_depths(const RigCamera& camera, const Frame& frame, double smallest_obstacle_m);

/// A table with a row for each camera of the rig.
[[nodiscard]] std::string holes_text(const Rig& rig, const std::vector<HoleSurvey>& surveys);

}  // namespace depthgrid::program
