// The functions of librealsense2 that are used, found when it is loaded. Private.
//
// Names, numbers and order of arguments are those of its C interface, 2.13 to 2.58; numbers that a version does not
// know are answered by it with "not supported".
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/sensors/shared_library.hpp"

namespace depthgrid::sensors::rs2 {

// What is behind these is known to the library alone.
struct ErrorObject;
struct Context;
struct DeviceList;
struct Device;
struct SensorList;
struct Sensor;
struct ProfileList;
struct Profile;
struct Frame;

enum CameraInfo : int { kName = 0, kSerialNumber = 1, kFirmware = 2, kUsbType = 9 };
enum StreamKind : int { kDepth = 1 };
enum Format : int { kZ16 = 1 };
enum Extension : int { kDepthSensor = 7 };
enum LogSeverity : int { kLogNone = 5 };
enum ClockDomain : int { kHardwareClock = 0, kSystemTime = 1, kGlobalTime = 2 };
enum Metadata : int { kFrameTimestamp = 1, kSensorTimestamp = 2, kActualExposure = 3 };
enum PlaybackStatus : int { kStopped = 3 };
enum Option : int {
  kVisualPreset = 12,
  kLaserPower = 13,
  kEmitterEnabled = 18,
  kEmitterOnOff = 46,
  kGlobalTimeEnabled = 53,
  kHdrEnabled = 76,
};
inline constexpr float kHighAccuracy = 3;  ///< of kVisualPreset, D400
enum Distortion : int { kUndistorted = 0, kModelCount = 6 };

struct Intrinsics {
  int width = 0;
  int height = 0;
  float ppx = 0;
  float ppy = 0;
  float fx = 0;
  float fy = 0;
  int model = 0;
  float coeffs[5] = {};  // NOLINT(*avoid-c-arrays): as the library lays it out
};

using OnFrame = void (*)(Frame*, void*);
using OnDevicesChanged = void (*)(DeviceList* removed, DeviceList* added, void*);

struct Functions {
  int (*get_api_version)(ErrorObject**) = nullptr;
  const char* (*get_error_message)(const ErrorObject*) = nullptr;
  void (*free_error)(ErrorObject*) = nullptr;
  void (*log_to_console)(int severity, ErrorObject**) = nullptr;

  Context* (*create_context)(int version, ErrorObject**) = nullptr;
  void (*delete_context)(Context*) = nullptr;
  DeviceList* (*query_devices)(const Context*, ErrorObject**) = nullptr;
  Device* (*context_add_device)(Context*, const char* file, ErrorObject**) = nullptr;
  void (*set_devices_changed_callback)(const Context*, OnDevicesChanged, void*, ErrorObject**) = nullptr;
  int (*get_device_count)(const DeviceList*, ErrorObject**) = nullptr;
  int (*device_list_contains)(const DeviceList*, const Device*, ErrorObject**) = nullptr;
  Device* (*create_device)(const DeviceList*, int, ErrorObject**) = nullptr;
  void (*delete_device_list)(DeviceList*) = nullptr;
  void (*delete_device)(Device*) = nullptr;
  int (*supports_device_info)(const Device*, int, ErrorObject**) = nullptr;
  const char* (*get_device_info)(const Device*, int, ErrorObject**) = nullptr;

  SensorList* (*query_sensors)(const Device*, ErrorObject**) = nullptr;
  int (*get_sensors_count)(const SensorList*, ErrorObject**) = nullptr;
  Sensor* (*create_sensor)(const SensorList*, int, ErrorObject**) = nullptr;
  void (*delete_sensor_list)(SensorList*) = nullptr;
  void (*delete_sensor)(Sensor*) = nullptr;
  int (*is_sensor_extendable_to)(const Sensor*, int, ErrorObject**) = nullptr;
  float (*get_depth_scale)(Sensor*, ErrorObject**) = nullptr;
  // A sensor is its options.
  int (*supports_option)(const Sensor*, int, ErrorObject**) = nullptr;
  float (*get_option)(const Sensor*, int, ErrorObject**) = nullptr;
  void (*set_option)(const Sensor*, int, float, ErrorObject**) = nullptr;

