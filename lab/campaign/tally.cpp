#include "lab/campaign/tally.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"

namespace depthgrid::lab {
namespace {

Row& operator+=(Row& row, const Row& other) {
  row.problems += other.problems;
  row.queries += other.queries;
  std::transform(row.faults.begin(), row.faults.end(), other.faults.begin(), row.faults.begin(), std::plus<>());
  return row;
}

}  // namespace

void Tally::note(const std::string& kind, const std::string& line) {
  const std::string begin = kind + ", ";
  const auto same = std::count_if(lines.begin(), lines.end(),
                                  [&begin](const std::string& known) { return known.rfind(begin, 0) == 0; });
  if (same < static_cast<std::ptrdiff_t>(kMaxLines)) {
    lines.push_back(begin + line);
  }
}

void Tally::add(const Tally& other) {
  if (width_px != other.width_px) {
    fail("images of width ", other.width_px, " cannot be added to those of width ", width_px, ": keep them apart");
  }
  seeds.add(other.seeds);
  for (const auto& [name, row] : other.rows) {
    rows[name] += row;
  }
  for (const auto& [name, count] : other.counts) {
    counts[name] += count;
  }
  for (const auto& [name, histogram] : other.shortfall_m) {
    shortfall_m[name].add(histogram);
  }
  for (const auto& [name, histogram] : other.shortfall_resolutions) {
    shortfall_resolutions[name].add(histogram);
  }
  for (const auto& [code, queries] : other.queries_by_code) {
    queries_by_code[code] += queries;
  }
  for (const std::string& line : other.lines) {
    const std::size_t end = line.find(", ");
    note(line.substr(0, end), line.substr(end + 2));
  }
  seconds += other.seconds;
}

std::int64_t Tally::faults(reference::Fault fault) const {
  const auto all = rows.find("all");
  return all != rows.end() ? all->second.faults.at(static_cast<std::size_t>(fault)) : 0;
}

bool Tally::is_unsound() const {
  const auto some = [this](const char* what) {
    const auto found = counts.find(what);
    return found != counts.end() && found->second > 0;
  };
  return faults(reference::Fault::over_estimate) > 0 || some("budget: over_estimate") || some("history: different");
}

}  // namespace depthgrid::lab
