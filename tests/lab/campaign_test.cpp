// The campaign's book-keeping: nothing counts twice, nothing is lost, and a wrong answer is found.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

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
