// Times of a camera's own clock, and of an image's arrival, on the clock of a running cell.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace depthgrid::sensors {

/// An image arrives so long after the middle of its exposure at most, by docs/sensor-models.md.
inline constexpr double kLongestArrival_s = 0.1;

/// What is declared of cameras that do not say when they exposed.
struct ArrivalTimes {
  std::optional<double> lag_s{};  ///< from the middle of the exposure to the arrival, at most; it is taken off
  double time_uncertainty_s = 0;  ///< by how much a stamp may be wrong: the camera's margin
};

/// What is taken off a time of arrival: the lag that is declared. Throws Error unless it and the uncertainty cover the
/// longest one together: an image whose lag was longer would look newer than it is. `stamps`: "stamps images when they
/// arrive".
[[nodiscard]] double lag_or_refuse(const ArrivalTimes& times, std::string_view stamps);

/// A device's clock beside ours. No image comes before it was exposed, so the least difference between arrival and
/// stamp among those of the last ten seconds says how the clocks stand to each other, but for the least lag. The
/// window lets it follow clocks that drift apart: 50 millionths are half a millisecond within it.
/// - Units: seconds. Threads: one.
class DeviceClock {
 public:
  explicit DeviceClock(double lag_s) noexcept : lag_s_(lag_s) {}

  /// Of an image that arrived now; begins anew where the device's clock goes back.
  [[nodiscard]] double clock_s(double device_s, double arrival_s) noexcept;

  /// Enough images have come to know the least difference: one that was delayed alone would look too new.
  [[nodiscard]] bool is_settled() const noexcept { return images_ >= kImages; }

  static constexpr std::int64_t kImages = 10;
  static constexpr double kHalfWindow_s = 5;

 private:
  double lag_s_;
  std::int64_t images_ = 0;
  double last_device_s_ = -std::numeric_limits<double>::infinity();
  double half_began_s_ = 0;
  double least_before_s_ = std::numeric_limits<double>::infinity();  ///< in the half window before this one
  double least_s_ = std::numeric_limits<double>::infinity();
};

/// A counter that wraps at 2^32 as one that does not.
class Unwrapped32 {
 public:
  [[nodiscard]] std::int64_t next(std::uint32_t value) noexcept;

 private:
  bool has_value_ = false;
  std::uint32_t last_ = 0;
  std::int64_t whole_ = 0;
};

}  // namespace depthgrid::sensors
