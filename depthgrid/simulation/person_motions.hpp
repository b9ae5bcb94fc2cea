// The poses that each scripted motion passes. Internal.
#pragma once

#include <cstdint>
#include <vector>

#include "depthgrid/simulation/person_script.hpp"

namespace depthgrid::simulation {

struct PersonPlan {
  std::vector<PersonKey> keys;  ///< at least two
  double pace = 1;              ///< share of v_max that the fastest point reaches
};

[[nodiscard]] PersonPlan plan_motion(Motion motion, const PersonStage& stage, std::uint64_t seed);

}  // namespace depthgrid::simulation
