#include "lab/campaign/examination.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "reference/answer_check.hpp"
#include "reference/search_problem_run.hpp"

namespace depthgrid::lab {
namespace {

using reference::AnswerCheck;
using reference::Fault;
using reference::SearchProblem;

constexpr std::uint64_t kProblemsPerExtra = 10;
constexpr std::uint64_t kQueriesPerShortfall = 50;
/// The shortfall in metres is told for this resolution, which most problems have.
constexpr double kUsualResolutionM = 0.005;

std::string cameras_of(const SearchProblem& problem) {
  const std::size_t count = problem.rig.cameras.size();
  return count == 1 ? "1 camera" : count == 2 ? "2 cameras" : "3 and more cameras";
}

std::string sensor_of(const SearchProblem& problem) { return problem.ideal ? "no margins" : "margins"; }

bool sees_robot(const Frame& frame) {
  const float* near_m = frame.robot.near_m;
  const auto pixels = static_cast<std::ptrdiff_t>(frame.depth.width_px) * frame.depth.height_px;
  return near_m != nullptr && std::any_of(near_m, near_m + pixels, [](float depth_m) { return depth_m > 0; });
}

/// The rows in which the problem's queries count, less the primitives'.
std::vector<std::string> kinds_of(const SearchProblem& problem) {
  const views::Settings& s = problem.settings;
  std::vector<std::string> kinds{"all", std::holds_alternative<views::BoxSpace>(s.space) ? "W a box" : "W a view",
                                 cameras_of(problem), sensor_of(problem)};
  const auto add_if = [&kinds](bool so, const char* kind) {
    if (so) {
      kinds.emplace_back(kind);
    }
  };
  const auto any_frame = [&problem](auto&& holds) {
    return std::any_of(problem.frames.begin(), problem.frames.end(), holds);
  };
  add_if(any_frame(sees_robot), "robot in view");
  add_if(any_frame([](const Frame& frame) { return frame.depth.data == nullptr; }), "an image missing");
  add_if(problem.moved, "moved cameras");
  add_if(s.v_max_m_s > 0, "time skew");
  add_if(s.policies.unobserved == views::Policy::ignored, "unobserved ignored");
  add_if(s.policies.outside == views::Policy::obstacle, "outside an obstacle");
  add_if(s.policies.robot_pockets == views::Policy::ignored, "robot pockets ignored");
  return kinds;
}

const char* shape_of(const Capsule& primitive) {
  return primitive.a != primitive.b ? "capsules" : primitive.radius_m > 0 ? "spheres" : "points";
}

void note(Tally& tally, const SearchProblem& problem, std::size_t query, const std::string& kind,
          const std::string& what) {
  tally.note(kind, problem.line(query) + ": " + what);
}

/// Of one query; none where it touches an obstacle or has no distance.
void add_shortfall(const SearchProblem& problem, std::size_t query, const Answer& answer, Tally& tally) {
  const reference::Interval interval = problem.oracle->distance(reference::to_reference(problem.primitives[query]));
  const double hi_m = interval.hi_m.value_or(problem.settings.rho_m);
  if (interval.point_outside || !(hi_m > 0)) {
    ++tally.counts["shortfall: touching or without distance"];
    return;
  }
  const double shortfall_m = hi_m - answer.nearest.distance_m;
  const std::string kind = cameras_of(problem) + ", " + sensor_of(problem);
  tally.shortfall_resolutions[kind].add(shortfall_m / problem.settings.resolution_m);
  if (problem.settings.resolution_m == kUsualResolutionM) {
    tally.shortfall_m[kind].add(shortfall_m);
  }
}

/// What is wrong with a direction, if anything.
std::string wrong_direction(const Answer& answer, const Answer& without, double blend) {
  if (answer.nearest.distance_m != without.nearest.distance_m &&
      !(std::isnan(answer.nearest.distance_m) && std::isnan(without.nearest.distance_m))) {
    return "the distance differs";
  }
  const Eigen::Vector3d& nearest = answer.nearest.direction_world;
  const Eigen::Vector3d& hybrid = answer.hybrid_direction_world;
  if (!nearest.allFinite() || nearest.isZero(0)) {
    return hybrid.isZero(0) ? "" : "there is a direction without an obstacle at a distance";
  }
  const double least = 1 / std::sqrt(1 + blend * blend);
  const double product = hybrid.dot(nearest);
  std::ostringstream text;
  if (!(std::abs(hybrid.norm() - 1) < 1e-9 && product >= least - 1e-9)) {
    text << "length " << hybrid.norm() << ", product with the nearest direction " << product << ", at least " << least;
  }
  return text.str();
}

/// Answers of calls that may open few cubes only.
void ask_with_budget(const SearchProblem& problem, reference::SearchRun& run, Tally& tally) {
  reference::Random random(problem.options.seed * 0x9E3779B97F4A7C15U + 5);
  const auto nodes = static_cast<std::int64_t>(std::pow(10.0, random.uniform(0, 4.5)));
  search::Budget budget;
  budget.nodes = nodes;
  examine_budget_answers(problem, run.distances(budget), nodes, tally);
}

void ask_for_directions(SearchProblem& problem, std::span<const Answer> without, Tally& tally) {
  reference::Random random(problem.options.seed * 0x9E3779B97F4A7C15U + 7);
  problem.settings.direction_blend = random.chance(0.5) ? 1.0 : random.uniform(0, 1);
  examine_directions(problem, reference::SearchRun(problem).hybrid(), without, tally);
}

}  // namespace

void examine_budget_answers(const SearchProblem& problem, std::span<const Answer> answers, std::int64_t nodes,
                            Tally& tally) {
  const AnswerCheck check(problem);
  for (std::size_t q = 0; q < answers.size(); ++q) {
    ++tally.counts["budget: queries"];
    tally.counts["budget: stopped"] += answers[q].nearest.budget ? 1 : 0;
    for (const auto& finding :
         {check.form(problem.primitives[q], answers[q]), check.soundness(problem.primitives[q], answers[q]).finding}) {
      if (finding) {
        const std::string kind = std::string("budget: ") + to_string(finding->fault);
        ++tally.counts[kind];
        note(tally, problem, q, kind, "of " + std::to_string(nodes) + " nodes, " + finding->what);
      }
    }
  }
}

void examine_later_answers(const SearchProblem& problem, std::span<const Answer> answers, std::span<const Answer> fresh,
                           Tally& tally) {
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t q = 0; q < answers.size(); ++q) {
    ++tally.counts["history: queries"];
    const Proximity& before = fresh[q].nearest;
    const Proximity& now = answers[q].nearest;
    bool all = same(before.distance_m, now.distance_m) && before.state == now.state;
    for (int i = 0; i < 3; ++i) {
      all = all && same(before.nearest_world[i], now.nearest_world[i]);
    }
    if (!all) {
      ++tally.counts["history: different"];
      note(tally, problem, q, "history", "another answer after other questions");
    }
  }
}

