// The methods letter and corrected on a recording.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/distance_evaluator.hpp"
#include "depthgrid/files/recording.hpp"
#include "program/distances/evaluation_options.hpp"

namespace depthgrid::program {

/// Where the depth cells come from besides the options.
struct GridSource {
  std::string map_file;  ///< empty: the closed form
  std::size_t principal = 0;
};

/// `frame_indices`: the frames that will be evaluated; where neither the options nor the camera say how far the grid
/// reaches they are read for the deepest reading. Throws Error.
std::unique_ptr<DistanceEvaluator> make_grid_evaluator(files::Recording& recording,
                                                       const std::vector<int>& frame_indices,
                                                       const EvaluationOptions& options, const GridSource& source,
                                                       const grid::EvaluationSettings& settings);

}  // namespace depthgrid::program
