#include "lab/speed/page.hpp"

#include <fstream>
#include <sstream>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "lab/speed/page_parts.hpp"
#include "lab/speed/page_text.hpp"

namespace depthgrid::lab {

void write_page(const std::string& file, const std::string& images, const Report& report) {
  std::ostringstream page;
  page << kIntroduction;
  for (const char* key : {"machine", "run"}) {
    const auto found = report.about.find(key);
    if (found != report.about.end()) {
      page << found->second << "\n\n";
    }
  }
  const std::vector<Goal> all = goals(report);
  write_goals(page, all);
  write_misses(page, all, report);
  write_ours(page, report);
  write_side_by_side(page, report);
  page << "## Plots\n\n";
  for (const auto& [name, text] : {std::pair{"cameras", "Time against the number of cameras"},
                                   {"accuracy", "Accuracy against time"},
                                   {"points", "Time against the number of points"},
                                   {"rho", "Time against rho"},
                                   {"resolution", "Time against the resolution"},
                                   {"image", "Time against the size of the images"}}) {
    page << "![" << text << "](" << images << "/benchmark-" << name << ".png)\n\n";
  }
  page << kMethod << '\n' << kSetups;
  std::ofstream out(file);
  out << page.str();
  out.close();
  if (!out) {
    fail(file, ": cannot be written");
  }
}

}  // namespace depthgrid::lab
