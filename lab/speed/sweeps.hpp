// How times grow with the number of points, rho, the resolution and the size of the images; two cameras.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lab/peers/peer.hpp"
#include "lab/speed/record.hpp"
#include "lab/speed/stage.hpp"

namespace depthgrid::lab {

struct SweepPlan {
  int frame_sets = 5;
  int repetitions = 10;  ///< of each query a frame set
  double limit_s = 3;    ///< wall clock a value of x
};

/// Rows of groups "sweep: points", "sweep: rho" and "sweep: resolution": x, prepare and query times, and for the
/// resolution errors. `kinds` are the peers that are asked.
void sweep_points(Stage& stage, const std::vector<PeerKind>& kinds, const SweepPlan& plan, Report& report);
void sweep_rho(Stage& stage, const std::vector<PeerKind>& kinds, const SweepPlan& plan, Report& report);
/// The search at several resolutions, with and without a filter radius, and the lattice at several pitches.
void sweep_resolution(Stage& stage, const SweepPlan& plan, Report& report);
/// Rows of group "sweep: image": x is the number of pixels. Renders its own frames.
void sweep_image(const std::vector<PeerKind>& kinds, const SweepPlan& plan, Report& report);

/// The kinds with these names, in this order; names that are not there are left out.
[[nodiscard]] std::vector<PeerKind> select(const std::vector<PeerKind>& kinds, const std::vector<std::string>& names);

}  // namespace depthgrid::lab
