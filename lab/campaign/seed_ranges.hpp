// Which seeds a campaign has been through.
#pragma once

#include <cstdint>
#include <map>

namespace depthgrid::lab {

/// A set of seeds, kept as ranges. Ranges that touch become one.
class SeedRanges {
 public:
  /// Throws Error when one of the seeds [first, end) is there already: nothing may count twice.
  void add(std::uint64_t first, std::uint64_t end);
  void add(const SeedRanges& other);
  /// The least seed from `first` on that is not in the set.
  [[nodiscard]] std::uint64_t next_missing(std::uint64_t first) const;
  /// How many seeds of [first, end) are in the set.
  [[nodiscard]] std::uint64_t count(std::uint64_t first, std::uint64_t end) const;
  /// First seed to the one after the last.
  [[nodiscard]] const std::map<std::uint64_t, std::uint64_t>& ranges() const { return ranges_; }

 private:
  std::map<std::uint64_t, std::uint64_t> ranges_;
};

}  // namespace depthgrid::lab
