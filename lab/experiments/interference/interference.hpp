// Fig. 14 of the letter: two Kinects that light the same space, and one of them vibrating. The simulation assumes what
// is lost (simulation/interference.hpp), so this shows what the assumption does and finds nothing out about Kinects.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lab/experiments/experiment.hpp"
#include "lab/experiments/stage/deviation_table.hpp"

namespace depthgrid::experiments {

/// Two neighbouring Kinects in one of three states.
struct InterferenceCase {
  std::string label;
  /// Of the images of the two cameras, mean over all instants: pixels without measurement, and pixels that free nothing
  /// once the lateral margin is applied.
  std::array<double, 2> invalid_share{};
  std::array<double, 2> blocked_share{};
  double unmeasured_share = 0;  ///< of the search's answers: the nearest point lies where a pixel measured nothing
  std::vector<LabelledDeviation> methods;  ///< letter, corrected, search, with both cameras
};

/// "each alone", "both", "both, the second vibrates", in this order. Throws Error. `pictures` may be null.
[[nodiscard]] std::vector<InterferenceCase> measure_interference(const Options& options, ExperimentReport* pictures);

void run_interference(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
