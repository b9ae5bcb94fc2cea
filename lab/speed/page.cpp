#include "lab/speed/page.hpp"

#include <filesystem>
#include <sstream>
#include <utility>

#include "depthgrid/files/text_file.hpp"
#include "lab/speed/number_text.hpp"
#include "lab/speed/page_parts.hpp"
#include "lab/speed/page_text.hpp"
#include "report/markdown_table.hpp"
#include "report/marked_page.hpp"

namespace depthgrid::lab {
namespace {

void write_about(std::ostream& page, const Report& report) {
  for (const char* key : {"machine", "run"}) {
    const auto found = report.about.find(key);
    if (found != report.about.end()) {
      page << found->second << "\n\n";
    }
  }
}

/// The search on the three workloads, two cameras.
void write_cycle(std::ostream& page, const Report& report) {
  std::vector<std::string> head{"two cameras"};
  std::vector<std::string> rate{"nine points, a second"};
  std::vector<std::string> cycle{"cycle: two new images and nine points, ms (median)"};
  std::vector<std::string> eight{"the same with eight cameras"};
  std::vector<std::string> over{"largest over-estimate, mm"};
  for (const auto& [key, title] : kWorkloadNames) {
    const auto number = [&, group = std::string("ours, ") + key](const char* row, double cameras, const char* name) {
      return report.number(name, group, row, {{"cameras", cameras}});
    };
    head.emplace_back(title);
    rate.push_back(report::three_digits(number("nine points", 2, "calls_per_s")));
    cycle.push_back(milliseconds(number("cycle", 2, "call_median_s")));
    eight.push_back(milliseconds(number("cycle", 8, "call_median_s")));
    over.push_back(report::three_digits(1e3 * number("errors", 2, "over_max_m")));
  }
  report::MarkdownTable table(head);
  for (const auto& row : {rate, cycle, eight, over}) {
    table.row(row);
  }
  page << table.text() << "\n\n";
}

/// What would be used instead, two cameras, robot masked.
void write_peers(std::ostream& page, const Report& report) {
  report::MarkdownTable table({"two cameras, robot masked", "cycle, ms", "in times of ours", "nine points alone, ms",
                               "occluded space counts", "largest over-estimate, mm"});
  for (const char* name :
       {"search", "letter, hybrid", "letter, minimum", "corrected, minimum", "maximum of the cameras' scans",
        "scan of the cell's cloud", "nanoflann, cell", "PCL VoxelGrid 1 cm + KdTreeFLANN", "OctoMap 5 cm + EDT"}) {
    const Record* row = report.find("side by side, W", name, {{"cameras", 2}});
    if (row != nullptr) {
      const Record& r = *row;
      table.row({name, milliseconds(r["cycle_median_s"]),
                 report::three_digits(r["cycle_median_s"] / r["our_cycle_median_s"]), milliseconds(r["nine_median_s"]),
                 r["counts_occluded"] != 0 ? "yes" : "no", millimetres(r["over_max_m"])});
    }
  }
  page << table.text() << "\n\n";
}

std::string summary(const std::string& images, const Report& report) {
  std::ostringstream page;
  page << kSummaryIntroduction;
  write_about(page, report);
  write_cycle(page, report);
  page << kSummaryCycle;
  write_peers(page, report);
  page << kSummaryPeers << "![Time against the number of cameras](" << images << "/benchmark-cameras.png)\n\n"
       << kSummaryGoals;
  return page.str();
}

std::string details(const std::string& images, const Report& report) {
  std::ostringstream page;
  page << kDetailsIntroduction;
  write_about(page, report);
  write_ours(page, report);
  write_side_by_side(page, report);
  write_work(page, report);
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
  return page.str();
}

/// The part of docs/goals.md that is measured here; a page of nothing else where there is none.
void write_goals_between(const std::filesystem::path& page, const Report& report) {
  constexpr const char* kBegin = "<!-- goals of the search: begin -->";
  constexpr const char* kEnd = "<!-- goals of the search: end -->";
  if (!std::filesystem::exists(page)) {
    files::write_text_file(page, std::string(kBegin) + "\n" + kEnd + "\n");
  }
  report::write_between(page, kBegin, kEnd, goals_text(goals(report)) + goals_text(goals_with_verdicts(report)));
}

}  // namespace

void write_page(const std::string& file, const std::string& images, const Report& report) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(file).parent_path() / "docs";
  std::error_code failed;  // then writing says so
  fs::create_directories(folder, failed);
  const fs::path plots(images);
  files::write_text_file(file, summary(images, report));
  files::write_text_file(folder / "benchmark-search.md",
                         details(plots.is_absolute() ? images : plots.lexically_relative("docs").string(), report));
  write_goals_between(folder / "goals.md", report);
}

}  // namespace depthgrid::lab
