// One peer on one stage: times, errors, memory, and ours beside it.
#pragma once

#include "lab/peers/peer.hpp"
#include "lab/speed/record.hpp"
#include "lab/speed/stage.hpp"

namespace depthgrid::lab {

struct SideBySidePlan {
  int most_frame_sets = 30;
  double limit_s = 8;  ///< wall clock a row; three frame sets in any case
};

/// Runs the peer and adds its row to group "side by side, <workload>". For every frame set: the peer
/// takes it and answers nine points at 16 sub-steps, or at the two that the oracle knows where that takes too long;
/// then ours does a whole cycle. At most three frame sets when the peer needs over a second for one.
void measure_side_by_side(Stage& stage, const PeerKind& kind, const std::string& workload, const SideBySidePlan& plan,
                          Report& report);

}  // namespace depthgrid::lab
