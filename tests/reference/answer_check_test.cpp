// The check of answers is shown wrong ones of every kind: what it never finds in right ones it finds in these.
#include "reference/answer_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "reference/search_problem_run.hpp"
#include "support/random_run.hpp"

namespace depthgrid::reference {
namespace {

using Eigen::Vector3d;

constexpr int kQueries = 24;
constexpr double kNaN = Proximity::kNaN;

/// Calls visit(problem, primitive, answer) with the right answers of random problems.
template <class Visit>
void for_answers(Visit&& visit) {
  const test::RandomRun run = test::random_run(15);
  for (std::int64_t i = 0; i < run.count; ++i) {
    RandomOptions options;
    options.seed = run.seed + static_cast<std::uint64_t>(i);
    const SearchProblem problem = make_search_problem(options, kQueries);
    const std::vector<Answer> answers = SearchRun(problem).distances();
    for (std::size_t q = 0; q < answers.size(); ++q) {
      visit(problem, problem.primitives[q], answers[q]);
    }
  }
}

bool has_nearest(const Answer& answer) { return answer.nearest.nearest_world.allFinite(); }

/// A surface, a hole or a shadow at a distance.
bool stands_in_space(const Answer& answer) {
  return has_nearest(answer) && answer.nearest.distance_m > 0.05 && answer.nearest.state != ProximityState::outside;
}

struct Spoil {
  const char* what;
  Fault fault;
  double share;  ///< of the spoilt answers in which it has to be found: elsewhere they may be right by chance
  std::function<bool(const SearchProblem&, Answer&)> spoil;  ///< false: not with this answer
};

bool set_state(Answer& answer, ProximityState from, ProximityState to) {
  const bool suits = stands_in_space(answer) && answer.nearest.state == from;
  answer.nearest.state = to;
  return suits;
}

const std::vector<Spoil>& spoils() {
  using P = SearchProblem;
  static const std::vector<Spoil> all{
      {"a hand's breadth too far", Fault::over_estimate, 0.9,
       [](const P&, Answer& a) {
         const bool suits = has_nearest(a) && a.nearest.distance_m > 0;
         a.nearest.distance_m += 0.1;
         return suits;
       }},
      {"nothing there at all", Fault::over_estimate, 0.9,
       [](const P& p, Answer& a) {
         const bool suits = has_nearest(a) && a.nearest.distance_m < p.settings.rho_m - 0.05;
         a.nearest.distance_m = p.settings.rho_m;
         a.nearest.state = ProximityState::beyond_rho;
         a.nearest.nearest_world = a.nearest.direction_world = a.on_axis_world = Vector3d::Constant(kNaN);
         return suits;
       }},
      {"a nearest point in free space", Fault::not_tight, 0.8,
       [](const P& p, Answer& a) {
         const double by_m = p.settings.resolution_m + 0.03;
         a.nearest.distance_m -= by_m;
         a.nearest.nearest_world -= by_m * a.nearest.direction_world;
         return stands_in_space(a) && a.nearest.distance_m > 0;
       }},
      {"less than to the nearest point", Fault::not_tight, 1,
       [](const P&, Answer& a) {
         a.nearest.distance_m -= 1e-3;
         return stands_in_space(a);
       }},
      {"another direction", Fault::not_tight, 1,
       [](const P&, Answer& a) {
         a.nearest.direction_world = -a.nearest.direction_world;
         return stands_in_space(a);
       }},
      {"another place on the axis", Fault::not_tight, 1,
       [](const P&, Answer& a) {
         a.on_axis_world += Vector3d(0.01, 0.01, 0.01);
         return stands_in_space(a);
       }},
      {"more than rho", Fault::implausible, 1,
       [](const P& p, Answer& a) {
         a.nearest.distance_m = p.settings.rho_m + 1e-6;
         return stands_in_space(a);
       }},
      {"stale or not", Fault::implausible, 1,
       [](const P&, Answer& a) {
         a.nearest.stale = !a.nearest.stale;
         return true;
       }},
      {"no distance", Fault::implausible, 1,
       [](const P&, Answer& a) {
         const bool suits = a.nearest.distance_m >= 0;
         a.nearest.distance_m = kNaN;
         return suits && a.nearest.state != ProximityState::outside;
       }},
      {"a border elsewhere", Fault::implausible, 1,
       [](const P&, Answer& a) {
         const bool suits = a.nearest.state != ProximityState::outside;
         a.nearest.known_to_m = std::isnan(a.nearest.known_to_m) ? 1.0 : a.nearest.known_to_m + 0.01;
         return suits;
       }},
      {"nothing near and yet a nearest point", Fault::implausible, 1,
       [](const P&, Answer& a) {
         const bool suits = stands_in_space(a);
         a.nearest.state = ProximityState::beyond_rho;
         return suits;
       }},
      {"not evaluated and yet a distance", Fault::implausible, 1,
       [](const P&, Answer& a) {
         const bool suits = stands_in_space(a);
         a.nearest.state = ProximityState::not_evaluated;
         return suits;
       }},
      {"measured by nobody", Fault::implausible, 1,
       [](const P&, Answer& a) {
         a.nearest.camera.reset();
         return stands_in_space(a) && a.nearest.state == ProximityState::measured;
       }},
      {"a surface that is said to be unseen", Fault::implausible, 0.8,
       [](const P&, Answer& a) {
         a.nearest.camera.reset();
         return set_state(a, ProximityState::measured, ProximityState::unobserved);
       }},
      {"a shadow that is said to be unseen", Fault::implausible, 0.8,
       [](const P&, Answer& a) { return set_state(a, ProximityState::occluded, ProximityState::unobserved); }},
      {"unseen space that is said to be a surface", Fault::implausible, 0.8,
       [](const P&, Answer& a) {
         a.nearest.camera = 0;
         return set_state(a, ProximityState::unobserved, ProximityState::measured);
       }},
  };
  return all;
}

TEST(AnswerCheck, FindsNothingInRightAnswers) {
  for_answers([](const SearchProblem& problem, const Capsule& asked, const Answer& answer) {
    const AnswerCheck check(problem);
    EXPECT_FALSE(check.form(asked, answer)) << check.form(asked, answer)->what;
    EXPECT_FALSE(check.soundness(asked, answer).finding);
  });
}

TEST(AnswerCheck, FindsWhatIsWrong) {
  std::vector<std::int64_t> spoilt(spoils().size());
  std::vector<std::int64_t> found(spoils().size());
  for_answers([&](const SearchProblem& problem, const Capsule& asked, const Answer& right) {
    const AnswerCheck check(problem);
    for (std::size_t i = 0; i < spoils().size(); ++i) {
      Answer wrong = right;
      if (!spoils()[i].spoil(problem, wrong)) {
        continue;
      }
      const auto finding =
          spoils()[i].fault == Fault::over_estimate ? check.soundness(asked, wrong).finding : check.form(asked, wrong);
      ++spoilt[i];
      found[i] += finding && finding->fault == spoils()[i].fault ? 1 : 0;
    }
  });
  const bool many = test::random_run(15).count >= 15;
  for (std::size_t i = 0; i < spoils().size(); ++i) {
    const Spoil& spoil = spoils()[i];
    const auto least = static_cast<std::int64_t>(spoil.share * static_cast<double>(spoilt[i]));
    EXPECT_GE(found[i], least) << spoil.what << ": " << to_string(spoil.fault) << " of " << spoilt[i];
    EXPECT_TRUE(spoilt[i] > 0 || !many) << spoil.what << ": no answer to try it with";
  }
}

// An oracle that may hardly look says what it could not prove.
TEST(AnswerCheck, SaysWhereItCouldNotDecide) {
  std::int64_t undecided = 0;
  for_answers([&](const SearchProblem& problem, const Capsule& asked, const Answer& answer) {
    if (!stands_in_space(answer)) {
      return;
    }
    const AnswerCheck::Soundness found = AnswerCheck(problem, 1).soundness(asked, answer);
    const bool proven = found.proven_m >= answer.nearest.distance_m - kProvenM - 1e-9;
    EXPECT_EQ(found.finding.has_value(), !proven) << "proven " << found.proven_m << " m";
    EXPECT_TRUE(!found.finding || found.finding->fault == Fault::undecided) << found.finding->what;
    undecided += found.finding ? 1 : 0;
  });
  EXPECT_GT(undecided, 0);
}

/// One camera whose readings of 1 m, less their margin, are 0.99 m away, and a robot that begins somewhere there.
struct BesideTheRobot {
  static constexpr int kSize = 24;
  std::vector<float> depth_m = std::vector<float>(kSize * kSize, 1.0F);
  std::vector<float> near_m;
  std::vector<float> far_m = std::vector<float>(kSize * kSize, 1.3F);
  SearchProblem problem;

