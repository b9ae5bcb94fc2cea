#include <cmath>
#include <ostream>

#include "lab/speed/number_text.hpp"
#include "lab/speed/page_parts.hpp"
#include "report/markdown_table.hpp"

namespace depthgrid::lab {
namespace {

void write_rates(std::ostream& page, const Report& report) {
  page
      << "## Ours\n\nTimes in ms a call; all frame sets of the moving scene, new points for every call, the first call "
         "after each frame set included. Resolution 5 mm.\n\n";
  for (const auto& [workload, title] : kWorkloadNames) {
    const auto rows = report.group(std::string("ours, ") + workload);
    page << "On " << title << ":\n\n";
    report::MarkdownTable table(
        {"question", "cameras", "a second", "median", "99 %", "99.9 %", "largest", "first after a frame set", "calls"});
    for (const Record* row : rows) {
      const Record& r = *row;
      if (r.name != "errors" && !std::isnan(r["call_mean_s"])) {
        table.row({r.name, whole(r["cameras"]), report::three_digits(1 / r["call_mean_s"]),
                   milliseconds(r["call_median_s"]), milliseconds(r["call_p99_s"]), milliseconds(r["call_p999_s"]),
                   milliseconds(r["call_max_s"]), milliseconds(r["first_median_s"]), whole(r["call_count"])});
      }
    }
    page << table.text() << "\n\n";
  }
}

void write_errors(std::ostream& page, const Report& report) {
  page << "Errors against the oracle that knows the same margins, in mm (too near: the price of the resolution and of "
          "seams between the cameras' views):\n\n";
  report::MarkdownTable errors({"workload", "cameras", "answers", "too far: largest", "too near: median", "95 %",
                                "99 %", "largest", "nearest is a measured surface"});
  for (const auto& [workload, title] : kWorkloadNames) {
    for (const Record* row : report.group(std::string("ours, ") + workload)) {
      const Record& r = *row;
      if (r.name == "errors") {
        errors.row({workload, whole(r["cameras"]), whole(r["over_count"]), report::three_digits(1e3 * r["over_max_m"]),
                    millimetres(r["under_median_m"]), millimetres(r["under_p95_m"]), millimetres(r["under_p99_m"]),
                    millimetres(r["under_max_m"]), whole(100 * r["measured_share"]) + " %"});
      }
    }
  }
  page << errors.text() << "\n\n";
}

void write_letter(std::ostream& page, const Report& report) {
  page << "Beside `letter`, in turns on the same points, ms for nine points (median):\n\n";
  report::MarkdownTable letter({"workload", "cameras", "search", "search, hybrid", "letter, hybrid", "letter, minimum",
                                "letter, hybrid / search, hybrid", "letter, minimum / search"});
  for (const WorkloadName& workload : kWorkloadNames) {
    for (const double cameras : {1.0, 2.0, 4.0, 8.0}) {
      const auto time_s = [&, key = std::string(workload.key)](const char* name) {
        return report.number("call_median_s", "beside the letter, " + key, name, {{"cameras", cameras}});
      };
      if (!std::isnan(time_s("search"))) {
        letter.row({workload.key, whole(cameras), milliseconds(time_s("search")),
                    milliseconds(time_s("search, hybrid")), milliseconds(time_s("letter, hybrid")),
                    milliseconds(time_s("letter, minimum")),
                    report::three_digits(time_s("letter, hybrid") / time_s("search, hybrid")),
                    report::three_digits(time_s("letter, minimum") / time_s("search"))});
      }
    }
  }
  page << letter.text() << "\n\n";
}

void write_adversarial(std::ostream& page, const Report& report) {
  page << "Frames that no scene gives, nine points, ms:\n\n";
  report::MarkdownTable adversarial(
      {"case", "cameras", "budget", "median", "largest", "answers that the budget stopped"});
  for (const Record* row : report.group("adversarial")) {
    const Record& r = *row;
    adversarial.row({r.name, whole(r["cameras"]), r["budget_s"] > 0 ? milliseconds(r["budget_s"]) : "none",
                     milliseconds(r["call_median_s"]), milliseconds(r["call_max_s"]),
                     r["budget_s"] > 0 ? whole(100 * r["stopped_share"]) + " %" : "-"});
  }
  page << adversarial.text() << "\n\n";
}

void write_budgets(std::ostream& page, const Report& report) {
  page << "Nine points with a budget, two cameras: how much of the whole answer the bound is when it ends, in the "
          "first and the "
          "15 later calls of each frame set:\n\n";
  report::MarkdownTable table({"workload", "nodes", "answers stopped", "bound at least 0.7 of the answer",
                               "all nine of a call", "bound 0, answer not", "ms (median)", "largest"});
  for (const auto& [workload, title] : kWorkloadNames) {
    for (const Record* row : report.group(std::string("budget, ") + workload)) {
      const Record& r = *row;
      table.row({workload, whole(r["budget_nodes"]), whole(100 * r["stopped_share"]) + " %",
                 report::three_digits(100 * r["large_share"]) + " %",
                 report::three_digits(100 * r["large_calls_share"]) + " %",
                 report::three_digits(100 * r["zero_share"]) + " %", milliseconds(r["call_median_s"]),
                 milliseconds(r["call_max_s"])});
    }
  }
  page << table.text() << "\n\n";
}

}  // namespace

void write_ours(std::ostream& page, const Report& report) {
  write_rates(page, report);
  write_errors(page, report);
  write_letter(page, report);
  write_adversarial(page, report);
  write_budgets(page, report);
}

}  // namespace depthgrid::lab
