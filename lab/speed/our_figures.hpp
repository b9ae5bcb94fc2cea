// The search's own figures: rates, worst cases and errors.
#pragma once

#include <string>

#include "lab/speed/record.hpp"
#include "lab/speed/stage.hpp"

namespace depthgrid::lab {

/// What the search is told of sensors and calibration.
struct OurMargins {
  SensorMargin sensor;
  PoseMargin pose;
};

struct OurPlan {
  int repetitions = 200;       ///< of nine points a frame set; other questions are asked less often
  int accuracy_sets = 10;      ///< frame sets whose answers the oracle looks at
  int letter_repetitions = 5;  ///< evaluations of `letter` beside ours a frame set
  double limit_s = 5;          ///< of calls a row: then one a frame set
};

/// All questions of one stage, as rows of group "ours, <workload>": images in, nine points, 100 points, link capsules,
/// hybrid, whole cycles, the worst cases, and errors against the oracle that knows the same margins. New points for
/// every call; the first call after a frame set is among them.
void measure_ours(Stage& stage, const std::string& workload, const OurMargins& margins, const OurPlan& plan,
                  Report& report);

/// Nine points with a smallest obstacle, a memory that begins with nothing known, and the time of each call, as a row
/// of group "ours, <workload>"; images there go into the memory, too.
void measure_remembered(Stage& stage, const std::string& workload, const OurMargins& margins, const OurPlan& plan,
                        Report& report);

/// Ours and `letter` in turns on the same points, as rows of group "beside the letter, <workload>".
void measure_beside_letter(Stage& stage, const std::string& workload, const OurPlan& plan, Report& report);

/// The bounds of calls whose budget of nodes ends beside the whole answers, as rows of group "budget, <workload>".
void measure_budget_bounds(Stage& stage, const std::string& workload, const OurMargins& margins, Report& report);

/// Frames that no scene gives, with and without a budget, as rows of group "adversarial": every pixel at random,
/// nothing measured at all, and points at the cameras.
void measure_adversarial(Stage& stage, const OurPlan& plan, Report& report);

}  // namespace depthgrid::lab
