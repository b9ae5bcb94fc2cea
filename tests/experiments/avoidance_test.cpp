// The avoidance experiments in small: what they claim, that runs repeat, that a campaign can be cut off.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "depthgrid/experiments/campaign_motions.hpp"
#include "depthgrid/experiments/campaign_report.hpp"
#include "depthgrid/experiments/plate_scene.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::experiments {
namespace {

using ::testing::HasSubstr;

AvoidanceSettings small_images() {
  AvoidanceSettings settings;
  settings.width_px = 96;
  return settings;
}

CampaignPlan small_campaign(int motions) {
  CampaignPlan plan;
  plan.motions = motions;
  plan.duration_s = 4;
  plan.common = small_images();
  return plan;
}

CampaignState run(const CampaignPlan& plan, const std::filesystem::path& file, CampaignState state) {
  run_motions(plan, file, state, [](std::size_t, std::size_t) {});
  return state;
}

TEST(Avoidance, WithNobodyThereNoMethodTakesLonger) {
  const robot::RobotModel model = robot::kuka_lwr4();
  RunSettings settings;
  settings.common = small_images();
  settings.duration_s = 4;  // one lap
  const double alone = run_avoidance(Method::none, model, nobody(4), settings).task_share;
  EXPECT_GT(alone, 6);
  for (const Method method : kMethods) {
    const RunResult result = run_avoidance(method, model, nobody(4), settings);
    EXPECT_GE(1.02 * result.task_share, alone) << title(method);
    EXPECT_TRUE(std::isinf(result.smallest_person_m));
    EXPECT_TRUE(result.contacts.empty());
  }
}

TEST(Avoidance, TheLettersMeanDirectionDrivesIntoTheHand) {
  const PlateScene letter = plate_scene(Method::letter_one, small_images());
  const PlateScene search = plate_scene(Method::search, small_images());
  EXPECT_GT(letter.fastest_towards_nearest_m_s, 0.3);
  EXPECT_GT(letter.fastest_towards_hand_m_s, 0.3);
  EXPECT_EQ(search.fastest_towards_nearest_m_s, 0);
  EXPECT_EQ(search.contacts, 0);
}

TEST(Avoidance, RunsRepeatToTheBit) {
  const robot::RobotModel model = robot::kuka_lwr4();
  const CampaignMotions motions(avoidance_rig(2, 96, "ideal"), 1, 2, {});
  RunSettings settings;
  settings.common = small_images();
  settings.duration_s = 2;
  settings.sample_every = 50;
  const RunResult first = run_avoidance(Method::search, model, motions.motion(2), settings);
  const RunResult second = run_avoidance(Method::search, model, motions.motion(2), settings);
  ASSERT_EQ(first.samples.size(), second.samples.size());
  for (std::size_t i = 0; i < first.samples.size(); ++i) {
    EXPECT_EQ(first.samples[i].q_rad, second.samples[i].q_rad);
    EXPECT_EQ(first.samples[i].told_m, second.samples[i].told_m);
  }
  EXPECT_EQ(first.task_share, second.task_share);
}

TEST(Campaign, TheSearchCausesNoContactAndHoldsNothingForTooFar) {
  constexpr int kEnough = 10;  // for motions that touch an arm that does not avoid
  const test::RandomRun random = test::random_run(kEnough);
  CampaignPlan plan = small_campaign(static_cast<int>(random.count));
  plan.seed = random.seed;
  const CampaignState state = run(plan, {}, {});
  ASSERT_EQ(state.motions.size(), static_cast<std::size_t>(random.count));
  const MethodTotals none = totals(state, Method::none, plan.duration_s);
  const MethodTotals search = totals(state, Method::search, plan.duration_s);
  EXPECT_EQ(search.over_estimates, 0) << search.largest_over_estimate_m << random.reproduce();
  EXPECT_TRUE(contacts_caused(state, Method::search, plan.common.v_max_m_s).empty()) << random.reproduce();
  EXPECT_TRUE(contacts_caused(state, Method::search_pockets, plan.common.v_max_m_s).empty()) << random.reproduce();
  if (random.count >= kEnough) {
    EXPECT_GT(none.with_contact, 0) << "motions that touch nothing show nothing";
    EXPECT_GT(search.watched, 1000);
    EXPECT_GT(search.median_smallest_m, none.median_smallest_m);
  }
}

class CampaignFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("depthgrid_campaign_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(CampaignFile, GoesOnWhereItWasCutOff) {
  CampaignPlan plan = small_campaign(1);
  plan.duration_s = 0.5;
  const std::filesystem::path file = folder_ / "state.json";
  const nlohmann::ordered_json settings = settings_of(plan, false);
  const CampaignState first = run(plan, file, read_campaign_state(file, settings));
  CampaignState read = read_campaign_state(file, settings);
  ASSERT_EQ(read.motions.size(), 1U);
  const RunSummary& before = first.motions.at(0).runs.at(Method::search);
  const RunSummary& after = read.motions.at(0).runs.at(Method::search);
  EXPECT_EQ(before.task_share, after.task_share);
  EXPECT_EQ(before.smallest_person_m, after.smallest_person_m);
  EXPECT_EQ(before.contacts.size(), after.contacts.size());

  // Only what is missing is run: a changed entry stays.
  read.motions.at(0).name = "already done";
  plan.motions = 2;
  const CampaignState second = run(plan, file, read);
  ASSERT_EQ(second.motions.size(), 2U);
  EXPECT_EQ(second.motions.at(0).name, "already done");
}

TEST_F(CampaignFile, RefusesWhatDoesNotBelongToIt) {
  CampaignPlan plan = small_campaign(1);
  const std::filesystem::path file = folder_ / "state.json";
  write_campaign_state(file, {settings_of(plan, false), {}});
  plan.seed = 2;
  EXPECT_THAT(test::thrown_message([&] { (void)read_campaign_state(file, settings_of(plan, false)); }),
              HasSubstr("state.json: belongs to a campaign with"));
  std::ofstream(file) << "{\"campaign\": ";
  EXPECT_THAT(test::thrown_message([&] { (void)read_campaign_state(file, settings_of(plan, false)); }),
              HasSubstr("state.json: is no state of a campaign"));
}

}  // namespace
}  // namespace depthgrid::experiments
