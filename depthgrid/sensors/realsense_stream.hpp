// The depth stream of one RealSense device, or of a file that one recorded. Private.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/sensors/realsense_frame_box.hpp"
#include "depthgrid/sensors/realsense_library.hpp"

namespace depthgrid::sensors::rs2 {

struct StreamRequest {
  std::string serial{};  ///< empty: the only device
  std::string file{};    ///< a recording in place of a device
  int width_px = 640;
  int height_px = 480;
  int rate_hz = 30;
  bool any_size = false;    ///< the first depth stream there is: of a recording
  bool only_looks = false;  ///< sets nothing in the device
};

struct FoundDevice {
  std::string name;
  std::string serial;
};

/// The devices that are connected. Throws Error.
[[nodiscard]] std::vector<FoundDevice> connected(const Library& library);

class Stream;

/// The streams that want to hear of unplugged devices: the library may call while one of them ends, so it is given a
/// number in place of a pointer.
class Watch {
 public:
  Watch() = default;
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// What the library is to be given.
  [[nodiscard]] void* begin(Stream& stream);
  static void on_devices_changed(DeviceList* removed, DeviceList* added, void* number) noexcept;

 private:
  std::uintptr_t number_ = 0;
};

/// - Threads: one; the library's own put frames into the box.
class Stream {
 public:
  /// Finds device, sensor and stream and sets up the device; does not start it. Throws Error.
  Stream(std::shared_ptr<const Library> library, const StreamRequest& request);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const std::string& serial() const noexcept { return serial_; }
  /// What was set in the device, as it says itself, and what it did not take: "global time 1; not set: emitter 0 in
  /// place of 1". What decides what a reading means is refused where it is not taken.
  [[nodiscard]] const std::string& settings() const noexcept { return settings_; }
  [[nodiscard]] const PinholeCamera& intrinsics() const noexcept { return intrinsics_; }
  [[nodiscard]] double metres_per_unit() const noexcept { return metres_per_unit_; }
  [[nodiscard]] double period_s() const noexcept { return 1.0 / rate_hz_; }  ///< of the images
  /// The device has taken it, and says so.
  [[nodiscard]] bool has_global_time() const noexcept { return has_global_time_; }
  [[nodiscard]] double duration_s() const;  ///< of a recording

  /// Throws Error.
  void start();
  /// Null: none within that time.
  [[nodiscard]] Owned<Frame> take(double longest_s);
  /// The device was unplugged.
  [[nodiscard]] bool is_gone() const noexcept { return is_gone_.load(std::memory_order_relaxed); }
  /// The recording is at its end; frames may still be in the box.
  [[nodiscard]] bool has_ended() const;

 private:
  [[nodiscard]] const Functions& f() const noexcept { return library_->functions(); }
  [[nodiscard]] Owned<Device> device_of(const StreamRequest& request);
  [[nodiscard]] Owned<Sensor> depth_sensor() const;
  [[nodiscard]] const Profile* profile_of(const StreamRequest& request) const;
  [[nodiscard]] std::string device_info(int what) const;
  void set_up();
  friend class Watch;
  void look_whether_gone(DeviceList* removed) noexcept;

  std::shared_ptr<const Library> library_;
  bool is_recording_;
  std::atomic<bool> is_gone_{false};
  Owned<Context> context_;
  Owned<Device> device_;
  Owned<Sensor> sensor_;
  Owned<ProfileList> profiles_;
  const Profile* profile_ = nullptr;
  NumberedBox box_;
  Watch watch_;  ///< ends first
  bool is_open_ = false;
  bool is_started_ = false;
  bool has_global_time_ = false;
  int rate_hz_ = 1;
  std::string name_;
  std::string serial_;
  std::string settings_;
  PinholeCamera intrinsics_;
  double metres_per_unit_ = 0.001;
};

}  // namespace depthgrid::sensors::rs2
