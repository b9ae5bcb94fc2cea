// The functions of libfreenect that are used, found when it is loaded. Private.
//
// Names, numbers and layouts are those of its C interface, 0.5.
#pragma once

#include <sys/time.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/sensors/kinect_disparity.hpp"

namespace depthgrid::sensors {

namespace freenect {

struct Context;
struct Device;

enum SubDevice : int { kCamera = 0x02 };
enum LogLevel : int { kInfo = 4 };  ///< of lost packets, and all that is worse
enum Resolution : int { kMedium = 1 };
enum DepthFormat : int { k11Bit = 0 };
enum Flag : int { kMirrorDepth = 1 << 16 };

struct FrameMode {
  std::uint32_t reserved = 0;
  std::int32_t resolution = 0;
  std::int32_t format = 0;
  std::int32_t bytes = 0;
  std::int16_t width = 0;
  std::int16_t height = 0;
  std::int8_t data_bits = 0;
  std::int8_t padding_bits = 0;
  std::int8_t rate_hz = 0;
  std::int8_t is_valid = 0;
};

struct Attributes {
  Attributes* next = nullptr;
  const char* camera_serial = nullptr;
};

/// Of freenect_copy_registration: 29 numbers of the colour camera's map, three of its borders, then the zero plane.
struct Registration {
  std::int32_t colour_map[29] = {};  // NOLINT(*avoid-c-arrays): as the library lays it out
  std::uint16_t borders[3] = {};     // NOLINT(*avoid-c-arrays)
  float emitter_distance_cm = 0;
  float colour_distance_cm = 0;
  float reference_distance_mm = 0;
  float reference_pixel_size_mm = 0;
  double const_shift = 0;
  void* tables[3] = {};  // NOLINT(*avoid-c-arrays)
};

using OnDepth = void (*)(Device*, void* pixels, std::uint32_t ticks);
using OnLog = void (*)(Context*, int level, const char* words);

struct Functions {
  int (*init)(Context**, void* usb) = nullptr;
  int (*shutdown)(Context*) = nullptr;
  void (*set_log_level)(Context*, int) = nullptr;
  void (*set_log_callback)(Context*, OnLog) = nullptr;
  void (*select_subdevices)(Context*, int) = nullptr;
  int (*num_devices)(Context*) = nullptr;
  int (*list_device_attributes)(Context*, Attributes**) = nullptr;  ///< may be null: fakenect has it not
  void (*free_device_attributes)(Attributes*) = nullptr;            ///< with it
  int (*open_device)(Context*, Device**, int) = nullptr;
  int (*open_device_by_camera_serial)(Context*, Device**, const char*) = nullptr;
  int (*close_device)(Device*) = nullptr;
  FrameMode (*find_depth_mode)(int resolution, int format) = nullptr;
  int (*set_depth_mode)(Device*, FrameMode) = nullptr;
  int (*set_flag)(Device*, int flag, int value) = nullptr;  ///< may be null
  int (*set_depth_buffer)(Device*, void*) = nullptr;
  void (*set_depth_callback)(Device*, OnDepth) = nullptr;
  int (*start_depth)(Device*) = nullptr;
  int (*stop_depth)(Device*) = nullptr;
  int (*process_events_timeout)(Context*, timeval*) = nullptr;
  Registration (*copy_registration)(Device*) = nullptr;  ///< may be null
  int (*destroy_registration)(Registration*) = nullptr;  ///< with it
};

}  // namespace freenect

/// - Threads: any.
class FreenectLibrary {
 public:
  /// Throws Error.
  explicit FreenectLibrary(const std::vector<std::string>& names);
  /// Functions of a library that is loaded: for tests that put some of their own among them.
  explicit FreenectLibrary(const freenect::Functions& functions) : functions_(functions) {}

  /// One for all cameras; loaded with the first call. Throws Error.
  [[nodiscard]] static std::shared_ptr<const FreenectLibrary> shared();

  [[nodiscard]] const freenect::Functions& functions() const noexcept { return functions_; }

 private:
  freenect::Functions functions_;
};

}  // namespace depthgrid::sensors
