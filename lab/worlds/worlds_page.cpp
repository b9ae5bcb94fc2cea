#include "lab/worlds/worlds_page.hpp"

#include <sstream>

#include "report/marked_page.hpp"
#include "report/number_text.hpp"

namespace depthgrid::lab {
namespace {

using world::Counts;

std::string grouped(std::int64_t value) { return report::grouped(value, 3); }

std::string share(std::int64_t part, std::int64_t whole, int digits) {
  return whole > 0 ? report::fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), digits) + " %" : "-";
}

std::string largest(const Counts& counts) {
  return counts.above + counts.above_now > 0 ? report::fixed(1e3 * counts.largest_excess_m, 1) + " mm" : "-";
}

void write_kept(const WorldsOfAKind& kind, std::ostream& out) {
  out << "| " << world::name_of(kind.options)
      << " | worlds | answers | above the truth | largest excess | above something in the blind layer only | nothing "
         "within rho: said where true | half of the others reach |\n|---|---|---|---|---|---|---|---|\n";
  for (const auto& [name, counts] : kind.tally.rows) {
    out << "| " << name << " | " << grouped(counts.worlds) << " | " << grouped(counts.answers) << " | "
        << grouped(counts.above + counts.above_now) << " | " << largest(counts) << " | " << grouped(counts.in_layer)
        << " | " << share(counts.far_said, counts.far_true, 0) << " | " << report::fixed(100 * counts.median_ratio(), 0)
        << " % |\n";
  }
  out << "\nSeeds";
  for (const auto& [first, end] : kind.seeds.ranges()) {
    out << ' ' << first << " to " << end - 1 << ',';
  }
  out << ' ' << report::fixed(kind.seconds / 60) << " minutes. Source:";
  for (const auto& [code, answers] : kind.answers_by_code) {
    out << ' ' << (code.empty() ? "unknown" : code) << " (" << grouped(answers) << " answers)";
  }
  out << ".\n\n";
  for (const std::string& line : kind.tally.lines) {
    out << "    " << line << '\n';
  }
  out << (kind.tally.lines.empty() ? "" : "\n");
}

void write_broken(const WorldsOfAKind& kind, std::ostream& out) {
  const Counts& all = kind.tally.rows.at("all");
  out << "| " << world::name_of(kind.options) << " | " << grouped(all.worlds) << " | " << grouped(all.answers) << " | "
      << share(all.above, all.answers, 3) << " | " << largest(all) << " | " << share(all.worlds_above, all.worlds, 1)
      << " | " << share(all.worlds_noticed, all.worlds, 1) << " |\n";
}

bool keeps(const WorldsOfAKind& kind) { return kind.options.broken == world::Broken::none; }

}  // namespace

std::string worlds_tables(const WorldsState& state) {
  std::ostringstream out;
  bool some_broken = false;
  for (const auto& [name, kind] : state.kinds) {
    if (keeps(kind) && !kind.tally.rows.empty()) {
      write_kept(kind, out);
    }
    some_broken = some_broken || !keeps(kind);
  }
  if (some_broken) {
    out << "One assumption broken on purpose:\n\n| | worlds | answers | above the truth | largest excess | worlds with "
           "such answers | worlds in which it was noticed |\n|---|---|---|---|---|---|---|\n";
    for (const auto& [name, kind] : state.kinds) {
      if (!keeps(kind) && !kind.tally.rows.empty()) {
        write_broken(kind, out);
      }
    }
    out << '\n';
  }
  return out.str();
}

void write_worlds_tables(const std::string& page, const std::string& tables) {
  report::write_between(page, kWorldsBegin, kWorldsEnd, "\n" + tables);
}

}  // namespace depthgrid::lab
