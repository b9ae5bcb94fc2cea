#include "depthgrid/search/search_evaluator.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::search {
namespace {

/// Between the newest image of the memory and that of an answer, where it matters for words only.
constexpr double kBetweenImages_s = 0.04;

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

EvaluatorOptions checked(const EvaluatorOptions& options) {
  constexpr double kLongest_s = 3600;
  if (!(options.max_image_age_s > 0 && options.max_image_age_s <= kLongest_s)) {
    fail("search evaluator: images count up to an age of ", options.max_image_age_s, " s, must be above 0 and at most ",
         kLongest_s, ": how old a camera's newest image becomes");
  }
  return options;
}

}  // namespace

SearchEvaluator::SearchEvaluator(const Rig& rig, const views::Settings& settings, const EvaluatorOptions& options)
    // The memory holds a snapshot while it looks at an image.
    : store_(rig, settings, options.memory ? 3 : 2),
      memory_(options.memory ? std::make_unique<memory::MemoryStore>(store_, *options.memory) : nullptr),
      options_(checked(options)) {
  image_times_s_.fill(Proximity::kNaN);
}

FrameUpdate SearchEvaluator::remembered(std::size_t camera, FrameUpdate update) noexcept {
  if (memory_ != nullptr && update.taken()) {
    memory_->take(camera);
  }
  return update;
}

FrameUpdate SearchEvaluator::update(std::size_t camera, const Frame& frame) noexcept {
  return remembered(camera, store_.update(camera, frame));
}

FrameUpdate SearchEvaluator::update(std::size_t camera, const Frame& frame, const Pose& T_world_camera) noexcept {
  return remembered(camera, store_.update(camera, frame, T_world_camera));
}

void SearchEvaluator::evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept {
  evaluate(store_.snapshot(oldest_s(now_s)), capsules, now_s, answers);
}

double SearchEvaluator::oldest_s(double now_s) const noexcept {
  const double by_clock_s = now_s - options_.max_image_age_s;
  return memory_ != nullptr ? std::max(by_clock_s, memory_->released_s()) : by_clock_s;
}

double SearchEvaluator::image_time_s(std::size_t camera) const noexcept {
  return camera < camera_count() ? image_times_s_[camera] : Proximity::kNaN;
}

Past SearchEvaluator::past(const Proximity& nearest) const noexcept {
  const bool is_hidden = nearest.state == ProximityState::occluded || nearest.state == ProximityState::unmeasured ||
                         nearest.state == ProximityState::unobserved;
  if (memory_ == nullptr || !is_hidden) {
    return {};
  }
  // The answer may be of an image before or after the memory's newest; more than the time of an image says no more.
  const views::Settings& settings = store_.settings();
  return memory_->past(nearest.nearest_world, settings.resolution_m + settings.v_max_m_s * kBetweenImages_s);
}

Answer SearchEvaluator::distance(const Capsule& capsule) noexcept {
  Answer answer;
  const views::Snapshot snapshot = store_.snapshot();
  evaluate(snapshot, {&capsule, 1}, snapshot.reference_time_s(), {&answer, 1});
  return answer;
}

Answer SearchEvaluator::distance(const Capsule& capsule, double now_s) noexcept {
  Answer answer;
  evaluate(store_.snapshot(oldest_s(now_s)), {&capsule, 1}, now_s, {&answer, 1});
  return answer;
}

void SearchEvaluator::evaluate(const views::Snapshot& snapshot, std::span<const Capsule> capsules, double now_s,
                               std::span<Answer> answers) noexcept {
  for (std::size_t k = 0; k < snapshot.camera_count(); ++k) {
    image_times_s_[k] = snapshot.view(k).present() ? snapshot.view(k).time_s() : Proximity::kNaN;
  }
  const std::size_t count = std::min(capsules.size(), answers.size());
  const std::size_t led = std::min(options_.directions, count);
  const Budget share = led > 0 && led < count ? first_share(options_.budget) : options_.budget;
  const Budget rest = led > 0 ? less(options_.budget, share) : options_.budget;
  const std::span<const Capsule> first = capsules.first(led);
  const std::span<const Capsule> others = capsules.subspan(led, count - led);
  if (memory_ != nullptr) {
    const memory::MemorySnapshot memory = memory_->snapshot();
    impossible_ = memory.impossible();
    if (led > 0) {
      search_.hybrid(snapshot, memory, first, answers.first(led), share);
    }
    search_.distances(snapshot, memory, others, answers.subspan(led), rest);
  } else {
    if (led > 0) {
      search_.hybrid(snapshot, first, answers.first(led), share);
    }
    search_.distances(snapshot, others, answers.subspan(led), rest);
  }
  const double age_s = age_of_images_s(now_s, snapshot.reference_time_s());
  for (Answer& answer : answers.first(count)) {
    answer.distance_now_m = lower_bound_after(answer.nearest, age_s, snapshot.settings().v_max_m_s);
  }
}

}  // namespace depthgrid::search
