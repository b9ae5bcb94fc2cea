// The functions of OpenNI2 that are used, found when it is loaded. Private.
//
// Names, numbers and layouts are those of its C interface, 2.2.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace depthgrid::sensors {

namespace oni {

struct DeviceObject;
struct StreamObject;
using Device = DeviceObject*;
using Stream = StreamObject*;

inline constexpr int kVersion = 2 * 1000 + 2;
enum Status : int { kOk = 0, kTimeOut = 102 };
enum Sensor : int { kDepth = 3 };
enum PixelFormat : int { kDepth1mm = 100, kDepth100um = 101 };
enum DeviceProperty : int { kSerialNumber = 3, kImageRegistration = 5, kPlaybackSpeed = 100, kPlaybackRepeat = 101 };
enum StreamProperty : int {
  kHorizontalFov = 1,
  kVerticalFov = 2,
  kVideoMode = 3,
  kMirroring = 7,
  kNumberOfFrames = 8,
  kHoleFilter = 0x10801004,      ///< of PrimeSense's driver, and of those that were made from it
  kSoftwareFilter = 0x2080FF43,  ///< of Orbbec's
};

struct VideoMode {
  int format = 0;
  int width = 0;
  int height = 0;
  int rate_hz = 0;
};

struct SensorInfo {
  int sensor = 0;
  int count = 0;
  VideoMode* modes = nullptr;
};

inline constexpr std::size_t kLongestText = 256;
struct DeviceInfo {
  std::array<char, kLongestText> uri{};
  std::array<char, kLongestText> vendor{};
  std::array<char, kLongestText> name{};
  std::uint16_t usb_vendor = 0;
  std::uint16_t usb_product = 0;
};

struct Frame {
  int size = 0;
  void* data = nullptr;
  int sensor = 0;
  std::uint64_t timestamp_us = 0;
  int index = 0;
  int width = 0;
  int height = 0;
  VideoMode mode{};
  int is_cropped = 0;
  int crop_x = 0;
  int crop_y = 0;
  int stride = 0;
};

struct DeviceCallbacks {
  void (*connected)(const DeviceInfo*, void*) = nullptr;
  void (*disconnected)(const DeviceInfo*, void*) = nullptr;
  void (*state_changed)(const DeviceInfo*, int, void*) = nullptr;
};

struct Functions {
  int (*initialize)(int version) = nullptr;
  void (*shutdown)() = nullptr;
  const char* (*extended_error)() = nullptr;
  int (*log_to_console)(int) = nullptr;
  int (*log_to_file)(int) = nullptr;
  int (*get_device_list)(DeviceInfo**, int*) = nullptr;
  int (*release_device_list)(DeviceInfo*) = nullptr;
  int (*register_callbacks)(DeviceCallbacks*, void*, void** handle) = nullptr;
  void (*unregister_callbacks)(void* handle) = nullptr;
  int (*device_open)(const char* uri, Device*) = nullptr;
  int (*device_close)(Device) = nullptr;
  int (*device_info)(Device, DeviceInfo*) = nullptr;
  int (*device_set)(Device, int, const void*, int) = nullptr;
  int (*device_get)(Device, int, void*, int*) = nullptr;
  int (*device_has)(Device, int) = nullptr;
  int (*create_stream)(Device, int sensor, Stream*) = nullptr;
  void (*stream_destroy)(Stream) = nullptr;
  const SensorInfo* (*stream_sensor)(Stream) = nullptr;
  int (*stream_set)(Stream, int, const void*, int) = nullptr;
  int (*stream_get)(Stream, int, void*, int*) = nullptr;
  int (*stream_has)(Stream, int) = nullptr;
  int (*stream_start)(Stream) = nullptr;
  void (*stream_stop)(Stream) = nullptr;
  int (*wait_for_any)(Stream*, int, int*, int timeout_ms) = nullptr;
  int (*read_frame)(Stream, Frame**) = nullptr;
  void (*frame_release)(Frame*) = nullptr;
};

}  // namespace oni

/// - Threads: any.
class OpenniLibrary {
 public:
  /// Throws Error.
  explicit OpenniLibrary(const std::vector<std::string>& names);
  ~OpenniLibrary();
  OpenniLibrary(const OpenniLibrary&) = delete;
  OpenniLibrary& operator=(const OpenniLibrary&) = delete;

  /// One for all cameras; loaded with the first call, and there until the program ends. Throws Error.
  [[nodiscard]] static std::shared_ptr<const OpenniLibrary> shared();

  [[nodiscard]] const oni::Functions& functions() const noexcept { return functions_; }
  /// Begins OpenNI2, whose drivers look for devices from then on; once, because each time costs memory that it never
  /// gives back. It ends with this object. Throws Error.
  void begin() const;
  /// What its drivers have found since begin(). Throws Error.
  [[nodiscard]] std::vector<oni::DeviceInfo> devices() const;
  /// Throws Error with the library's words unless `status` is kOk.
  void check(int status, const char* what) const;

 private:
  oni::Functions functions_;
  mutable std::mutex mutex_;
  mutable bool has_begun_ = false;
};

}  // namespace depthgrid::sensors
