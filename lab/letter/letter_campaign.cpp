#include "lab/letter/letter_campaign.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/grid/map/parallel_for.hpp"
#include "reference/reference.hpp"

namespace depthgrid::lab {
namespace {

grid::GridEvaluator make_evaluator(const reference::RandomProblem& problem, grid::Variant variant,
                                   grid::Window window) {
  grid::EvaluationSettings settings;
  settings.variant = variant;
  settings.window = window;
  settings.rho_m = problem.rho_m;
  settings.sensor = problem.sensor;
  const grid::DepthQuantisation quantisation{problem.d_min_m, problem.step_m, 0.0, problem.cell_count};
  grid::GridEvaluator evaluator(problem.rig, problem.principal, quantisation, settings);
  (void)update_all(evaluator, problem.frames);
  return evaluator;
}

std::vector<PointErrors> one_scene(const CampaignSettings& settings, int scene) {
  reference::RandomOptions options;
  options.seed = settings.seed + static_cast<std::uint64_t>(scene);
  options.cameras = settings.secondaries + 1;
  options.width_px = settings.width_px > 0 ? settings.width_px : 48 + 8 * (scene % 7);
  options.rho_m = 0.4;
  options.step_m = 0.01;
  options.margins = options.lateral = options.invalid = options.robot = options.units = options.outside = false;
  const reference::RandomProblem problem = reference::make_random_problem(options);
  const reference::Reference oracle(problem.problem());
  const auto printed = make_evaluator(problem, grid::Variant::letter, grid::Window::region_of_surveillance);
  const auto whole = make_evaluator(problem, grid::Variant::letter, grid::Window::whole_image);
  const auto corrected = make_evaluator(problem, grid::Variant::corrected, grid::Window::region_of_surveillance);
  const LetterModel model(problem);

  std::vector<PointErrors> result;
  for (const Eigen::Vector3d& p_world : problem.points_world) {
    const reference::Interval interval = oracle.distance(p_world);
    const double hi_m = interval.hi_m.value_or(problem.rho_m);
    const auto error = [&](const grid::GridEvaluator& evaluator) {
      const double answer_m = evaluator.distance(Capsule::point(p_world)).nearest.distance_m;
      return PointErrors::Error{std::max(0.0, answer_m - hi_m), std::max(0.0, interval.lo_m - answer_m)};
    };
    PointErrors point;
    point.letter_printed = error(printed);
    point.letter_whole = error(whole);
    point.corrected = error(corrected);
    for (int mends = 0; mends <= kMendCount; ++mends) {
      const double answer_m = model.distance_m(p_world, first_mends(mends));
      point.over_after_mends_m[static_cast<std::size_t>(mends)] = std::max(0.0, answer_m - hi_m);
      if (mends == 0) {
        point.model_agrees = std::abs(answer_m - printed.distance(Capsule::point(p_world)).nearest.distance_m) < 1e-4;
      }
    }
    point.within_rho = interval.hi_m.has_value();
    point.point_free = hi_m > 0;
    point.decided = hi_m - interval.lo_m < 2e-3;
    point.worst_line = reference::to_line(options);
    result.push_back(point);
  }
  return result;
}

}  // namespace

std::vector<PointErrors> run_campaign(const CampaignSettings& settings,
                                      const std::function<void(std::size_t, std::size_t)>& progress) {
  std::vector<std::vector<PointErrors>> scenes(static_cast<std::size_t>(settings.scenes));
  const auto work = [&](std::size_t scene) { scenes[scene] = one_scene(settings, static_cast<int>(scene)); };
  (void)grid::parallel_for(scenes.size(), settings.threads, work, [&](std::size_t done) {
    progress(done, scenes.size());
    return true;
  });
  std::vector<PointErrors> points;
  for (std::vector<PointErrors>& scene : scenes) {
    points.insert(points.end(), std::make_move_iterator(scene.begin()), std::make_move_iterator(scene.end()));
  }
  return points;
}

}  // namespace depthgrid::lab
