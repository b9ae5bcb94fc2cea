#include "search/search_setup.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::search {
namespace {

double newest_s(const std::vector<Frame>& frames) {
  return std::max_element(frames.begin(), frames.end(),
                          [](const Frame& a, const Frame& b) { return a.time_s < b.time_s; })
      ->time_s;
}

CameraMargins random_margins(reference::Random& random, const reference::RandomProblem& problem, double v_max_m_s) {
  CameraMargins margins;
  margins.sensor = problem.sensor;
  margins.sensor.constant_m *= random.uniform(0.3, 1.7);
  margins.sensor.quadratic_per_m *= random.uniform(0.3, 1.7);
  margins.translation_m = problem.pose.translation_m * random.uniform(0.3, 1.7);
  margins.rotation_rad = problem.pose.rotation_rad * random.uniform(0.3, 1.7);
  if (v_max_m_s > 0) {
    margins.half_exposure_s = random.uniform(0, problem.pose.time_m) / v_max_m_s;
    margins.time_uncertainty_s = random.uniform(0, problem.pose.time_m) / v_max_m_s;
  }
  margins.smallest_obstacle_m = 0;
  return margins;
}

}  // namespace

SearchSetup make_setup(const reference::RandomProblem& problem, SpaceKind space, bool skewed) {
  reference::Random random(problem.options.seed * 7 + 3);
  SearchSetup setup{problem.rig, problem.frames, {}};
  views::Settings& settings = setup.settings;
  if (space == SpaceKind::frustum) {
    settings.space =
        views::FrustumSpace{problem.principal, problem.d_min_m, problem.d_min_m + problem.step_m * problem.cell_count};
  } else {
    views::BoxSpace box{};
    for (int axis = 0; axis < 3; ++axis) {
      box.low_world[axis] = -random.uniform(0.7, 1.5);
      box.high_world[axis] = random.uniform(0.7, 1.5);
    }
    settings.space = box;
  }
  settings.policies.unobserved = views::Policy::obstacle;
  settings.policies.outside = views::Policy::obstacle;
  settings.policies.robot_pockets = views::Policy::obstacle;
  settings.rho_m = problem.rho_m;
  settings.resolution_m = random.chance(0.5) ? 0.005 : random.uniform(0.002, 0.015);
  settings.v_max_m_s = problem.pose.time_m > 0 ? random.uniform(0.5, 2) : 0.0;
  for (Frame& frame : setup.frames) {
    frame.time_s = 100 + (skewed ? random.uniform(0, 0.01) : 0.0);
    settings.margins.push_back(random_margins(random, problem, settings.v_max_m_s));
  }
  return setup;
}

reference::Problem oracle_problem(const SearchSetup& setup, double grown_m, double rho_m) {
  reference::Problem problem;
  const double t_ref_s = newest_s(setup.frames);
  for (std::size_t k = 0; k < setup.rig.cameras.size(); ++k) {
    const RigCamera& camera = setup.rig.cameras[k];
    const CameraMargins& margins = setup.settings.margins[k];
    const Frame& frame = setup.frames[k];
    const double time_s = std::abs(frame.time_s - t_ref_s) + margins.half_exposure_s + margins.time_uncertainty_s;
    const PoseMargin pose{margins.translation_m + grown_m, margins.rotation_rad,
                          setup.settings.v_max_m_s * time_s * (1 + margins.rotation_rad)};
    problem.cameras.push_back({camera.intrinsics, camera.T_world_camera, camera.rule, frame, margins.sensor, pose});
  }
  if (const auto* frustum = std::get_if<views::FrustumSpace>(&setup.settings.space)) {
    problem.space = reference::FrustumSpace{frustum->principal, frustum->d_min_m, frustum->d_max_m};
  } else {
    const auto& box = std::get<views::BoxSpace>(setup.settings.space);
    problem.space = reference::WorldBox{box.low_world, box.high_world};
  }
  const auto counted = [](views::Policy policy) {
    return policy == views::Policy::obstacle ? reference::Policy::obstacle : reference::Policy::ignored;
  };
  problem.outside = counted(setup.settings.policies.outside);
  problem.uncovered = counted(setup.settings.policies.unobserved);
  problem.rho_m = rho_m > 0 ? rho_m : setup.settings.rho_m;
  return problem;
}

Asker::Asker(const SearchSetup& setup)
    : store_(std::make_unique<views::ViewStore>(setup.rig, setup.settings)), snapshot_([&] {
        for (std::size_t k = 0; k < setup.frames.size(); ++k) {
          EXPECT_EQ(store_->update(k, setup.frames[k]).result, UpdateResult::taken) << "camera " << k;
        }
        return store_->snapshot();
      }()) {}

Answer Asker::distance(const Capsule& primitive, const Budget& budget) {
  Answer answer;
  search_.distances(snapshot_, {&primitive, 1}, {&answer, 1}, budget);
  return answer;
}

std::vector<Answer> Asker::distances(std::span<const Capsule> primitives, const Budget& budget) {
  std::vector<Answer> answers(primitives.size());
  search_.distances(snapshot_, primitives, answers, budget);
  return answers;
}

}  // namespace depthgrid::search
