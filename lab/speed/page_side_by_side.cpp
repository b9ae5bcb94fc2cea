#include <ostream>
#include <sstream>
#include <utility>

#include "lab/speed/number_text.hpp"
#include "lab/speed/page_parts.hpp"
#include "report/markdown_table.hpp"

namespace depthgrid::lab {
namespace {

std::string yes_no(double value) { return value != 0 ? "yes" : "no"; }

std::string errors_text(const Record& r, const std::string& side) {
  return millimetres(r[side + "_median_m"]) + " / " + millimetres(r[side + "_p95_m"]) + " / " +
         millimetres(r[side + "_max_m"]);
}

void write_table(std::ostream& page, const Report& report, const std::string& workload, double cameras,
                 const std::string& title) {
  report::MarkdownTable table({"", "prepare ms: median / max", "nine µs: median / max", "100 points µs",
                               "nothing near µs", "deep µs", "cycle ms", "cycle in ours", "MB", "occluded counts",
                               "carved by others", "too far mm: median / 95 % / max", "too near mm: the same"});
  bool any = false;
  for (const Record* row : report.group("side by side, " + workload)) {
    const Record& r = *row;
    if (r["cameras"] != cameras) {
      continue;
    }
    any = true;
    table.row({r.name, milliseconds(r["prepare_median_s"]) + " / " + milliseconds(r["prepare_max_s"]),
               microseconds(r["nine_median_s"]) + " / " + microseconds(r["nine_max_s"]),
               microseconds(r["hundred_median_s"]), microseconds(r["far_median_s"]), microseconds(r["deep_median_s"]),
               milliseconds(r["cycle_median_s"]), report::three_digits(r["cycle_median_s"] / r["our_cycle_median_s"]),
               report::three_digits(r["memory_bytes"] / 1e6), yes_no(r["counts_occluded"]), yes_no(r["carves"]),
               errors_text(r, "over"), errors_text(r, "under")});
  }
  if (any) {
    page << "### " << title << "\n\n" << table.text() << "\n\n";
  }
}

/// Everything that is quicker than ours, and what it does not do for it.
void write_quicker(std::ostream& page, const Report& report) {
  std::ostringstream list;
  for (const Record* row : report.group("side by side, W")) {
    const Record& r = *row;
    if (r["cameras"] != 2 || r.name.rfind("search", 0) == 0) {
      continue;
    }
    const double cycle = r["cycle_median_s"] / r["our_cycle_median_s"];
    const double nine = r["nine_median_s"] / r["our_nine_median_s"];
    if (cycle < 1 || nine < 1) {
      list << "- " << r.name << ": " << (cycle < 1 ? "cycle" : "") << (cycle < 1 && nine < 1 ? " and " : "")
           << (nine < 1 ? "query" : "") << " (" << report::three_digits(cycle) << " and " << report::three_digits(nine)
           << " of ours). Up to " << millimetres(r["over_max_m"]) << " mm too far and " << millimetres(r["under_max_m"])
           << " mm too near";
      if (r["counts_occluded"] == 0) {
        list << "; occluded space does not count";
      } else if (r["carves"] == 0) {
        list << "; no camera frees what another cannot see";
      }
      const double far = r["far_median_s"] / r["nine_median_s"];
      if (far > 2) {
        list << "; with nothing near its query takes " << report::three_digits(far) << " times as long";
      }
      list << ".\n\n";
    }
  }
  page << "### What is quicker than ours, and at what price\n\nTwo cameras; cycle, and query of nine points alone:\n\n"
       << (list.str().empty() ? "Nothing.\n\n" : list.str());
}

}  // namespace

void write_side_by_side(std::ostream& page, const Report& report) {
  page
      << "## Side by side\n\n`search` is ours with a filter radius of one pixel, its default; `search, w = 0` "
         "without, as all "
         "others, and the reference. `PCL clusters, hulls + FCL`: the cell's cloud at a point every 2 cm as planes and "
         "clusters, and the convex hull of each. `bubbles around people`: spheres along the limbs of both people, "
         "placed "
         "by the truth, as if a tracker made no error and took no time; table and boxes are no obstacle to it, nor is "
         "what somebody carries.\n\n";
  write_table(page, report, "W", 2, "Two cameras, robot masked");
  write_quicker(page, report);
  write_table(page, report, "W without robot", 2, "Two cameras, robot removed");
  write_table(page, report, "noisy", 2, "Two cameras, noisy; errors against the clean images");
  for (const auto& [cameras, title] : {std::pair{1.0, "One camera"}, {4.0, "Four cameras"}, {8.0, "Eight cameras"}}) {
    write_table(page, report, "W", cameras, std::string(title) + ", robot masked");
  }
}

}  // namespace depthgrid::lab
