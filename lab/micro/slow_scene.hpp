// Images that may be slow to search, as a handful of numbers that can be changed at random and written in a line.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace depthgrid::lab {

/// A tilted wall, stripes before it, specks before both, noise and pixels without reading; the same for all cameras but
/// for where the specks and the noise fall. Metres, shares of all pixels, pixels.
struct SlowScene {
  std::uint64_t seed = 1;
  double cameras = 2;    ///< rounded down, 1 to 8
  double wall_m = 4;     ///< in the middle of the image
  double tilt_m = 0;     ///< from the left to the right border
  double stripe_px = 0;  ///< width; below 1: none
  double stripe_m = 2;   ///< depth of every second stripe
  double speck_share = 0.005;
  double speck_px = 1;  ///< side
  double speck_near_m = 0.5;
  double speck_far_m = 4;
  double noise_m = 0;  ///< uniform, to both sides
  double missing_share = 0;
  double pose_error_m = 0;  ///< e of the search, not in the images

  [[nodiscard]] int camera_count() const { return static_cast<int>(cameras); }
};

/// "seed=1 cameras=2.5 ...": all fields, so that scene_from_text() gives the same images.
[[nodiscard]] std::string to_text(const SlowScene& scene);
/// Throws Error with the word that is wrong. Fields that are not named keep their default.
[[nodiscard]] SlowScene scene_from_text(const std::string& text);

/// One to three fields anew, half of the time a step from where they are, within what images can be.
[[nodiscard]] SlowScene mutated(const SlowScene& scene, std::mt19937_64& generator);

/// 640 x 480 depths in millimetres of camera k, 0: no reading.
[[nodiscard]] std::vector<std::uint16_t> image_of(const SlowScene& scene, int k);

}  // namespace depthgrid::lab
