#include "lab/campaign/soundness_page.hpp"

#include <sstream>

#include "report/marked_page.hpp"
#include "report/number_text.hpp"

namespace depthgrid::lab {
namespace {

/// Every three digits, small numbers too.
std::string grouped(std::int64_t value) { return report::grouped(value, 3); }

std::string images_of(const Tally& tally) {
  const auto size = [](int width_px) { return std::to_string(width_px) + "x" + std::to_string(width_px * 3 / 4); };
  return tally.width_px == 0 ? "up to " + size(96) : size(tally.width_px);
}

void write_rows(const Tally& tally, std::ostream& out) {
  out << "| " << images_of(tally)
      << " | problems | queries | over-estimates | not proven | not tight | implausible "
         "|\n|---|---|---|---|---|---|---|\n";
  for (const auto& [name, row] : tally.rows) {
    out << "| " << name << " | " << (row.problems > 0 ? grouped(row.problems) : "") << " | " << grouped(row.queries);
    for (const std::int64_t count : row.faults) {
      out << " | " << grouped(count);
    }
    out << " |\n";
  }
  out << '\n';
}

void write_shortfalls(const Tally& tally, std::ostream& out) {
  out << "| " << images_of(tally)
      << " | answers | median | 99 % | largest | largest / resolution |\n|---|---|---|---|---|---|\n";
  for (const auto& [name, histogram] : tally.shortfall_m) {
    const auto all = tally.shortfall_resolutions.find(name);
    out << "| " << name << " | " << grouped(histogram.count()) << " | "
        << report::fixed(1e3 * histogram.quantile(0.5), 2) << " mm | "
        << report::fixed(1e3 * histogram.quantile(0.99), 1) << " mm | " << report::fixed(1e3 * histogram.maximum(), 1)
        << " mm | " << (all != tally.shortfall_resolutions.end() ? report::fixed(all->second.maximum(), 2) : "-")
        << " |\n";
  }
  out << '\n';
}

void write_counts(const Tally& tally, std::ostream& out) {
  const auto count = [&tally](const char* name) {
    const auto found = tally.counts.find(name);
    return grouped(found != tally.counts.end() ? found->second : 0);
  };
  out << "- Calls with a budget of 1 to 30 000 nodes, " << images_of(tally) << ": " << count("budget: queries")
      << " answers, " << count("budget: stopped") << " of them stopped early; over-estimates "
      << count("budget: over_estimate") << ", not proven " << count("budget: undecided") << ", not tight "
      << count("budget: not_tight") << ", implausible " << count("budget: implausible") << ".\n"
      << "- Directions: " << count("direction: queries") << " answers, " << count("direction: given")
      << " with a direction; wrong " << count("direction: wrong") << ".\n";
  out << "- Seeds";
  for (const auto& [first, end] : tally.seeds.ranges()) {
    out << ' ' << first << " to " << end - 1 << ',';
  }
  out << ' ' << report::fixed(tally.seconds / 60) << " minutes of one core. Source:";
  for (const auto& [code, queries] : tally.queries_by_code) {
    out << ' ' << (code.empty() ? "unknown" : code) << " (" << grouped(queries) << " queries)";
  }
  out << ".\n\n";
}

}  // namespace

std::string soundness_tables(const CampaignState& state) {
  std::ostringstream out;
  for (const auto& [width_px, tally] : state.tallies) {
    write_rows(tally, out);
    out << "Shortfall hi - answer of answers above 0, at a resolution of 5 mm; the last column at every "
           "resolution:\n\n";
    write_shortfalls(tally, out);
    write_counts(tally, out);
    if (!tally.lines.empty()) {
      out << "Faults, the first of each kind:\n\n";
      for (const std::string& line : tally.lines) {
        out << "    " << line << '\n';
      }
      out << '\n';
    }
  }
  return out.str();
}

void write_tables(const std::string& page, const std::string& tables) {
  report::write_between(page, kTablesBegin, kTablesEnd, "\n" + tables);
}

}  // namespace depthgrid::lab
