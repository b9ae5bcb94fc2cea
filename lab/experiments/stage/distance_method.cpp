#include "lab/experiments/stage/distance_method.hpp"

#include <algorithm>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/search/search.hpp"

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
  }
  return "";
}

class DistanceMethod::Evaluator {
 public:
  Evaluator() = default;
  virtual ~Evaluator() = default;
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;
  Evaluator(Evaluator&&) = delete;
  Evaluator& operator=(Evaluator&&) = delete;
  [[nodiscard]] virtual bool update(std::span<const Frame> frames) = 0;
  virtual void evaluate(std::span<const Eigen::Vector3d> points_world, std::span<Proximity> answers) = 0;
};

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

class DistanceMethod::GridMethod final : public Evaluator {
 public:
  GridMethod(EvaluationMethod method, const Rig& rig, const simulation::Arrangement& arrangement)
      : evaluator_(rig, 0, cells(arrangement), grid_settings(method, rig)) {}

  bool update(std::span<const Frame> frames) override { return evaluator_.update(frames); }

  void evaluate(std::span<const Eigen::Vector3d> points_world, std::span<Proximity> answers) override {
    found_.resize(points_world.size());
    evaluator_.evaluate(points_world, found_);
    for (std::size_t i = 0; i < found_.size(); ++i) {
      answers[i] = found_[i].nearest;
    }
  }

 private:
  grid::GridEvaluator evaluator_;
  std::vector<grid::Evaluation> found_;
};

class DistanceMethod::SearchMethod final : public Evaluator {
 public:
  SearchMethod(const Rig& rig, const simulation::Arrangement& arrangement)
      : store_(rig, search_settings(rig, arrangement)) {}

  bool update(std::span<const Frame> frames) override {
    bool complete = true;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      complete = store_.update(k, frames[k]) == views::UpdateResult::taken && complete;
    }
    return complete;
  }

  void evaluate(std::span<const Eigen::Vector3d> points_world, std::span<Proximity> answers) override {
    primitives_.clear();
    for (const Eigen::Vector3d& p_world : points_world) {
      primitives_.push_back(Capsule::point(p_world));
    }
    found_.resize(primitives_.size());
    search_.distances(store_.snapshot(), primitives_, found_);
    for (std::size_t i = 0; i < found_.size(); ++i) {
      answers[i] = found_[i].nearest;
    }
  }

 private:
  views::ViewStore store_;
  search::Search search_;
  std::vector<Capsule> primitives_;
  std::vector<search::Answer> found_;
};

DistanceMethod::DistanceMethod(EvaluationMethod method, const Rig& rig, const simulation::Arrangement& arrangement) {
  if (method == EvaluationMethod::search) {
    evaluator_ = std::make_unique<SearchMethod>(rig, arrangement);
  } else {
    evaluator_ = std::make_unique<GridMethod>(method, rig, arrangement);
  }
}
DistanceMethod::~DistanceMethod() = default;
DistanceMethod::DistanceMethod(DistanceMethod&&) noexcept = default;
DistanceMethod& DistanceMethod::operator=(DistanceMethod&&) noexcept = default;

void DistanceMethod::update(std::span<const Frame> frames) {
  if (!evaluator_->update(frames)) {
    fail("a simulated frame was not taken");
  }
}

void DistanceMethod::evaluate(std::span<const Eigen::Vector3d> points_world, std::span<Proximity> answers) {
  if (answers.size() != points_world.size()) {
    fail("distances of ", points_world.size(), " points into ", answers.size(), " answers");
  }
  evaluator_->evaluate(points_world, answers);
}

}  // namespace depthgrid::experiments
