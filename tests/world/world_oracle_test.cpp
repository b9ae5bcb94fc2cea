// A slice of the campaign of random worlds: no answer above the truth while the assumptions hold, and the oracle speaks
// up when they do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "support/random_run.hpp"
#include "world/play.hpp"

namespace depthgrid::world {
namespace {

/// Enough to find what is grossly wrong.
constexpr std::int64_t kFew = 6;

Tally played(const test::RandomRun& run, WorldOptions options, const std::function<void(Answer&)>& spoil = {}) {
  Tally tally;
  for (std::int64_t i = 0; i < run.count; ++i) {
    options.seed = run.seed + static_cast<std::uint64_t>(i);
    play(make_world(options), tally, spoil);
  }
  return tally;
}

test::RandomRun few_worlds() {
  test::RandomRun run = test::random_run(kFew);
  run.count = std::min(run.count, kFew);
  return run;
}

WorldOptions breaking(Broken broken) {
  WorldOptions options;
  options.broken = broken;
  return options;
}

/// Plays worlds that keep what is assumed.
void expect_sound(const test::RandomRun& run, const WorldOptions& options) {
  const Tally tally = played(run, options);
  for (const std::string& line : tally.lines) {
    ADD_FAILURE() << line << "; " << run.reproduce();
  }
  const Counts& all = tally.rows.at("all");
  EXPECT_EQ(all.above + all.above_now, 0);
  std::cout << all.worlds << " worlds, " << all.answers << " answers, " << all.in_layer
            << " above something in the blind layer; nothing within rho said in " << all.far_said << " of "
            << all.far_true << ", otherwise half of the answers reach " << all.median_ratio() << " of the truth\n";
}

TEST(WorldOracle, NoAnswerIsAboveTheTruth) { expect_sound(test::random_run(30), {}); }

TEST(WorldOracle, NorIsOneWithAMemory) {
  WorldOptions options;
  options.memory = true;
  expect_sound(test::random_run(10), options);
}

TEST(WorldOracle, NorIsOneWithADeclaredSmallestObstacle) {
  WorldOptions options;
  options.smallest = true;
  expect_sound(test::random_run(15), options);
  options.memory = true;
  expect_sound(test::random_run(5), options);
}

// An oracle that never fires is worth nothing.
TEST(WorldOracle, FindsReadingsBeyondTheirMargins) {
  const test::RandomRun run = few_worlds();
  const Counts all = played(run, breaking(Broken::readings)).rows.at("all");
  EXPECT_GT(all.above, 0) << run.reproduce();
  EXPECT_GT(all.largest_excess_m, 0.02) << run.reproduce();
}

TEST(WorldOracle, FindsACameraThatStandsElsewhere) {
  const test::RandomRun run = few_worlds();
  EXPECT_GT(played(run, breaking(Broken::pose)).rows.at("all").above, 0) << run.reproduce();
}

TEST(WorldOracle, FindsAnswersThatAreSpoilt) {
  test::RandomRun run = few_worlds();
  run.count = 2;
  const auto spoil = [](Answer& answer) { answer.nearest.distance_m += 0.3; };
  const Counts all = played(run, {}, spoil).rows.at("all");
  EXPECT_GT(all.above, all.answers / 4) << run.reproduce();
}

}  // namespace
}  // namespace depthgrid::world