  explicit BesideTheRobot(float robot_near_m) : near_m(kSize * kSize, robot_near_m) {
    SensorMargin margin;
    margin.constant_m = 0.01;
    margin.lateral_px = 0;
    RigCamera camera;
    camera.id = "only";
    camera.intrinsics = {kSize, kSize, 20, 20, 11.5, 11.5};
    camera.rule.near_m = 0.2;
    camera.rule.far_m = 5;
    problem.rig.cameras = {camera};
    CameraMargins margins;
    margins.sensor = margin;
    margins.smallest_obstacle_m = 0;
    problem.settings.margins = {margins};
    problem.settings.space = views::BoxSpace{{-0.4, -0.4, 0.3}, {0.4, 0.4, 1.6}};
    problem.settings.policies = {.unobserved = views::Policy::ignored,
                                 .outside = views::Policy::ignored,
                                 .robot_pockets = views::Policy::obstacle};
    problem.settings.rho_m = 0.5;
    problem.settings.resolution_m = 0.005;
    problem.settings.v_max_m_s = 0;
    Frame frame;
    frame.depth = depth_view(std::span<const float>(depth_m), kSize, kSize);
    frame.time_s = 1;
    frame.robot.near_m = near_m.data();
    frame.robot.far_m = far_m.data();
    frame.robot.stride_px = kSize;
    problem.frames = {frame};
    problem.problem.cameras = {{camera.intrinsics, camera.T_world_camera, camera.rule, frame, margin, PoseMargin{}}};
    problem.problem.space = WorldBox{{-0.4, -0.4, 0.3}, {0.4, 0.4, 1.6}};
    problem.problem.uncovered = Policy::ignored;
    problem.problem.rho_m = 0.5;
    problem.oracle = std::make_unique<Reference>(problem.problem);
    problem.primitives = {Capsule::point({0, 0, 0.8})};
  }
};

// The search says that something may stand in the sliver before the robot; in double precision there is none. Neither
// is wrong, and the answer is the nearer.
TEST(AnswerCheck, TakesATieOfRoundingsForTight) {
  const BesideTheRobot tie(std::nextafter(0.99F, 0.0F));
  const Answer answer = SearchRun(tie.problem).distances().front();
  ASSERT_NEAR(answer.nearest.distance_m, 0.19, 0.006) << "the search takes the reading for the robot: no tie";
  EXPECT_GT(tie.problem.oracle->distance(Vector3d(0, 0, 0.8)).lo_m, 0.3) << "the oracle does not: no tie";
  const AnswerCheck check(tie.problem);
  EXPECT_FALSE(check.form(tie.problem.primitives.front(), answer))
      << check.form(tie.problem.primitives.front(), answer)->what;
}

TEST(AnswerCheck, TakesNothingButATieForOne) {
  const BesideTheRobot tie(std::nextafter(0.99F, 0.0F));
  const Answer answer = SearchRun(tie.problem).distances().front();
  const BesideTheRobot clear(0.98999F);  // a hundredth of a millimetre: the reading shows the robot to whoever looks
  const AnswerCheck check(clear.problem);
  const auto finding = check.form(clear.problem.primitives.front(), answer);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->fault, Fault::not_tight);
}

}  // namespace
}  // namespace depthgrid::reference
