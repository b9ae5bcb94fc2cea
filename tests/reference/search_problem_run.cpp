#include "reference/search_problem_run.hpp"

namespace depthgrid::reference {
namespace {

views::Snapshot deliver(const SearchProblem& problem, views::ViewStore& store) {
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    if (!problem.present(k)) {
      continue;
    }
    if (problem.moved) {
      (void)store.update(k, problem.frames[k], problem.scene.rig.cameras[k].T_world_camera);
    } else {
      (void)store.update(k, problem.frames[k]);
    }
  }
  return store.snapshot();
}

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

}  // namespace depthgrid::reference
