// The campaign's book-keeping: nothing counts twice, nothing is lost, and a wrong answer is found.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "lab/campaign/examination.hpp"
#include "lab/campaign/soundness_page.hpp"
#include "lab/campaign/state_file.hpp"
#include "reference/search_problem_run.hpp"

namespace depthgrid::lab {
namespace {

std::string read(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string in_folder(const std::string& name) { return (std::filesystem::path(testing::TempDir()) / name).string(); }

CampaignState examined(std::uint64_t first, std::uint64_t end) {
  CampaignState state;
  for (std::uint64_t seed = first; seed < end; ++seed) {
    examine(seed, "test", state.of_width(0));
  }
  return state;
}

/// What the file holds, less the time that it took.
std::string without_time(CampaignState state) {
  for (auto& [width_px, tally] : state.tallies) {
    tally.seconds = 0;
  }
  const std::string file = in_folder("campaign_without_time.json");
  write_state(file, state);
  return read(file);
}

TEST(SeedRanges, JoinAndRefuseToCountTwice) {
  SeedRanges seeds;
  seeds.add(5, 8);
  seeds.add(1, 3);
  EXPECT_EQ(seeds.next_missing(1), 3U);
  EXPECT_EQ(seeds.next_missing(4), 4U);
  EXPECT_EQ(seeds.next_missing(6), 8U);
  seeds.add(3, 5);
  EXPECT_EQ(seeds.ranges().size(), 1U);
  EXPECT_EQ(seeds.next_missing(1), 8U);
  EXPECT_EQ(seeds.count(0, 100), 7U);
  EXPECT_THROW(seeds.add(7, 9), Error);
  EXPECT_THROW(seeds.add(0, 2), Error);
}

TEST(LogHistogram, TellsQuantilesWithinABin) {
  LogHistogram histogram;
  for (int i = 1; i <= 1000; ++i) {
    histogram.add(1e-5 * i);
  }
  histogram.add(-1.0);
  EXPECT_EQ(histogram.count(), 1001);
  EXPECT_GE(histogram.quantile(0.5), 5.0e-3);
  EXPECT_LE(histogram.quantile(0.5), 5.0e-3 * 1.13);
  EXPECT_DOUBLE_EQ(histogram.maximum(), 1e-2);
  EXPECT_DOUBLE_EQ(histogram.quantile(1.0), 1e-2);
}

// Seeds 8 to 11: one with calls of a budget and directions is among them.
TEST(Campaign, ResumedOrMergedIsTheSameAsInOneGo) {
  const std::string whole = without_time(examined(8, 12));
  const std::string file = in_folder("campaign_part.json");
  write_state(file, examined(8, 10));
  CampaignState resumed = read_state(file);
  examine(resumed.of_width(0).seeds.next_missing(8), "test", resumed.of_width(0));
  examine(resumed.of_width(0).seeds.next_missing(8), "test", resumed.of_width(0));
  EXPECT_EQ(without_time(resumed), whole);
  CampaignState merged = examined(10, 12);
  merged.add(read_state(file));
  EXPECT_EQ(without_time(merged), whole);
  EXPECT_THROW(merged.add(read_state(file)), Error);
  EXPECT_THROW(static_cast<void>(read_state(in_folder("there_is_no_such_file.json"))), Error);
}

TEST(Campaign, AStateIsReadAsItIsWritten) {
  const std::string text = to_text(examined(1, 3));
  EXPECT_EQ(to_text(parse_state(text, "state")), text);
  EXPECT_TRUE(parse_state(R"({"campaign": []})", "state").tallies.empty());
}

/// One tally of one problem with two queries; `changes` replace what stands in it.
std::string small_state(const std::vector<std::pair<std::string, std::string>>& changes = {}) {
  std::string zeros = "0";
  for (int k = 1; k < LogHistogram::kBins; ++k) {
    zeros += ",0";
  }
  std::string text =
      R"({"campaign": [{"width_px": 0, "seconds": 1.5, "seeds": [[7, 8]], "queries_by_code": {"c": 2},)"
      R"("rows": {"all": {"problems": 1, "queries": 2, "over_estimate": 1, "undecided": 0, "not_tight": 0,)"
      R"("implausible": 0}}, "counts": {}, "lines": ["over_estimate, 7"], "shortfall_m": {"all": {"maximum": 0,)"
      R"("bins": [)" +
      zeros + R"(]}}, "shortfall_resolutions": {}}]})";
  for (const auto& [from, to] : changes) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string refusal(const std::string& text) {
  try {
    return "read, over-estimates " + std::to_string(parse_state(text, "state").of_width(0).faults(reference::Fault{}));
  } catch (const Error& error) {
    return error.what();
  }
}

// A state that lost something must not pass for one without faults.
TEST(Campaign, AStateThatIsNotWholeIsRefusedInOneLine) {
  const std::string is_none = "state: is no state of the campaign; one is written by --state";
  EXPECT_EQ(refusal(small_state()), "read, over-estimates 1");
  EXPECT_EQ(refusal(R"({"campaign":[{}]})"), is_none + ": [json.exception.out_of_range.403] key 'width_px' not found");
  EXPECT_EQ(refusal(R"({"campaign":null})"), is_none + ": 'null' must be a list");
  EXPECT_EQ(refusal(R"({"campaign":{}})"), is_none + ": '{}' must be a list");
  EXPECT_EQ(refusal(R"({"campaign":[7]})"), is_none + ": [json.exception.type_error.304] cannot use at() with number");
  EXPECT_EQ(refusal(R"([])"), is_none);
  EXPECT_EQ(refusal(R"({"campaign":[)"), is_none);
  const std::string no_row = is_none + ": the row \"all\" counts 0 problems of 1 seeds, one a seed is needed";
  EXPECT_EQ(refusal(small_state({{"\"all\"", "\"ale\""}})), no_row);
  EXPECT_EQ(refusal(small_state({{"\"problems\": 1", "\"problems\": 0"}})), no_row);
  EXPECT_EQ(refusal(small_state({{"[[7, 8]]", "[[7, 9]]"}})),
            is_none + ": the row \"all\" counts 1 problems of 2 seeds, one a seed is needed");
  const std::string whole_number = " must be a whole number from 0 to 1125899906842624";
  EXPECT_EQ(refusal(small_state({{"\"over_estimate\": 1", "\"over_estimate\": -1"}})), is_none + ": -1" + whole_number);
  EXPECT_EQ(refusal(small_state({{"\"over_estimate\": 1", "\"over_estimate\": 0.9"}})),
            is_none + ": 0.9" + whole_number);
  EXPECT_EQ(refusal(small_state({{"\"over_estimate\": 1", "\"over_estimate\": 1e30"}})),
            is_none + ": 1e+30" + whole_number);
  EXPECT_EQ(refusal(small_state({{"\"bins\": [0,", "\"bins\": ["}})),
            is_none + ": a histogram has 161 bins, must have 162");
  EXPECT_EQ(refusal(small_state({{"over_estimate, 7", "none"}})),
            is_none + ": line 'none' must be of the form \"KIND, PROBLEM\"");
  EXPECT_EQ(refusal(small_state({{"[[7, 8]]", "[[8, 7]]"}})),
            is_none + ": seeds [8,7] must be the first and the one after the last");
  const std::string one = small_state();
  EXPECT_EQ(refusal(one.substr(0, one.size() - 2) + "," + one.substr(one.find('[') + 1)),
            is_none + ": images of width 0 have two tallies, must have one");
  for (const char* bracket : {"[", "{\"a\":"}) {
    std::string nested = R"({"campaign":)";
    for (int k = 0; k < 200'000; ++k) {
      nested += bracket;
    }
    EXPECT_EQ(refusal(nested), "state: is nested deeper than 32 levels");
  }
}

TEST(Campaign, FindsWrongAnswers) {
  reference::RandomOptions options;
  options.seed = 1;
  const reference::SearchProblem problem = reference::make_search_problem(options, kQueriesPerProblem);
  std::vector<Answer> answers = reference::SearchRun(problem).distances();
  Tally right;
  examine_answers(problem, answers, right);
  EXPECT_EQ(right.faults(reference::Fault::over_estimate), 0);
  std::int64_t spoilt = 0;
  for (Answer& answer : answers) {
    if (answer.nearest.nearest_world.allFinite() && answer.nearest.distance_m > 0) {
      answer.nearest.distance_m += 0.1;
      ++spoilt;
    }
  }
  ASSERT_GT(spoilt, 20);
  Tally wrong;
  examine_answers(problem, answers, wrong);
  // A search may be short by more than that where shadows meet, but hardly ever.
  EXPECT_GE(wrong.faults(reference::Fault::over_estimate), spoilt * 9 / 10);
  EXPECT_EQ(wrong.rows.at("all").queries, kQueriesPerProblem);
  EXPECT_EQ(wrong.rows.at("points").queries + wrong.rows.at("spheres").queries + wrong.rows.at("capsules").queries,
            kQueriesPerProblem);
  EXPECT_FALSE(wrong.lines.empty());
}

/// A problem with its right answers, and one of them that has a nearest point at a distance.
struct Asked {
  reference::SearchProblem problem = reference::make_search_problem({}, kQueriesPerProblem);
  reference::SearchRun run{problem};
  std::vector<Answer> answers = run.distances();
  std::size_t one = 0;
  Asked() {
    while (!(answers.at(one).nearest.nearest_world.allFinite() && answers[one].nearest.distance_m > 0.05 &&
             answers[one].nearest.state == ProximityState::measured)) {
      ++one;
    }
  }
  [[nodiscard]] Proximity& spoilt() { return answers[one].nearest; }
};

/// How many of its faults the tally counts in the row of all answers and in that of its shape.
void expect_one(const Tally& tally, reference::Fault fault, const Asked& asked) {
  for (std::size_t i = 0; i < reference::kFaults; ++i) {
    const auto kind = static_cast<reference::Fault>(i);
    EXPECT_EQ(tally.faults(kind), kind == fault ? 1 : 0) << to_string(kind) << " of one " << to_string(fault);
  }
  const Capsule& capsule = asked.problem.primitives[asked.one];
  const char* const shape = capsule.a != capsule.b ? "capsules" : capsule.radius_m > 0 ? "spheres" : "points";
  EXPECT_EQ(tally.rows.at(shape).faults.at(static_cast<std::size_t>(fault)), 1);
  EXPECT_EQ(tally.lines.size(), 1U);
}

// Each kind of fault is counted once where there is one, in every kind of call.
TEST(Campaign, CountsOneFaultOfEachKind) {
  using reference::Fault;
  const std::vector<std::pair<Fault, std::function<void(Proximity&)>>> faults{
      {Fault::not_tight, [](Proximity& n) { n.direction_world = -n.direction_world; }},
      {Fault::implausible, [](Proximity& n) { n.camera.reset(); }}};
  for (const auto& [fault, spoil] : faults) {
    Asked asked;
    spoil(asked.spoilt());
    Tally tally;
    examine_answers(asked.problem, asked.answers, tally);
    expect_one(tally, fault, asked);
    EXPECT_FALSE(tally.is_unsound());
    Tally budget;
    examine_budget_answers(asked.problem, asked.answers, 10, budget);
    EXPECT_EQ(budget.counts.at(std::string("budget: ") + to_string(fault)), 1);
    EXPECT_EQ(budget.counts.at("budget: queries"), kQueriesPerProblem);
    EXPECT_EQ(budget.counts.at("budget: stopped"), 0);
  }
  Asked asked;
  asked.spoilt().distance_m = asked.problem.settings.rho_m;
  asked.spoilt().budget = true;  // then nothing but soundness is promised
  Tally tally;
  examine_answers(asked.problem, asked.answers, tally);
  expect_one(tally, Fault::over_estimate, asked);
  EXPECT_TRUE(tally.is_unsound());
  Tally budget;
  examine_budget_answers(asked.problem, asked.answers, 10, budget);
  EXPECT_EQ(budget.counts.at("budget: over_estimate"), 1);
  EXPECT_EQ(budget.counts.at("budget: stopped"), 1);
  EXPECT_TRUE(budget.is_unsound());
  CampaignState state;
  EXPECT_FALSE(state.is_unsound());
  state.of_width(0) = budget;
  EXPECT_TRUE(state.is_unsound());
}

TEST(Campaign, CountsAnAnswerThatDependsOnWhatWasAskedBefore) {
  Asked asked;
  const std::vector<Answer> fresh = asked.answers;
  Tally same;
  examine_later_answers(asked.problem, asked.run.distances_with_history(), fresh, same);
  EXPECT_EQ(same.counts.count("history: different"), 0U);
  const std::vector<std::function<void(Proximity&)>> changes{
      [](Proximity& n) { n.distance_m = std::nextafter(n.distance_m, 0.0); },
      [](Proximity& n) { n.state = ProximityState::occluded; },
      [](Proximity& n) { n.nearest_world.z() = std::nextafter(n.nearest_world.z(), 1e9); }};
  for (const auto& change : changes) {
    asked.answers = fresh;
    change(asked.spoilt());
    Tally tally;
    examine_later_answers(asked.problem, asked.answers, fresh, tally);
    EXPECT_EQ(tally.counts.at("history: different"), 1);
    EXPECT_EQ(tally.counts.at("history: queries"), kQueriesPerProblem);
    EXPECT_TRUE(tally.is_unsound());
  }
}

TEST(Campaign, CountsAWrongDirection) {
  Asked asked;
  const std::vector<Answer> right = reference::SearchRun(asked.problem).hybrid();
  Tally none;
  examine_directions(asked.problem, right, asked.answers, none);
  EXPECT_EQ(none.counts.count("direction: wrong"), 0U);
  const auto given = none.counts.at("direction: given");
  EXPECT_GT(given, 0);
  const std::vector<std::function<void(Answer&)>> changes{
      [](Answer& a) { a.hybrid_direction_world = -a.hybrid_direction_world; },
      [](Answer& a) { a.hybrid_direction_world *= 1.001; }, [](Answer& a) { a.nearest.distance_m += 1e-9; },
      [](Answer& a) { a.nearest.direction_world.setZero(); }};
  for (const auto& change : changes) {
    std::vector<Answer> wrong = right;
    change(wrong[asked.one]);
    Tally tally;
    examine_directions(asked.problem, wrong, asked.answers, tally);
    EXPECT_EQ(tally.counts.at("direction: wrong"), 1);
    EXPECT_EQ(tally.counts.at("direction: given"), given);
    EXPECT_EQ(tally.counts.at("direction: queries"), kQueriesPerProblem);
  }
}

TEST(Campaign, PutsItsTablesBetweenTheMarkers) {
  const std::string page = in_folder("campaign_page.md");
  std::ofstream(page) << "before\n" << kTablesBegin << "\nold\n" << kTablesEnd << "\nafter\n";
  write_tables(page, soundness_tables(examined(1, 2)));
  write_tables(page, soundness_tables(examined(1, 3)));
  const std::string text = read(page);
  EXPECT_EQ(text.rfind("before\n", 0), 0U);
  EXPECT_NE(text.find("| all | 2 | 128 | 0 | 0 |"), std::string::npos) << text;
  EXPECT_EQ(text.find("old"), std::string::npos);
  EXPECT_EQ(text.substr(text.size() - 6), "after\n");
  EXPECT_THROW(write_tables(in_folder("there_is_no_such_page.md"), ""), Error);
}

}  // namespace
}  // namespace depthgrid::lab
