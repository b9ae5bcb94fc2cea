#include <sstream>

#include "recordings/figures.hpp"
#include "recordings/left_out_study.hpp"

namespace depthgrid::bench {

std::string left_out_tables(const std::vector<LeftOutRow>& rows) {
  std::ostringstream out;
  out << "| margins | left out | readings | violations | by more than 5 cm | excess: median | 95 % | largest | nothing "
         "within 0.5 m |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const LeftOutRow& row : rows) {
    const LeftOutFigures& f = row.figures;
    const auto all = static_cast<double>(f.readings);
    out << "| " << row.setting << " | " << row.left_out << " | " << f.readings << " | " << f.violations << " ("
        << percent(static_cast<double>(f.violations), all) << ") | " << f.far_violations << " ("
        << percent(static_cast<double>(f.far_violations), all) << ") | " << number(1e3 * quantile(f.excesses_m, 0.5), 0)
        << " mm | " << number(1e3 * quantile(f.excesses_m, 0.95), 0) << " mm | "
        << number(1e3 * quantile(f.excesses_m, 1.0), 0) << " mm | " << f.at_rho << " |\n";
  }
  out << "\n| margins | left out | violations |";
  for (std::size_t i = 0; i < kLeftOutCauses; ++i) {
    out << ' ' << to_string(static_cast<LeftOutCause>(i)) << " |";
  }
  out << " readings at an edge, of all |\n|---|---|---|";
  for (std::size_t i = 0; i <= kLeftOutCauses; ++i) {
    out << "---|";
  }
  out << '\n';
  for (const LeftOutRow& row : rows) {
    const LeftOutFigures& f = row.figures;
    out << "| " << row.setting << " | " << row.left_out << " | " << f.violations << " |";
    for (const std::size_t count : f.causes) {
      out << ' ' << share(static_cast<double>(count), static_cast<double>(f.violations)) << " |";
    }
    out << ' ' << share(static_cast<double>(f.edge_readings), static_cast<double>(f.readings)) << " |\n";
  }
  return out.str();
}

}  // namespace depthgrid::bench
