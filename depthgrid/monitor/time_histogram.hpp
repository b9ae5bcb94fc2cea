// How often which duration occurred: written by one thread, read by any.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

namespace depthgrid::monitor {

/// From 1 us to about 100 s in steps of 5 %; what is less or more counts at the ends. Locks and allocates nothing.
class TimeHistogram {
 public:
  void add(double seconds) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }
  [[nodiscard]] double largest_s() const noexcept { return largest_s_.load(std::memory_order_relaxed); }
  /// The upper border of the step that the quantile lies in, at most the largest; nothing without values.
  [[nodiscard]] std::optional<double> quantile_s(double share) const noexcept;

 private:
  static constexpr std::size_t kSteps = 380;
  std::array<std::atomic<std::uint64_t>, kSteps> counts_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<double> largest_s_{0};
};

}  // namespace depthgrid::monitor
