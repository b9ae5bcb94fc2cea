// A slice of the soundness campaign: the sound search against the oracle on random problems of every kind.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

#include "reference/answer_check.hpp"
#include "reference/search_problem_run.hpp"
#include "support/random_run.hpp"

namespace depthgrid::reference {
namespace {

constexpr int kQueries = 64;

TEST(SearchAgainstReference, NeverOverEstimatesAndIsTight) {
  const test::RandomRun run = test::random_run(1000);
  std::map<Fault, int> faults;
  std::int64_t asked = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    RandomOptions options;
    options.seed = run.seed + static_cast<std::uint64_t>(i);
    const SearchProblem problem = make_search_problem(options, kQueries);
    const std::vector<Answer> answers = SearchRun(problem).distances();
    const AnswerCheck check(problem);
    for (std::size_t q = 0; q < answers.size(); ++q) {
      ++asked;
      for (const auto& finding : {check.form(problem.primitives[q], answers[q]),
                                  check.soundness(problem.primitives[q], answers[q]).finding}) {
        if (finding && ++faults[finding->fault] <= 3) {  // a few of each kind say enough
          ADD_FAILURE() << to_string(finding->fault) << ", " << problem.line(q) << ": " << finding->what;
        }
      }
    }
  }
  std::cout << "  " << asked << " answers";
  for (const auto& [fault, count] : faults) {
    std::cout << ", " << to_string(fault) << ": " << count;
  }
  std::cout << '\n';
}

void expect_the_same_after_others(std::uint64_t seed) {
  RandomOptions options;
  options.seed = seed;
  const SearchProblem problem = make_search_problem(options, kQueries);
  SearchRun run(problem);
  const std::vector<Answer> fresh = run.distances();
  const std::vector<Answer> used = run.distances_with_history();
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t q = 0; q < fresh.size(); ++q) {
    EXPECT_TRUE(same(fresh[q].nearest.distance_m, used[q].nearest.distance_m)) << problem.line(q);
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(same(fresh[q].nearest.nearest_world[i], used[q].nearest.nearest_world[i])) << problem.line(q);
    }
  }
}

TEST(SearchAgainstReference, AnswersTheSameWhateverWasAskedBefore) {
  const test::RandomRun run = test::random_run(60);
  for (std::int64_t i = 0; i < run.count && !HasFailure(); ++i) {
    expect_the_same_after_others(run.seed + static_cast<std::uint64_t>(i));
  }
  // A cube on the border of W that is a leaf for one capsule, and split further and found empty for another.
  expect_the_same_after_others(912580);
}

}  // namespace
}  // namespace depthgrid::reference
