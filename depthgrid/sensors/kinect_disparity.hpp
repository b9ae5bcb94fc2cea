// From the 11-bit disparities of a Kinect v1 to millimetres.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace depthgrid::sensors {

/// What a Kinect v1 knows of itself: it measures by how much the pattern is shifted against one on a plane at a known
/// distance. The defaults are those of one device (libfreenect's); devices differ by percents.
struct KinectZeroPlane {
  double emitter_distance_cm = 7.5;    ///< from the infrared camera to the projector
  double reference_distance_mm = 120;  ///< as the device states it
  double pixel_size_mm = 0.1042;       ///< of the sensor's pixel on that plane, as the device states it
  double shift = 200;                  ///< of the reference pattern, in pixels
};

/// A table for all 2048 readings, millimetres; 0: no reading. With x = (raw - 4 shift) / 4 - 0.375 pixels and
/// m = x pixel_size the distance is 10 (m reference / (emitter - m) + reference), the formula by which libfreenect
/// and OpenNI convert; that is 1 / (a - b raw). Rounded down: nearer, not farther. Beyond 10 m, and 2047: none.
class KinectDisparity {
 public:
  static constexpr std::uint16_t kNone = 2047;
  static constexpr double kFarthest_mm = 10000;

  explicit KinectDisparity(const KinectZeroPlane& plane = {});

  [[nodiscard]] std::uint16_t mm(std::uint16_t raw) const noexcept { return raw < kNone ? table_[raw] : 0; }
  /// As many as there are in both.
  void convert(std::span<const std::uint16_t> raw, std::span<std::uint16_t> mm) const noexcept;

 private:
  std::array<std::uint16_t, kNone> table_{};
};

}  // namespace depthgrid::sensors
