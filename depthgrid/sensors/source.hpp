// Where images and joint states come from: one interface for drivers, recordings and simulated ones.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::sensors {

/// What became of a call of next().
enum class Reading : std::uint8_t {
  got,      ///< something new
  nothing,  ///< nothing within the time allowed; ask again
  ended,    ///< there will be nothing more: the end of a recording
  failed,   ///< the device is lost: reason() says why; close() and open() may bring it back
};

struct SourceInfo {
  std::string name;                           ///< for people: "Intel RealSense D435", "recording /data/a"
  std::string serial;                         ///< serial number, topic or camera id; empty: none
  std::string clock;                          ///< whose time stamps: "this computer", "the device, less 2.1 ms"
  std::optional<PinholeCamera> intrinsics{};  ///< of the images that next() gives; none: not a camera, or not known
  double metres_per_unit = 0.001;             ///< of 16-bit images
  std::string settings{};                     ///< what was set in the device, and what it did not take; empty: nothing
  std::optional<PinholeCamera> nominal{};     ///< usual ones of such a device, where it does not know its own
};

/// - Threads: one.
/// - Errors: open() throws Error with the reason. After that nothing throws.
class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// May take seconds. Again after close(), or after next() failed. Throws Error.
  virtual void open() = 0;
  virtual void close() noexcept = 0;
  /// Of the last open().
  [[nodiscard]] virtual const SourceInfo& info() const noexcept = 0;
  /// Why the last next() failed; one line, empty where none did.
  [[nodiscard]] virtual std::string_view reason() const noexcept = 0;
};

struct DepthReading {
  DepthView depth;                       ///< good until the next call
  double time_s = 0;                     ///< middle of the exposure, on clock_now_s()'s clock
  std::optional<Pose> T_world_camera{};  ///< of a camera that moves
  std::int64_t skipped = 0;  ///< images before it that were passed over: they came faster than they were taken
};

class DepthSource : public Source {
 public:
  /// The newest image that was not given yet. Waits `longest_s` at most.
  [[nodiscard]] virtual Reading next(DepthReading& reading, double longest_s) noexcept = 0;
};

struct JointReading {
  std::span<const double> q;  ///< rad or m, in the order of the robot's joints; good until the next call
  double time_s = 0;          ///< on clock_now_s()'s clock
};

class JointSource : public Source {
 public:
  /// The next state, none left out unless the source itself does. Waits `longest_s` at most.
  [[nodiscard]] virtual Reading next(JointReading& reading, double longest_s) noexcept = 0;
};

}  // namespace depthgrid::sensors
