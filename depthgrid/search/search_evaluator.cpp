#include "depthgrid/search/search_evaluator.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::search {
namespace {

/// A quarter for those that get a direction, the rest for the others.
Budget first_share(Budget budget) noexcept {
  budget.nodes = budget.nodes ? std::optional(*budget.nodes / 4) : budget.nodes;
  budget.time_s = budget.time_s ? std::optional(*budget.time_s / 4) : budget.time_s;
  return budget;
}

Budget less(Budget budget, const Budget& share) noexcept {
  budget.nodes = budget.nodes ? std::optional(*budget.nodes - *share.nodes) : budget.nodes;
  budget.time_s = budget.time_s ? std::optional(*budget.time_s - *share.time_s) : budget.time_s;
  return budget;
}

/// NaN stays NaN, and what lies further in the future than kClockTolerance_s becomes NaN: nothing is known then.
double age_of_images_s(double now_s, double reference_time_s) noexcept {
  const double age_s = now_s - reference_time_s;
  return age_s >= -kClockTolerance_s ? std::abs(age_s) : Proximity::kNaN;
}

}  // namespace

SearchEvaluator::SearchEvaluator(const Rig& rig, const views::Settings& settings, const EvaluatorOptions& options)
    : store_(rig, settings), options_(options) {}

FrameUpdate SearchEvaluator::update(std::size_t camera, const Frame& frame) noexcept {
  return store_.update(camera, frame);
}

FrameUpdate SearchEvaluator::update(std::size_t camera, const Frame& frame, const Pose& T_world_camera) noexcept {
  return store_.update(camera, frame, T_world_camera);
}

void SearchEvaluator::evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept {
  evaluate(store_.snapshot(), capsules, now_s, answers);
}

Answer SearchEvaluator::distance(const Capsule& capsule) noexcept {
  Answer answer;
  const views::Snapshot snapshot = store_.snapshot();
  evaluate(snapshot, {&capsule, 1}, snapshot.reference_time_s(), {&answer, 1});
  return answer;
}

Answer SearchEvaluator::distance(const Capsule& capsule, double now_s) noexcept {
  Answer answer;
  evaluate(store_.snapshot(), {&capsule, 1}, now_s, {&answer, 1});
  return answer;
}

void SearchEvaluator::evaluate(const views::Snapshot& snapshot, std::span<const Capsule> capsules, double now_s,
                               std::span<Answer> answers) noexcept {
  const std::size_t count = std::min(capsules.size(), answers.size());
  const std::size_t led = std::min(options_.directions, count);
  const Budget share = led > 0 && led < count ? first_share(options_.budget) : options_.budget;
  const Budget rest = led > 0 ? less(options_.budget, share) : options_.budget;
  if (led > 0) {
    search_.hybrid(snapshot, capsules.first(led), answers.first(led), share);
  }
  search_.distances(snapshot, capsules.subspan(led, count - led), answers.subspan(led), rest);
  const double age_s = age_of_images_s(now_s, snapshot.reference_time_s());
  for (Answer& answer : answers.first(count)) {
    answer.distance_now_m = lower_bound_after(answer.nearest, age_s, snapshot.settings().v_max_m_s);
  }
}

}  // namespace depthgrid::search
