// A Kinect v1, by libfreenect, which is loaded when the camera is opened.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/sensors/device_clock.hpp"
#include "depthgrid/sensors/kinect_disparity.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

class FreenectLibrary;

struct FreenectSettings {
  std::string serial{};  ///< empty: the only one that is connected
  ArrivalTimes arrival{};
};

/// 640 x 480 disparities of 11 bits at 30 Hz, converted by KinectDisparity with what the device says of itself, where
/// its library hands that on. The device states no intrinsics: info().nominal. Its stamps are of a clock of its own:
/// DeviceClock, with ArrivalTimes. An image of which USB packets were lost is passed over and counted as skipped, and
/// so is the one after it, which may miss some too. Ends as failed when it is unplugged, and when no image comes within
/// two seconds.
class FreenectCamera final : public DepthSource {
 public:
  explicit FreenectCamera(FreenectSettings settings);
  /// With a library that is loaded already: for tests.
  FreenectCamera(FreenectSettings settings, std::shared_ptr<const FreenectLibrary> library);
  ~FreenectCamera() override;
  FreenectCamera(const FreenectCamera&) = delete;
  FreenectCamera& operator=(const FreenectCamera&) = delete;

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

  /// Usual intrinsics of a device with this plane, with the principal point in the middle: no calibration.
  [[nodiscard]] static PinholeCamera nominal(const KinectZeroPlane& plane);

  static constexpr int kWidth_px = 640;
  static constexpr int kHeight_px = 480;
  static constexpr double kLongestSilence_s = 2;

 private:
  struct Device;  ///< what libfreenect handed out

  FreenectSettings settings_;
  std::shared_ptr<const FreenectLibrary> library_;
  std::unique_ptr<Device> device_;
  KinectDisparity disparity_;
  std::optional<DeviceClock> clock_;
  Unwrapped32 ticks_;
  std::vector<std::uint16_t> depth_mm_;
  double last_image_s_ = 0;
  std::int64_t unsettled_ = 0;  ///< images that were not given, since the last one that was
  SourceInfo info_;
  std::string reason_;
};

/// Serial numbers of the Kinects that are connected; empty texts where the library does not say them. Throws Error,
/// where libfreenect is not found as well.
[[nodiscard]] std::vector<std::string> connected_freenect();

}  // namespace depthgrid::sensors
