#include "lab/speed/goals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace depthgrid::lab {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A value of one workload, given its key.
using Value = std::function<double(const std::string& workload)>;

/// Time of a peer's whole cycle in units of ours, measured beside it.
double cycle_ratio(const Report& report, const std::string& workload, const std::string& peer) {
  const Record* row = report.find("side by side, " + workload, peer, {{"cameras", 2}});
  return row != nullptr ? (*row)["cycle_median_s"] / (*row)["our_cycle_median_s"] : kNaN;
}

double letter_ratio(const Report& report, const std::string& workload, const std::string& letter,
                    const std::string& ours) {
  const auto mean = [&](const std::string& name) {
    return report.number("call_mean_s", "beside the letter, " + workload, name, {{"cameras", 2}});
  };
  return mean(letter) / mean(ours);
}

double ours(const Report& report, const std::string& workload, const std::string& row, double cameras,
            const char* key) {
  return report.number(key, "ours, " + workload, row, {{"cameras", cameras}});
}

/// Collects the goals of one report.
class Goals {
 public:
  explicit Goals(const Report& report) : report_(report) {}

  void add(const std::string& what, const std::string& bound_text, double bound, bool at_most, const Value& value) {
    Goal goal{what, bound_text, bound, at_most, {}};
    for (const WorkloadName& workload : kWorkloadNames) {
      goal.values.push_back(value(workload.key));
    }
    goals_.push_back(std::move(goal));
  }
  void rate(const std::string& what, const std::string& bound_text, double bound, const char* row) {
    add(what, bound_text, bound, false,
        [&](const std::string& workload) { return ours(report_, workload, row, 2, "calls_per_s"); });
  }
  void milliseconds(const std::string& what, const std::string& bound_text, double bound, const char* row,
                    double cameras, const char* key) {
    add(what, bound_text, bound, true,
        [&](const std::string& workload) { return 1e3 * ours(report_, workload, row, cameras, key); });
  }
  void letter(const std::string& what, double bound, const char* letter, const char* search) {
    add(what, ">= " + std::to_string(static_cast<int>(bound)), bound, false,
        [&](const std::string& workload) { return letter_ratio(report_, workload, letter, search); });
  }
  void cycle(const std::string& what, const std::string& bound_text, double bound, const char* peer) {
    add(what, bound_text, bound, false,
        [&](const std::string& workload) { return cycle_ratio(report_, workload, peer); });
  }
  void worst(const char* row, double cameras) {
    milliseconds(std::string(row) + ", " + std::to_string(static_cast<int>(cameras)) + " cameras (99th percentile)",
                 "<= 0.3 ms", 0.3, row, cameras, "call_p99_s");
    add("the aim of the line above, in times of the typical nine points (median)", "<= 2", 2, true,
        [&](const std::string& workload) {
          return ours(report_, workload, row, cameras, "call_median_s") /
                 ours(report_, workload, "nine points", cameras, "call_median_s");
        });
  }
  [[nodiscard]] std::vector<Goal> take() { return std::move(goals_); }

 private:
  const Report& report_;
  std::vector<Goal> goals_;
};

}  // namespace

bool Goal::missed() const {
  return std::any_of(values.begin(), values.end(), [this](double value) { return !std::isnan(value) && !met(value); });
}

std::vector<Goal> goals(const Report& report) {
  Goals goals(report);
  goals.milliseconds("an image in, 640 x 480 (median)", "<= 0.25 ms", 0.25, "image in", 2, "call_median_s");
  goals.rate("answers of nine points, 2 cameras", ">= 10 000 a second", 10000, "nine points");
  goals.rate("the aim of the line above", ">= 30 000 a second", 30000, "nine points");
  goals.letter("nine points, in times of `letter` with its hybrid vector, 2 cameras", 33, "letter, hybrid", "search");
  goals.letter("nine points, in times of `letter` that stops at the minimum, 2 cameras", 33, "letter, minimum",
               "search");
  goals.add("nine points: time with 8 cameras over time with 2", "<= 1.5", 1.5, true, [&](const std::string& workload) {
    return ours(report, workload, "nine points", 8, "call_mean_s") /
           ours(report, workload, "nine points", 2, "call_mean_s");
  });
  goals.rate("100 points, 2 cameras", ">= 1 500 a second", 1500, "100 points");
  goals.rate("seven link capsules, 2 cameras", ">= 3 000 a second", 3000, "seven link capsules");
  goals.rate("hybrid answers of nine points, 2 cameras", ">= 3 000 a second", 3000, "nine points, hybrid");
  for (const double cameras : {2.0, 8.0}) {
    goals.worst("nine points, nothing within rho", cameras);
    goals.worst("nine points, deep in occluded space", cameras);
  }
  goals.milliseconds("whole cycle, 2 cameras (median)", "<= 0.6 ms", 0.6, "cycle", 2, "call_median_s");
  goals.milliseconds("whole cycle, 8 cameras (median)", "<= 2.5 ms", 2.5, "cycle", 8, "call_median_s");
  goals.cycle("cycle of a nanoflann tree of the cell, in ours", ">= 50", 50, "nanoflann, cell");
  goals.cycle("the aim of the line above", ">= 100", 100, "nanoflann, cell");
  goals.cycle("cycle of a nanoflann tree of the cell with leaves of 32 points, in ours", ">= 50", 50,
              "nanoflann, cell, leaf 32");
  goals.cycle("cycle of OctoMap 5 cm with carving, in ours", ">= 300", 300, "OctoMap 5 cm + EDT");
  goals.cycle("the aim of the line above", ">= 1 000", 1000, "OctoMap 5 cm + EDT");
  goals.add("largest over-estimate, 2 cameras", "<= 0.01 mm", 0.01, true,
            [&](const std::string& workload) { return 1e3 * ours(report, workload, "errors", 2, "over_max_m"); });
  return goals.take();
}

std::string broken_claim(const Report& report) {
  std::ostringstream text;
  for (const Record& record : report.records) {
    const double over_m = record["over_max_m"];
    if (record.name.rfind("search", 0) == 0 || record.name == "errors") {
      // Against the clean images only margins help where there is noise, and the peers' setting has none.
      if (record.group != "side by side, noisy" && over_m > 1e-5) {
        text << record.group << ", " << record.name << ": over-estimates by " << over_m << " m";
        return text.str();
      }
    }
  }
  const auto at_least = [&text](const char* what, double value, double bound) {
    if (value < bound) {
      text << what << ": " << value << " times, must be at least " << bound;
      return true;
    }
    return false;
  };
  const auto nine_s = [&report](double cameras) { return ours(report, "W", "nine points", cameras, "call_median_s"); };
  if (at_least("`letter` takes the time of the search", letter_ratio(report, "W", "letter, hybrid", "search"), 3) ||
      at_least("a nanoflann cycle takes the time of ours", cycle_ratio(report, "W", "nanoflann, cell"), 8) ||
      at_least("an OctoMap cycle takes the time of ours", cycle_ratio(report, "W", "OctoMap 5 cm + EDT"), 40) ||
      at_least("nine points of 2 cameras take the time of 8", nine_s(2) / nine_s(8), 0.1)) {
    return text.str();
  }
  return {};
}

}  // namespace depthgrid::lab
