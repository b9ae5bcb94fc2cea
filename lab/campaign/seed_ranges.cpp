#include "lab/campaign/seed_ranges.hpp"

#include <algorithm>
#include <iterator>

#include "depthgrid/core/error.hpp"

namespace depthgrid::lab {

void SeedRanges::add(std::uint64_t first, std::uint64_t end) {
  if (first >= end) {
    return;
  }
  if (count(first, end) != 0) {
    fail("seeds ", first, " to ", end - 1, ": some of them are counted already, and none may count twice");
  }
  auto range = ranges_.emplace(first, end).first;
  if (const auto next = std::next(range); next != ranges_.end() && next->first == end) {
    range->second = next->second;
    ranges_.erase(next);
  }
  if (range != ranges_.begin()) {
    if (const auto before = std::prev(range); before->second == first) {
      before->second = range->second;
      ranges_.erase(range);
    }
  }
}

void SeedRanges::add(const SeedRanges& other) {
  for (const auto& [first, end] : other.ranges_) {
    add(first, end);
  }
}

std::uint64_t SeedRanges::next_missing(std::uint64_t first) const {
  const auto after = ranges_.upper_bound(first);
  return after == ranges_.begin() ? first : std::max(first, std::prev(after)->second);
}

std::uint64_t SeedRanges::count(std::uint64_t first, std::uint64_t end) const {
  std::uint64_t count = 0;
  for (const auto& [low, high] : ranges_) {
    count += std::max(first, low) < std::min(end, high) ? std::min(end, high) - std::max(first, low) : 0;
  }
  return count;
}

}  // namespace depthgrid::lab