void examine_directions(const SearchProblem& problem, std::span<const Answer> answers, std::span<const Answer> without,
                        Tally& tally) {
  for (std::size_t q = 0; q < answers.size(); ++q) {
    ++tally.counts["direction: queries"];
    tally.counts["direction: given"] += answers[q].hybrid_direction_world.isZero(0) ? 0 : 1;
    const std::string what = wrong_direction(answers[q], without[q], problem.settings.direction_blend);
    if (!what.empty()) {
      ++tally.counts["direction: wrong"];
      note(tally, problem, q, "direction", what);
    }
  }
}

void examine_answers(const SearchProblem& problem, std::span<const Answer> answers, Tally& tally) {
  const std::vector<std::string> kinds = kinds_of(problem);
  for (const std::string& kind : kinds) {
    ++tally.rows[kind].problems;
  }
  const AnswerCheck check(problem);
  for (std::size_t q = 0; q < answers.size(); ++q) {
    const Capsule& primitive = problem.primitives[q];
    Row found;
    for (const auto& finding : {check.form(primitive, answers[q]), check.soundness(primitive, answers[q]).finding}) {
      if (finding) {
        ++found.faults.at(static_cast<std::size_t>(finding->fault));
        note(tally, problem, q, to_string(finding->fault), finding->what);
      }
    }
    const auto count = [&](Row& row) {
      ++row.queries;
      std::transform(row.faults.begin(), row.faults.end(), found.faults.begin(), row.faults.begin(), std::plus<>());
    };
    count(tally.rows[shape_of(primitive)]);
    for (const std::string& kind : kinds) {
      count(tally.rows[kind]);
    }
    // 64 and 50 have a common divisor, so the seed moves the queries that are taken.
    if ((problem.options.seed * 31 + q) % kQueriesPerShortfall == 0) {
      add_shortfall(problem, q, answers[q], tally);
    }
  }
}

void examine(std::uint64_t seed, const std::string& code, Tally& tally) {
  const auto start = std::chrono::steady_clock::now();
  tally.seeds.add(seed, seed + 1);
  reference::RandomOptions options;
  options.seed = seed;
  if (tally.width_px > 0) {
    options.width_px = tally.width_px;
  }
  SearchProblem problem = reference::make_search_problem(options, kQueriesPerProblem);
  reference::SearchRun run(problem);
  const std::vector<Answer> answers = run.distances();
  examine_answers(problem, answers, tally);
  if (seed % kProblemsPerExtra == 0) {
    ask_with_budget(problem, run, tally);
    examine_later_answers(problem, run.distances_with_history(), answers, tally);
    ask_for_directions(problem, answers, tally);
  }
  tally.queries_by_code[code] += static_cast<std::int64_t>(answers.size());
  tally.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace depthgrid::lab
