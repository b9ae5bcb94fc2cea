#include <sstream>

#include "lab/recordings/left_out_study.hpp"
#include "report/number_text.hpp"
#include "report/statistics.hpp"

namespace depthgrid::lab {

namespace {

std::string excess(const LeftOutFigures& f, double q) {
  return f.excesses_m.empty() ? "-" : report::fixed(1e3 * report::quantile(f.excesses_m, q)) + " mm";
}

std::string known_free_by(const LeftOutFigures& f) {
  std::string text;
  for (const auto& [id, count] : f.known_free_by) {
    text += (text.empty() ? "" : ", ") + id + ' ' + std::to_string(count);
  }
  return text.empty() ? "-" : text;
}

}  // namespace

std::string left_out_tables(const std::vector<LeftOutRow>& rows) {
  std::ostringstream out;
  out << "| margins | left out | readings | free 0.3 m before | violations | by more than 5 cm | excess: median | "
         "95 % | largest |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const LeftOutRow& row : rows) {
    const LeftOutFigures& f = row.figures;
    const auto all = static_cast<double>(f.readings);
    out << "| " << row.setting << " | " << row.left_out << " | " << f.readings << " | "
        << report::percent_of(static_cast<double>(f.free_before), all) << " | " << f.violations << " ("
        << report::percent_of(static_cast<double>(f.violations), all, 2) << ") | " << f.far_violations << " ("
        << report::percent_of(static_cast<double>(f.far_violations), all, 2) << ") | " << excess(f, 0.5) << " | "
        << excess(f, 0.95) << " | " << excess(f, 1.0) << " |\n";
  }
  out << "\n| margins | left out | violations |";
  for (std::size_t i = 0; i < kLeftOutCauses; ++i) {
    out << ' ' << to_string(static_cast<LeftOutCause>(i)) << " |";
  }
  out << " of all readings, at an edge | on the floor | known free by |\n|---|---|---|---|---|";
  for (std::size_t i = 0; i <= kLeftOutCauses; ++i) {
    out << "---|";
  }
  out << '\n';
  for (const LeftOutRow& row : rows) {
    const LeftOutFigures& f = row.figures;
    out << "| " << row.setting << " | " << row.left_out << " | " << f.violations << " |";
    for (const std::size_t count : f.causes) {
      out << ' ' << report::percent_of(static_cast<double>(count), static_cast<double>(f.violations)) << " |";
    }
    out << ' ' << report::percent_of(static_cast<double>(f.edge_readings), static_cast<double>(f.readings)) << " | "
        << report::percent_of(static_cast<double>(f.on_floor), static_cast<double>(f.violations)) << " | "
        << known_free_by(f) << " |\n";
  }
  return out.str();
}

}  // namespace depthgrid::lab
