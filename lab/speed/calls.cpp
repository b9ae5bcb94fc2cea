#include "lab/speed/calls.hpp"

#include <algorithm>

#include "lab/speed/stage.hpp"

namespace depthgrid::lab {

Questions as_points(const std::vector<Eigen::Vector3d>& points_world) {
  Questions questions(points_world.size());
  std::transform(points_world.begin(), points_world.end(), questions.begin(), Capsule::point);
  return questions;
}

Questions as_links(double time_s) {
  const auto links = workload_arm(time_s).links;
  return {links.begin(), links.end()};
}

double time_between_s(int set, int repetition) {
  return Workload::time_s(set) + (repetition % kSubSteps) / (kSubSteps * kWorkloadRate);
}

std::uint64_t seed_of(int set, int repetition) {
  return static_cast<std::uint64_t>(set) * 100003 + 17 + static_cast<std::uint64_t>(repetition);
}

void Calls::ask(SearchPeer& ours, const Questions& questions, bool hybrid, bool first, const search::Budget& budget) {
  answers_.resize(questions.size());
  const double time_s = timed_s([&] {
    if (hybrid) {
      ours.search().hybrid(ours.snapshot(), questions, answers_, budget, &count_);
    } else {
      ours.search().distances(ours.snapshot(), questions, answers_, budget, &count_);
    }
  });
  call_s_.add(time_s);
  total_s_ += time_s;
  if (first) {
    first_s_.add(time_s);
  }
  answer_count_ += static_cast<double>(answers_.size());
  stopped_ += static_cast<double>(
      std::count_if(answers_.begin(), answers_.end(), [](const Answer& answer) { return answer.nearest.budget; }));
}

Record Calls::record(const std::string& group, const std::string& name, int cameras) const {
  Record record{group, name, {}, {}};
  record.numbers["cameras"] = cameras;
  call_s_.describe("call", "s", record.numbers);
  first_s_.describe("first", "s", record.numbers);
  record.numbers["calls_per_s"] = 1 / call_s_.mean();
  const auto calls = static_cast<double>(call_s_.count());
  record.numbers["nodes_mean"] = static_cast<double>(count_.nodes) / calls;
  record.numbers["ball_tests_mean"] = static_cast<double>(count_.ball_tests) / calls;
  record.numbers["stopped_share"] = stopped_ / answer_count_;
  return record;
}

}  // namespace depthgrid::lab
