#include "depthgrid/cell/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace depthgrid::cell {
namespace {

/// Edits that make one of the other, a swap of neighbours among them.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> older(b.size() + 1);
  std::vector<std::size_t> old(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    old[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({old[j] + 1, row[j - 1] + 1, old[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], older[j - 2] + 1);
      }
    }
    older.swap(old);
    old.swap(row);
  }
  return old[b.size()];
}

}  // namespace

std::string suggestion(std::string_view name, std::span<const std::string_view> known) {
  // The longest name that is looked at: what is longer is no slip of the finger.
  constexpr std::size_t kLongest = 64;
  std::string_view nearest;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string_view candidate : known) {
    const std::size_t count = name.size() <= kLongest ? edits(name, candidate) : least;
    // A name without its unit, or one with another unit, is meant as the one that has it.
    const bool lacks_unit = name.size() >= 3 && candidate.size() > name.size() && candidate.starts_with(name) &&
                            candidate[name.size()] == '_';
    if (lacks_unit || count < least) {
      least = lacks_unit ? 0 : count;
      nearest = candidate;
    }
  }
  if (!nearest.empty()) {
    return " (did you mean '" + std::string(nearest) + "'?)";
  }
  std::string all;
  for (const std::string_view candidate : known) {
    all += (all.empty() ? "" : ", ") + std::string(candidate);
  }
  return " (known: " + all + ")";
}

}  // namespace depthgrid::cell
