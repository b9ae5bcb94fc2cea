// What the search should reach, held against what was measured.
#pragma once

#include <string>
#include <vector>

#include "record.hpp"

namespace depthgrid::bench {

/// One line of the table of goals. Values are in the unit that the text of the bound names; NaN: not measured.
struct Goal {
  std::string what;
  std::string bound_text;  ///< for instance "<= 0.25 ms"
  double bound = 0;
  bool at_most = true;  ///< else at least
  double clean = 0;     ///< on workload W
  double noisy = 0;     ///< on its noisy variant; NaN where it does not apply
  int digits = 3;

  [[nodiscard]] bool met(double value) const { return at_most ? value <= bound : value >= bound; }
};

[[nodiscard]] std::vector<Goal> goals(const Report& report);

/// One line about the first ratio or bound that even a quick run on a shared machine must keep; empty when all hold.
/// Far more generous than the goals, and never an absolute time.
[[nodiscard]] std::string broken_claim(const Report& report);

}  // namespace depthgrid::bench
