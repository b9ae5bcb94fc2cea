#include "lab/experiments/stage/distance_method.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "lab/experiments/stage/declared_rig.hpp"

namespace depthgrid::experiments {

std::string_view to_string(EvaluationMethod method) noexcept {
  switch (method) {
    case EvaluationMethod::letter:
      return "letter";
    case EvaluationMethod::letter_hybrid:
      return "letter, hybrid";
    case EvaluationMethod::corrected:
      return "corrected";
    case EvaluationMethod::search:
      return "search";
    case EvaluationMethod::search_memory:
      return "search with memory";
  }
  return "";
}

namespace {

/// The grid knows one margin for all cameras: the largest of each part.
SensorMargin largest_margin(const Rig& rig) {
  SensorMargin largest;
  for (const CameraMargins& margins : camera_margins(rig)) {
    largest.constant_m = std::max(largest.constant_m, margins.sensor.constant_m);
    largest.linear = std::max(largest.linear, margins.sensor.linear);
    largest.quadratic_per_m = std::max(largest.quadratic_per_m, margins.sensor.quadratic_per_m);
    largest.lateral_px = std::max(largest.lateral_px, margins.sensor.lateral_px);
  }
  return largest;
}

grid::EvaluationSettings grid_settings(EvaluationMethod method, const Rig& rig) {
  grid::EvaluationSettings settings;
  settings.variant = method == EvaluationMethod::corrected ? grid::Variant::corrected : grid::Variant::letter;
  settings.collect = method == EvaluationMethod::letter_hybrid ? grid::Collect::hybrid : grid::Collect::minimum;
  settings.rho_m = DistanceMethod::kRho;
  settings.sensor = largest_margin(rig);
  return settings;
}

grid::DepthQuantisation cells(const simulation::Arrangement& arrangement) {
  return {arrangement.d_min_m, arrangement.cell_m, 0.0, arrangement.cells};
}

views::Settings search_settings(const Rig& rig, const simulation::Arrangement& arrangement) {
  const grid::DepthGrid space(rig.cameras.front().intrinsics, cells(arrangement));
  views::Settings settings;
  settings.space = views::FrustumSpace{0, space.d_min_m(), space.d_max_m()};
  settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0.0};
  settings.margins = camera_margins(rig);
  settings.rho_m = DistanceMethod::kRho;
  settings.v_max_m_s = 0;  // the images are of one instant
  return settings;
}

}  // namespace

DistanceMethod::DistanceMethod(EvaluationMethod method, const Rig& rig, const simulation::Arrangement& arrangement) {
  if (method == EvaluationMethod::search) {
    evaluator_ = std::make_unique<search::SearchEvaluator>(rig, search_settings(rig, arrangement));
  } else if (method == EvaluationMethod::search_memory) {
    views::Settings settings = search_settings(with_declarations(rig), arrangement);
    settings.v_max_m_s = kVMax;
    search::EvaluatorOptions options;
    options.memory = memory::MemorySettings{.low_world = arrangement.workspace_low_world,
                                            .high_world = arrangement.workspace_high_world,
                                            .start = memory::StartUnknown{}};
    evaluator_ = std::make_unique<search::SearchEvaluator>(rig, settings, options);
  } else {
    evaluator_ = std::make_unique<grid::GridEvaluator>(rig, 0, cells(arrangement), grid_settings(method, rig));
  }
}

void DistanceMethod::update(std::span<const Frame> frames) {
  if (const FrameUpdate update = update_all(*evaluator_, frames); !update.taken()) {
    fail("a simulated frame was not taken: ", update.reason);
  }
  time_s_ = frames.front().time_s;
}

void DistanceMethod::evaluate(std::span<const Eigen::Vector3d> points_world, std::span<Proximity> answers) {
  if (answers.size() != points_world.size()) {
    fail("distances of ", points_world.size(), " points into ", answers.size(), " answers");
  }
  points_.resize(points_world.size());
  found_.resize(points_world.size());
  std::transform(points_world.begin(), points_world.end(), points_.begin(), Capsule::point);
  evaluate(std::span<const Capsule>(points_), found_);
  std::transform(found_.begin(), found_.end(), answers.begin(), [](const Answer& answer) { return answer.nearest; });
}

void DistanceMethod::evaluate(std::span<const Capsule> capsules, std::span<Answer> answers) {
  evaluator_->evaluate(capsules, time_s_, answers);  // the images are of one instant
}

}  // namespace depthgrid::experiments
