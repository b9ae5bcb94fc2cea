// The depth stream of a device of OpenNI2, or of a file that it recorded. Private.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/sensors/openni_library.hpp"

namespace depthgrid::sensors::oni {

struct StreamRequest {
  std::string device{};   ///< URI or serial number; empty: the only one
  std::string file{};     ///< a recording in place of a device
  bool mirrored = false;  ///< the recording's images, which does not say it itself
  int width_px = 640;     ///< of a device
  int height_px = 480;
  int rate_hz = 30;
  bool only_looks = false;  ///< sets nothing in the device; start() is not for it
};

/// - Threads: one.
/// - Errors: Error.
class DepthStream {
 public:
  /// Opens and sets up, does not start.
  DepthStream(std::shared_ptr<const OpenniLibrary> library, const StreamRequest& request);
  ~DepthStream();
  DepthStream(const DepthStream&) = delete;
  DepthStream& operator=(const DepthStream&) = delete;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const std::string& serial() const noexcept { return serial_; }  ///< the URI where there is none
  [[nodiscard]] const std::string& settings() const noexcept { return settings_; }
  [[nodiscard]] const VideoMode& mode() const noexcept { return mode_; }
  [[nodiscard]] double metres_per_unit() const noexcept { return mode_.format == kDepth100um ? 1e-4 : 1e-3; }
  /// By the field of view, with the principal point in the middle: no calibration.
  [[nodiscard]] std::optional<PinholeCamera> nominal() const;
  [[nodiscard]] int frames() const;  ///< of a recording
  [[nodiscard]] bool is_gone() const noexcept { return is_gone_.load(std::memory_order_relaxed); }

  void start();
  /// Also before the end; once is enough.
  void stop() noexcept;
  /// The next image of a recording, the newest of a device. False: none within that time.
  [[nodiscard]] bool take(double longest_s);
  // Of the image that was taken last.
  [[nodiscard]] DepthView depth() const;
  [[nodiscard]] double stamp_s() const noexcept { return stamp_s_; }
  [[nodiscard]] int index() const noexcept { return index_; }

 private:
  [[nodiscard]] const Functions& f() const noexcept { return library_->functions(); }
  [[nodiscard]] std::string uri_of(const StreamRequest& request) const;
  void set_up(const StreamRequest& request);
  [[nodiscard]] std::string filters_off();
  void read_mode(const StreamRequest& request);
  void close() noexcept;
  void copy(const Frame& frame);
  static void on_disconnected(const DeviceInfo* info, void* stream) noexcept;

  std::shared_ptr<const OpenniLibrary> library_;
  bool is_recording_;
  std::string uri_;
  std::atomic<bool> is_gone_{false};
  void* callbacks_ = nullptr;
  Device device_ = nullptr;
  Stream stream_ = nullptr;
  bool is_started_ = false;
  bool is_mirrored_ = false;
  VideoMode mode_{};
  std::string name_;
  std::string serial_;
  std::string settings_;
  std::vector<std::uint16_t> pixels_;
  double stamp_s_ = 0;
  int index_ = 0;
};

struct FoundDevice {
  std::string name;
  std::string uri;
  std::string serial;
};

[[nodiscard]] std::vector<FoundDevice> connected(const std::shared_ptr<const OpenniLibrary>& library);

}  // namespace depthgrid::sensors::oni
