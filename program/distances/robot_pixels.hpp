// Which pixels of an image were taken for the robot, and which of its model were not, and why.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/margin.hpp"

namespace depthgrid::program {

enum class RobotPixel : std::uint8_t {
  none,           ///< neither taken for the robot nor showing its capsules
  removed,        ///< taken for the robot, on its capsules
  in_padding,     ///< taken for the robot, beside its capsules
  within_margin,  ///< on its capsules; the reading is in the padded span, but nearer to its front than the sensor's
                  ///< margin
  nearer,         ///< on its capsules; the reading is before the padded span
  farther,        ///< on its capsules; the reading is behind the padded span
  no_reading,     ///< on its capsules
};
inline constexpr std::size_t kRobotPixelKinds = 7;

/// One kind a pixel, row by row. `padded`: the span that decides; `bare`: the span of the capsules themselves, with or
/// without stride as the images. A pixel is taken where near <= D - m(D) and D <= far. Of a robot that is not known in
/// this image (null) all are `none`.
void classify_robot_pixels(const DepthImage& measured_m, const RobotView& padded, const RobotView& bare,
                           const SensorMargin& margin, std::vector<RobotPixel>& kinds);

/// Of one camera, over all frames.
struct RobotPixelCount {
  int images = 0;
  std::array<std::int64_t, kRobotPixelKinds> pixels{};

  void add(std::span<const RobotPixel> kinds);
  [[nodiscard]] std::int64_t of(RobotPixel kind) const { return pixels.at(static_cast<std::size_t>(kind)); }
  /// Pixels that show the capsules.
  [[nodiscard]] std::int64_t on_capsules() const;
};

/// "camera 'front', 5 images: ..." in one line.
[[nodiscard]] std::string to_text(const RobotPixelCount& count, const std::string& camera);

}  // namespace depthgrid::program
