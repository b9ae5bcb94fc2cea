// The avoidance experiments in small: what they claim, that runs repeat, that a campaign can be cut off.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "files/temporary_folder.hpp"
#include "lab/experiments/campaign/campaign.hpp"
#include "lab/experiments/campaign/campaign_motions.hpp"
#include "lab/experiments/campaign/campaign_totals.hpp"
#include "lab/experiments/campaign/plate_scene.hpp"
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

TEST(AvoidanceRig, MarginsAreThoseOfItsOwnFocalLength) {
  const Rig full = avoidance_rig(2, 640, "realsense_d435");
  const Rig quarter = avoidance_rig(2, 160, "realsense_d435");
  ASSERT_EQ(quarter.cameras.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const RigCamera& camera = quarter.cameras[k];
    EXPECT_EQ(camera.intrinsics.width_px, 160);
    EXPECT_EQ(camera.intrinsics.height_px, 120);
    ASSERT_TRUE(camera.margins && full.cameras[k].margins);
    // Noise of a disparity costs z^2 / (f b): a quarter of the focal length, four times the margin.
    EXPECT_NEAR(camera.margins->sensor.quadratic_per_m, 4 * full.cameras[k].margins->sensor.quadratic_per_m, 1e-9);
  }
}

TEST(Avoidance, WithNobodyThereNoMethodTakesLonger) {
  const robot::RobotModel model = robot::kuka_lwr4();
  RunSettings settings;
  settings.common = small_images();
  settings.duration_s = 4;  // one lap
  const double alone = run_avoidance(Method::none, model, nobody(4), settings).summary.task_share;
  EXPECT_GT(alone, 6);
  for (const Method method : kMethods) {
    const RunResult result = run_avoidance(method, model, nobody(4), settings);
    EXPECT_GE(1.02 * result.summary.task_share, alone) << title(method);
    EXPECT_TRUE(std::isinf(result.summary.smallest_person_m));
    EXPECT_TRUE(result.summary.contacts.empty());
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
  EXPECT_EQ(first.summary.task_share, second.summary.task_share);
}

/// A person who stands: a capsule along y.
AvoidanceMotion standing_at(const Eigen::Vector3d& p_world) {
  AvoidanceMotion motion;
  motion.name = "standing";
  motion.duration_s = 4;
  motion.at = [p_world](double) {
    const Eigen::Vector3d half(0, 0.3, 0);
    return MovingSolids{{{p_world - half, p_world + half, 0.04}}, {}};
  };
  return motion;
}

TEST(Avoidance, ContactsAtTheStartAreNobodysDoing) {
  const robot::RobotModel model = robot::kuka_lwr4();
  RunSettings settings;
  settings.common = small_images();
  settings.duration_s = 1;
  const AvoidanceMotion motion = standing_at(hexagon_centre_world(model));
  const RunResult run = run_avoidance(Method::none, model, motion, settings);
  ASSERT_FALSE(run.summary.contacts.empty());
  EXPECT_EQ(run.summary.contacts[0].time_s, 0);
  EXPECT_EQ(run.summary.contacts[0].cause, ContactCause::touched_from_the_start);
  CampaignState state;
  state.motions[0] = {motion.name, 0, {{Method::none, run.summary}}};
  state.motions[0].runs[Method::none].contacts.resize(1);
  EXPECT_TRUE(contacts_caused(state, Method::none).empty());
}

TEST(Avoidance, AnArmThatDoesNotAvoidComesAndGoesOn) {
  const robot::RobotModel model = robot::kuka_lwr4();
  RunSettings settings;
  settings.common = small_images();
  settings.duration_s = 4;
  const auto vertices = hexagon(model).vertices_world;
  const Eigen::Vector3d lowest_world =
      *std::min_element(vertices.begin(), vertices.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
  const RunResult run = run_avoidance(Method::none, model, standing_at(lowest_world), settings);
  ASSERT_FALSE(run.summary.contacts.empty());
  const Contact& contact = run.summary.contacts[0];
  EXPECT_GT(contact.time_s, 0);
  EXPECT_EQ(contact.cause, ContactCause::robot_came);
  EXPECT_TRUE(caused_by_the_robot(contact.cause));
  EXPECT_GT(contact.robot_m_s, kStanding_m_s);
  EXPECT_NEAR(contact.person_m_s, 0, 0.05);
  ASSERT_TRUE(contact.fastest_during_m_s);
  EXPECT_GT(*contact.fastest_during_m_s, kStanding_m_s);
}

TEST(Campaign, TellsScriptsAndRecordingsApart) {
  const auto outcome = [](const std::string& name, double letter, double own) {
    MotionOutcome result{name, 1, {}};
    result.runs[Method::letter_two].task_share = letter;
    result.runs[Method::search].task_share = own;
    return result;
  };
  CampaignState state;
  state.motions[0] = outcome("walk_in 1", 10, 8);
  state.motions[1] = outcome("reach 2", 10, 5);
  state.motions[2] = outcome("mocap 02_06 3", 2, 0.5);
  state.motions[3] = outcome("mocap 02_06 4", 0.5, 0.5);
  const TimeBesideLetter all = time_beside_letter(state, Method::search, Motions::all);
  EXPECT_EQ(all.motions, 4);
  EXPECT_NEAR(all.ratio, 22.5 / 14, 1e-12);
  EXPECT_EQ(all.above_wanted, 2);
  const TimeBesideLetter scripts = time_beside_letter(state, Method::search, Motions::scripts);
  EXPECT_EQ(scripts.motions, 2);
  EXPECT_NEAR(scripts.ratio, 20.0 / 13, 1e-12);
  EXPECT_EQ(scripts.below_one_vertex, 0);
  const TimeBesideLetter recordings = time_beside_letter(state, Method::search, Motions::recordings);
  EXPECT_EQ(recordings.motions, 2);
  EXPECT_NEAR(recordings.ratio, 2.5, 1e-12);
  EXPECT_EQ(recordings.above_wanted, 1);
  EXPECT_EQ(recordings.below_one_vertex, 2);
  EXPECT_EQ(recordings.letter_below_vertex, 1);
}

TEST(CampaignFile, KeepsContacts) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "state.json";
  CampaignState state{{{"seed", 1}}, {}};
  for (const Method method : kMethods) {
    state.motions[0].runs[method];
  }
  Contact begun;
  begun.cause = ContactCause::touched_from_the_start;
  Contact later{.time_s = 1.5, .link = 6, .robot_m_s = 0.02, .person_m_s = 1, .told_m = 0.1, .really_m = 0.01};
  later.fastest_during_m_s = 0.03;
  RunSummary& kept = state.motions[0].runs[Method::search];
  kept.contacts = {begun, later};
  kept.compared = 7;
  kept.stopped_s = 0.25;
  write_campaign_state(file, state);
  const CampaignState read = read_campaign_state(file, state.settings);
  const std::vector<Contact>& contacts = read.motions.at(0).runs.at(Method::search).contacts;
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_EQ(contacts[0].cause, ContactCause::touched_from_the_start);
  EXPECT_FALSE(contacts[0].told_m || contacts[0].fastest_during_m_s);
  EXPECT_EQ(contacts[1].link, 6U);
  EXPECT_EQ(read.motions.at(0).runs.at(Method::search).compared, 7);
  EXPECT_EQ(read.motions.at(0).runs.at(Method::search).stopped_s, 0.25);
  EXPECT_TRUE(std::isinf(read.motions.at(0).runs.at(Method::search).smallest_person_m)) << "nobody came";
  EXPECT_EQ(contacts[1].told_m, 0.1);
  EXPECT_EQ(contacts[1].fastest_during_m_s, 0.03);
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
  EXPECT_TRUE(contacts_caused(state, Method::search).empty()) << random.reproduce();
  EXPECT_TRUE(contacts_caused(state, Method::search_pockets).empty()) << random.reproduce();
  if (random.count >= kEnough) {
    EXPECT_GT(none.with_contact, 0) << "motions that touch nothing show nothing";
    EXPECT_GT(search.compared, 1000);
    EXPECT_GT(search.median_smallest_m, none.median_smallest_m);
  }
}

TEST(CampaignFile, GoesOnWhereItWasCutOff) {
  CampaignPlan plan = small_campaign(1);
  plan.duration_s = 0.5;
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "state.json";
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

TEST(CampaignFile, WithARealSensorHoldsTheMemorysRunsBesideTheIdealOnes) {
  CampaignPlan plan = small_campaign(1);
  plan.duration_s = 0.3;
  const nlohmann::ordered_json ideal = settings_of(plan, false);
  plan.with_memory = sensor_settings("realsense_d435", 96);
  const nlohmann::ordered_json settings = settings_of(plan, false);
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "state.json";
  const CampaignState first = run(plan, file, read_campaign_state(file, settings));
  const CampaignState read = read_campaign_state(file, settings);
  ASSERT_EQ(read.motions.size(), 1U);
  EXPECT_EQ(read.motions.at(0).runs.size(), 3U);
  EXPECT_EQ(read.motions.at(0).runs.at(Method::search_memory).task_share,
            first.motions.at(0).runs.at(Method::search_memory).task_share);
  EXPECT_THAT(test::thrown_message([&] { (void)read_campaign_state(file, ideal); }),
              HasSubstr("belongs to another campaign, with with_memory"));
}

TEST(CampaignFile, RefusesWhatDoesNotBelongToIt) {
  CampaignPlan plan = small_campaign(1);
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "state.json";
  write_campaign_state(file, {settings_of(plan, false), {}});
  const auto refused = [&](const CampaignPlan& other) {
    return test::thrown_message([&] { (void)read_campaign_state(file, settings_of(other, false)); });
  };
  EXPECT_EQ(refused(plan), "");
  CampaignPlan other = plan;
  other.seed = 2;
  EXPECT_EQ(refused(other), file.string() + ": belongs to another campaign, with seed " + std::to_string(plan.seed) +
                                " instead of 2; give another --out");
  for (double AvoidanceSettings::*setting :
       {&AvoidanceSettings::period_s, &AvoidanceSettings::frame_latency_s, &AvoidanceSettings::rho_m,
        &AvoidanceSettings::repulsion_m_s, &AvoidanceSettings::v_max_m_s, &AvoidanceSettings::ignored_pocket_m,
        &AvoidanceSettings::resolution_m, &AvoidanceSettings::approach_gain_per_s, &AvoidanceSettings::approach_stop_m,
        &AvoidanceSettings::removal_padding_m}) {
    other = plan;
    other.common.*setting *= 2;
    EXPECT_THAT(refused(other), HasSubstr("belongs to another campaign, with ")) << settings_of(other, false).dump();
  }
  EXPECT_TRUE(settings_of(plan, false).contains("program"));
  std::ofstream(file) << "{\"campaign\": ";
  EXPECT_THAT(test::thrown_message([&] { (void)read_campaign_state(file, settings_of(plan, false)); }),
              HasSubstr("state.json: is no state of a campaign"));
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  EXPECT_THAT(refused(plan), HasSubstr("state.json: is no file"));
}

}  // namespace
}  // namespace depthgrid::experiments
