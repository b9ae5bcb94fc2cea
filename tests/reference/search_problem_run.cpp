#include "reference/search_problem_run.hpp"

namespace depthgrid::reference {
namespace {

void deliver_one(const SearchProblem& problem, std::size_t k, views::ViewStore& store) {
  if (!problem.present(k)) {
    return;
  }
  if (problem.moved) {
    (void)store.update(k, problem.frames[k], problem.scene.rig.cameras[k].T_world_camera);
  } else {
    (void)store.update(k, problem.frames[k]);
  }
}

views::Snapshot deliver(const SearchProblem& problem, views::ViewStore& store) {
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    deliver_one(problem, k, store);
  }
  return store.snapshot();
}

/// So few that they have to be forgotten now and then.
constexpr std::size_t kRememberedInHistory = 2000;
constexpr std::int64_t kNodesInHistory = 200;

}  // namespace

SearchRun::SearchRun(const SearchProblem& problem)
    : problem_(&problem), store_(problem.rig, problem.settings, 1), snapshot_(deliver(problem, store_)) {}

std::vector<Answer> SearchRun::distances(const search::Budget& budget) {
  std::vector<Answer> answers(problem_->primitives.size());
  search_.distances(snapshot_, problem_->primitives, answers, budget);
  return answers;
}

std::vector<Answer> SearchRun::hybrid() {
  std::vector<Answer> answers(problem_->primitives.size());
  search_.hybrid(snapshot_, problem_->primitives, answers);
  return answers;
}

std::vector<Answer> SearchRun::distances_with_history() const {
  const std::vector<Capsule>& primitives = problem_->primitives;
  std::vector<Answer> answers(primitives.size());
  views::ViewStore store(problem_->rig, problem_->settings, 1);
  search::Search search(kRememberedInHistory);
  for (std::size_t k = 0; k < problem_->frames.size(); ++k) {
    const views::Snapshot before = store.snapshot();
    search.distances(before, primitives, answers);
    search.hybrid(before, primitives, answers, {.nodes = kNodesInHistory});
    deliver_one(*problem_, k, store);
  }
  const views::Snapshot snapshot = store.snapshot();
  for (std::size_t i = primitives.size(); i-- > 0;) {
    search.distances(snapshot, {&primitives[i], 1}, {&answers[i], 1});
  }
  return answers;
}

}  // namespace depthgrid::reference
