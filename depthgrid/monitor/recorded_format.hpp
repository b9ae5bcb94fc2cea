// What a cell's recording is called inside, for who writes and who reads one. Internal.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/messages/geometry.hpp"
#include "depthgrid/messages/standard.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {

inline constexpr std::string_view kRecordedMetadata = "depthgrid";
/// Written at the end only.
inline constexpr std::string_view kRecordedEnd = "depthgrid end";
inline constexpr std::string_view kRecordedJoints = "/joint_states";
inline constexpr std::string_view kRecordedDescription = "/robot_description";
inline constexpr std::string_view kRecordedDistances = "/distances";
inline constexpr std::string_view kRecordedEvents = "/events";
inline constexpr std::string_view kRecordedFrames = "/tf";

[[nodiscard]] inline std::string recorded_images(const std::string& camera) {
  return "/" + camera + "/depth/image_raw";
}

/// Times of the cell's clock as stamps and back, to the nanosecond. NaN is the stamp 0.
struct RecordedClock {
  std::int64_t ahead_ns = 0;  ///< by which stamps are ahead of the cell's clock

  [[nodiscard]] messages::Time stamp(double time_s) const noexcept {
    return std::isfinite(time_s) ? messages::time_of_nanoseconds(sensors::nanoseconds_of(time_s) + ahead_ns)
                                 : messages::Time{};
  }
  [[nodiscard]] double time_s(std::int64_t stamp_ns) const noexcept { return sensors::seconds_of(stamp_ns - ahead_ns); }
};

[[nodiscard]] messages::Transform recorded_pose(const Pose& pose) noexcept;
[[nodiscard]] Pose recorded_pose(const messages::Transform& pose) noexcept;

}  // namespace depthgrid::monitor
