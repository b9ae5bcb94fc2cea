// The method search on a recording.
#pragma once

#include <memory>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/search/search.hpp"
#include "program/distances/frame_evaluator.hpp"

namespace depthgrid::program {

/// The rig's world frame is the one of points and answers. Throws Error when rig or settings are not valid.
std::unique_ptr<FrameEvaluator> make_search_evaluator(const Rig& rig, const views::Settings& settings,
                                                      const search::Budget& budget, bool hybrid);

}  // namespace depthgrid::program
