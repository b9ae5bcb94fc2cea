#include "program/distances/search_frame_evaluator.hpp"

namespace depthgrid::program {

namespace {

class SearchFrameEvaluator final : public FrameEvaluator {
 public:
  SearchFrameEvaluator(const Rig& rig, const views::Settings& settings, const search::Budget& budget, bool hybrid)
      : store_(rig, settings), budget_(budget), hybrid_(hybrid) {}

  bool update(std::span<const Frame> frames) override {
    bool complete = true;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      complete = store_.update(k, frames[k]) == views::UpdateResult::taken && complete;
    }
    return complete;
  }

  std::vector<PointAnswer> evaluate(std::span<const files::ControlPoint> points_world) override {
    std::vector<Capsule> primitives;
    primitives.reserve(points_world.size());
    for (const files::ControlPoint& point : points_world) {
      primitives.push_back(point.capsule);
    }
    std::vector<search::Answer> found(primitives.size());
    const views::Snapshot snapshot = store_.snapshot();
    if (hybrid_) {
      search_.hybrid(snapshot, primitives, found, budget_);
    } else {
      search_.distances(snapshot, primitives, found, budget_);
    }
    std::vector<PointAnswer> answers;
    answers.reserve(found.size());
    for (const search::Answer& answer : found) {
      answers.push_back({answer.nearest, answer.hybrid_direction_world, 0, answer.on_axis_world});
    }
    return answers;
  }

  [[nodiscard]] AnswerColumns columns() const override { return {hybrid_, false, true}; }

 private:
  views::ViewStore store_;
  search::Search search_;
  search::Budget budget_;
  bool hybrid_;
};

}  // namespace

std::unique_ptr<FrameEvaluator> make_search_evaluator(const Rig& rig, const views::Settings& settings,
                                                      const search::Budget& budget, bool hybrid) {
  return std::make_unique<SearchFrameEvaluator>(rig, settings, budget, hybrid);
}

}  // namespace depthgrid::program
