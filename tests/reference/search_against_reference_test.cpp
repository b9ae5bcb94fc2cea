// A slice of the soundness campaign: the sound search against the oracle on random problems of every kind.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace depthgrid::reference
