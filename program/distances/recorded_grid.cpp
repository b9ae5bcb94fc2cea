#include "program/distances/recorded_grid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/grid/map/map_file.hpp"
#include "program/usage_error.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::program {

namespace {

/// The deepest reading of the principal camera in the frames chosen: the grid then holds everything it sees.
double deepest_reading_m(files::Recording& recording, std::size_t camera, const MeasurementRule& rule,
                         const std::vector<int>& indices) {
  report::ProgressLine progress("looking for the deepest reading, frame", indices.size());
  double deepest_m = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (!recording.has_image(indices[i], camera)) {
      continue;
    }
    const DepthView view = recording.read_recorded(indices[i], camera);
    DepthImage depth(view.width_px, view.height_px);
    normalise(view, rule, depth);
    const auto* end = depth.data() + depth.index(0, depth.height_px());
    deepest_m = std::max(deepest_m, static_cast<double>(*std::max_element<const float*>(depth.data(), end)));
    progress.update(i + 1);
  }
  if (!(deepest_m > 0)) {
    fail("camera '", recording.rig().cameras[camera].id,
         "' spans the depth grid and measures nothing in the chosen frames, so the grid has no far end; give --far or "
         "--count, or another --principal");
  }
  return deepest_m;
}

/// The stored map, or nothing: the closed form is used then.
std::shared_ptr<const grid::DepthGridMap> load_map(const GridSource& source, const Rig& rig,
                                                   const grid::DepthQuantisation& cells) {
  if (source.map_file.empty()) {
    return nullptr;
  }
  const std::vector<grid::SecondaryCamera> secondaries = grid::secondary_cameras(rig, source.principal);
  const grid::DepthGrid depth_grid(rig.cameras[source.principal].intrinsics, cells);
  return std::make_shared<const grid::DepthGridMap>(grid::load_map(source.map_file, depth_grid, secondaries));
}

}  // namespace

std::unique_ptr<DistanceEvaluator> make_grid_evaluator(files::Recording& recording,
                                                       const std::vector<int>& frame_indices,
                                                       const EvaluationOptions& options, const GridSource& source,
                                                       const grid::EvaluationSettings& settings) {
  const Rig& rig = recording.rig();
  grid::DepthQuantisation base;
  std::optional<double> reach_m;
  if (!source.map_file.empty()) {
    base = grid::read_map_info(source.map_file).calibration.quantisation;
  } else if (!options.count) {
    const MeasurementRule& rule = rig.cameras[source.principal].rule;
    reach_m =
        std::isfinite(rule.far_m) ? rule.far_m : deepest_reading_m(recording, source.principal, rule, frame_indices);
  }
  const grid::DepthQuantisation cells = as_usage([&] { return depth_quantisation(options, base, reach_m); });
  return std::make_unique<grid::GridEvaluator>(rig, source.principal, cells, settings, load_map(source, rig, cells));
}

}  // namespace depthgrid::program
