// What the search should reach, held against what was measured.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lab/speed/record.hpp"

namespace depthgrid::lab {

/// What is measured on: the name that ends the names of groups, as in "ours, W", and its title on the page.
struct WorkloadName {
  const char* key;
  const char* title;
};
inline constexpr std::array<WorkloadName, 3> kWorkloadNames{{{"W", "workload W, robot masked"},
                                                             {"W without robot", "workload W, robot removed"},
                                                             {"noisy", "noisy, robot masked, with margins"}}};

/// One line of the table of goals.
struct Goal {
  std::string what;
  std::string bound_text;  ///< for instance "<= 0.25 ms"
  double bound = 0;
  bool at_most = true;         ///< else at least
  std::vector<double> values;  ///< one a workload, in the unit of the bound; NaN where it was not measured

  [[nodiscard]] bool met(double value) const { return at_most ? value <= bound : value >= bound; }
  [[nodiscard]] bool missed() const;
};

/// Those set for the first search, which remembered nothing from call to call.
[[nodiscard]] std::vector<Goal> goals(const Report& report);

/// One line of the table of goals with an aim beyond each.
struct AimedGoal {
  std::string what;
  const char* workload = "";  ///< key
  const char* unit = "";
  double goal = 0;
  double aim = 0;  ///< beyond the goal: where it is more, values are to be at least these, else at most; the same: none
  double value = 0;

  [[nodiscard]] bool reached(double bound) const { return aim <= goal ? value <= bound : value >= bound; }
};

/// Those set for the search that keeps its verdicts for a snapshot; two cameras.
[[nodiscard]] std::vector<AimedGoal> goals_with_verdicts(const Report& report);

/// One line about the first ratio or bound that even a quick run on a shared machine must keep; empty when all hold.
/// Far more generous than the goals, and never an absolute time.
[[nodiscard]] std::string broken_claim(const Report& report);

}  // namespace depthgrid::lab