  ProfileList* (*get_stream_profiles)(Sensor*, ErrorObject**) = nullptr;
  int (*get_stream_profiles_count)(const ProfileList*, ErrorObject**) = nullptr;
  const Profile* (*get_stream_profile)(const ProfileList*, int, ErrorObject**) = nullptr;
  void (*delete_stream_profiles_list)(ProfileList*) = nullptr;
  void (*get_stream_profile_data)(const Profile*, int* stream, int* format, int* index, int* id, int* rate_hz,
                                  ErrorObject**) = nullptr;
  void (*get_video_stream_resolution)(const Profile*, int* width, int* height, ErrorObject**) = nullptr;
  void (*get_video_stream_intrinsics)(const Profile*, Intrinsics*, ErrorObject**) = nullptr;

  void (*open)(Sensor*, const Profile*, ErrorObject**) = nullptr;
  void (*close)(const Sensor*, ErrorObject**) = nullptr;
  void (*start)(const Sensor*, OnFrame, void*, ErrorObject**) = nullptr;
  void (*stop)(const Sensor*, ErrorObject**) = nullptr;

  void (*release_frame)(Frame*) = nullptr;
  int (*get_frame_width)(const Frame*, ErrorObject**) = nullptr;
  int (*get_frame_height)(const Frame*, ErrorObject**) = nullptr;
  int (*get_frame_stride)(const Frame*, ErrorObject**) = nullptr;
  int (*get_frame_bits_per_pixel)(const Frame*, ErrorObject**) = nullptr;
  const void* (*get_frame_data)(const Frame*, ErrorObject**) = nullptr;
  unsigned long long (*get_frame_number)(const Frame*, ErrorObject**) = nullptr;  // NOLINT(*runtime-int): as theirs
  double (*get_frame_timestamp)(const Frame*, ErrorObject**) = nullptr;
  int (*get_frame_timestamp_domain)(const Frame*, ErrorObject**) = nullptr;
  int (*supports_frame_metadata)(const Frame*, int, ErrorObject**) = nullptr;
  long long (*get_frame_metadata)(const Frame*, int, ErrorObject**) = nullptr;  // NOLINT(*runtime-int)

  unsigned long long (*playback_get_duration)(const Device*, ErrorObject**) = nullptr;  // NOLINT(*runtime-int)
  void (*playback_set_real_time)(const Device*, int, ErrorObject**) = nullptr;
  int (*playback_get_current_status)(const Device*, ErrorObject**) = nullptr;
};

/// A pointer that its function of the library gives back.
template <class Object>
using Owned = std::unique_ptr<Object, void (*)(Object*)>;

/// - Threads: any.
class Library {
 public:
  /// Loads it and silences its log. Throws Error.
  explicit Library(const std::vector<std::string>& names);
  /// Functions of a library that is loaded: for tests that put some of their own among them.
  explicit Library(const Functions& functions, std::string name) : functions_(functions), name_(std::move(name)) {}

  /// One for all cameras; loaded with the first call. Throws Error.
  [[nodiscard]] static std::shared_ptr<const Library> shared();
  [[nodiscard]] static std::vector<std::string> usual_names();

  [[nodiscard]] const Functions& functions() const noexcept { return functions_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  /// Calls a function whose last argument is the error. Throws Error with the library's words.
  template <class Result, class... Arguments, class... Given>
  Result call(Result (*function)(Arguments...), Given... given) const {
    ErrorObject* error = nullptr;
    if constexpr (std::is_void_v<Result>) {
      function(given..., &error);
      throw_if(error);
    } else {
      const Result result = function(given..., &error);
      throw_if(error);
      return result;
    }
  }

 private:
  void throw_if(ErrorObject* error) const {
    if (error != nullptr) {
      throw_error(error);
    }
  }
  [[noreturn]] void throw_error(ErrorObject* error) const;

  Functions functions_;
  std::string name_;
};

}  // namespace depthgrid::sensors::rs2
