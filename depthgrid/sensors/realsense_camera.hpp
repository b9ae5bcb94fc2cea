// A RealSense depth camera, by librealsense2, which is loaded when the camera is opened.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/sensors/device_clock.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

namespace rs2 {
class Library;
class Stream;
struct Frame;
}  // namespace rs2

struct RealSenseSettings {
  std::string serial{};  ///< empty: the only one that is connected
  int width_px = 640;
  int height_px = 480;
  int rate_hz = 30;
  ArrivalTimes arrival{};
  /// An image that was exposed for longer ends next() as failed: what is declared of motion would not cover it.
  std::optional<double> longest_exposure_s{};
};

/// Sets the preset of high accuracy (D400), the emitter on and alternating modes off, and asks for global time; what
/// the device then says, and what it did not take, is in info().settings. Images are 16-bit depth as the device
/// computes it, in its own unit; no filter is applied. Times are the middle of the exposure:
///
/// | the stamp is of          | what is done |
/// | ------------------------ | ------------ |
/// | global time              | the system's clock: the middle of the exposure as the device says it; else half the
/// |                          | exposure is taken off, or a whole period where it says no exposure either. Never later
/// |                          | than the arrival less half the exposure; images of the first second are passed over,
/// |                          | since the library still compares the clocks; refused unless 5 ms are declared |
/// | the device's own clock   | as DeviceClock, with ArrivalTimes |
/// | the arrival, system time | refused unless ArrivalTimes says how long before that it was exposed |
///
/// Ends as failed when it is unplugged, when no image comes within two seconds, when an image has another size than
/// asked for, and when the stamps change to another clock.
class RealSenseCamera final : public DepthSource {
 public:
  explicit RealSenseCamera(RealSenseSettings settings);
  /// With a library that is loaded already: for tests.
  RealSenseCamera(RealSenseSettings settings, std::shared_ptr<const rs2::Library> library);
  ~RealSenseCamera() override;
  RealSenseCamera(const RealSenseCamera&) = delete;
  RealSenseCamera& operator=(const RealSenseCamera&) = delete;

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

  static constexpr double kLongestSilence_s = 2;
  static constexpr double kComparing_s = 2;  ///< global time begins within it, or never
  static constexpr double kFitting_s = 1;    ///< global time is worse at its beginning

 private:
  struct Held;  ///< the frame whose pixels were given
  [[nodiscard]] Reading silence(double now_s);
  [[nodiscard]] Reading read(DepthReading& reading);
  void begin_clock(int domain);
  /// None: not yet known.
  [[nodiscard]] std::optional<double> exposed_s(const rs2::Frame* frame, double arrival_s);

  RealSenseSettings settings_;
  std::shared_ptr<const rs2::Library> library_;
  std::unique_ptr<rs2::Stream> stream_;
  std::unique_ptr<Held> held_;
  std::optional<int> domain_;
  std::optional<DeviceClock> device_clock_;
  double domain_since_s_ = 0;
  double opened_s_ = 0;
  double arrival_lag_s_ = 0;
  double last_image_s_ = 0;
  std::int64_t last_number_ = -1;
  std::int64_t unsettled_ = 0;  ///< images that came before the clock was known
  SourceInfo info_;
  std::string reason_;
};

struct RealSenseFound {
  std::string name;
  std::string serial;
};

/// The RealSense cameras that are connected. Throws Error, where librealsense2 is not found as well.
[[nodiscard]] std::vector<RealSenseFound> connected_realsense();

}  // namespace depthgrid::sensors
