#include "depthgrid/search/remaining_budget.hpp"

namespace depthgrid::search {
namespace {

/// The clock is read once in so many cubes.
constexpr int kClockInterval = 16;

}  // namespace

void RemainingBudget::end_at(std::chrono::steady_clock::time_point deadline) noexcept {
  deadline_ = deadline;
  timed_ = true;
}

bool RemainingBudget::is_spent() noexcept {
  if (timed_ && !late_ && --until_clock_ <= 0) {
    until_clock_ = kClockInterval;
    late_ = std::chrono::steady_clock::now() >= deadline_;
  }
  return late_ || nodes_ <= 0;
}

}  // namespace depthgrid::search
