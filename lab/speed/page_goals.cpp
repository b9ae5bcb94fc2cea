#include <algorithm>
#include <cmath>
#include <ostream>

#include "lab/speed/number_text.hpp"
#include "lab/speed/page_parts.hpp"
#include "report/markdown_table.hpp"

namespace depthgrid::lab {

void write_goals(std::ostream& page, const std::vector<Goal>& all) {
  page << "## Goals\n\n";
  std::vector<std::string> head{"goal", "bound"};
  for (const WorkloadName& workload : kWorkloadNames) {
    head.insert(head.end(), {workload.title, "met"});
  }
  report::MarkdownTable table(head);
  for (const Goal& goal : all) {
    std::vector<std::string> cells{goal.what, goal.bound_text};
    for (const double value : goal.values) {
      cells.insert(cells.end(), {report::three_digits(value), std::isnan(value) ? ""
                                                              : goal.met(value) ? "yes"
                                                                                : "**MISSED**"});
    }
    table.row(cells);
  }
  page << table.text() << "\n\n";
}

void write_misses(std::ostream& page, const std::vector<Goal>& all, const Report& report) {
  const auto missed = std::count_if(all.begin(), all.end(), [](const Goal& goal) { return goal.missed(); });
  page << "### What is slower than it should be, and where the time goes\n\n";
  if (missed == 0) {
    page << "Every goal is met on all workloads.\n\n";
    return;
  }
  page << missed << " of " << all.size()
       << " rows are missed on at least one workload. What one call does, in cubes of the octree that it opens and "
          "exact tests of a ball against one camera:\n\n";
  report::MarkdownTable table({"question", "workload", "cameras", "µs (mean)", "cubes", "ball tests", "ns a cube"});
  for (const auto& [workload, title] : kWorkloadNames) {
    for (const Record* row : report.group(std::string("ours, ") + workload)) {
      const double nodes = (*row)["nodes_mean"];
      const double cameras = (*row)["cameras"];
      if (std::isfinite(nodes) && (cameras == 2 || cameras == 8)) {
        table.row({row->name, workload, whole(cameras), microseconds((*row)["call_mean_s"]), whole(nodes),
                   whole((*row)["ball_tests_mean"]), report::three_digits(1e9 * (*row)["call_mean_s"] / nodes)});
      }
    }
  }
  page << table.text() << "\n\n";
}

}  // namespace depthgrid::lab
