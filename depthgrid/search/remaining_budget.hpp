// How much more a call may do. Internal.
#pragma once

#include <chrono>
#include <cstdint>

namespace depthgrid::search {

/// What is left of a call's budget.
class RemainingBudget {
 public:
  /// Cubes that may still be opened, of those given last.
  [[nodiscard]] std::int64_t nodes() const noexcept { return nodes_; }
  void give(std::int64_t nodes) noexcept { nodes_ = nodes; }
  /// Whether they are limited at all.
  [[nodiscard]] bool is_counted() const noexcept { return nodes_ <= kMost; }
  /// Nothing that is counted has more.
  static constexpr std::int64_t kMost = std::int64_t{1} << 48;
  void take(std::int64_t nodes) noexcept { nodes_ -= nodes; }
  void end_at(std::chrono::steady_clock::time_point deadline) noexcept;
  /// Looks at the clock at its first call and once in so many.
  [[nodiscard]] bool is_spent() noexcept;

 private:
  std::int64_t nodes_ = 0;
  std::chrono::steady_clock::time_point deadline_;
  bool timed_ = false;
  bool late_ = false;
  int until_clock_ = 0;
};

}  // namespace depthgrid::search
