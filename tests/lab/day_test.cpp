// A day in the life: what is planned, what devices send, the truth, and that every broken rule is found.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "files/temporary_folder.hpp"
#include "lab/day/day_cell.hpp"
#include "lab/day/day_check.hpp"
#include "lab/day/faulty_messages.hpp"
#include "lab/day/running_truth.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::lab {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(FaultPlan, IsTheSameForTheSameSeedAndLeavesTimeToRecover) {
  constexpr double kLong_s = 3600;
  const std::vector<PlannedFault> plan = random_faults({"front", "back"}, kLong_s, 7);
  const std::vector<PlannedFault> again = random_faults({"front", "back"}, kLong_s, 7);
  const std::vector<PlannedFault> other = random_faults({"front", "back"}, kLong_s, 8);
  ASSERT_EQ(plan.size(), again.size());
  EXPECT_TRUE(std::equal(plan.begin(), plan.end(), again.begin(), [](const auto& a, const auto& b) {
    return a.device == b.device && a.fault == b.fault && a.begin_s == b.begin_s && a.end_s == b.end_s;
  }));
  EXPECT_NE(plan.front().begin_s, other.front().begin_s);
  for (const std::string device : {"front", "back", "joints"}) {
    std::set<DeviceFault> kinds;
    double before_s = 0;
    std::size_t at_once = 0;
    for (const PlannedFault& fault : plan) {
      if (fault.device != device) {
        continue;
      }
      EXPECT_GE(fault.begin_s, before_s + 3) << device;
      before_s = fault.end_s;
      kinds.insert(fault.fault);
      at_once += std::any_of(plan.begin(), plan.end(), [&](const PlannedFault& beside) {
        return beside.device != device && beside.fault != DeviceFault::network && beside.begin_s < fault.end_s &&
               fault.begin_s < beside.end_s;
      });
    }
    EXPECT_EQ(kinds.size(), device == "joints" ? kDeviceFaults.size() - 2 : kDeviceFaults.size()) << device;
    EXPECT_GT(at_once, 100U) << "faults come together";
    EXPECT_LT(before_s, kLong_s - 2.99);
  }
}

TEST(FaultPlan, IsReadBack) {
  const test::TemporaryFolder folder;
  const DayPlan plan{.begin_s = 12.5,
                     .seconds = 60,
                     .image_rate_hz = 20,
                     .joint_rate_hz = 100,
                     .faults = random_faults({"front"}, 60, 1)};
  write_plan(folder / "plan.json", plan);
  const DayPlan read = read_plan(folder / "plan.json");
  EXPECT_EQ(read.begin_s, plan.begin_s);
  EXPECT_EQ(read.image_rate_hz, plan.image_rate_hz);
  ASSERT_EQ(read.faults.size(), plan.faults.size());
  EXPECT_EQ(read.faults.back().device, plan.faults.back().device);
  EXPECT_EQ(read.faults.back().fault, plan.faults.back().fault);
  EXPECT_EQ(read.faults.back().end_s, plan.faults.back().end_s);
}

DeviceMessage image(double time_s, std::uint16_t value) {
  return {time_s, 2, 2, std::vector<std::uint16_t>(4, value), {}};
}

std::vector<double> times(const std::vector<DeviceMessage>& messages) {
  std::vector<double> result;
  for (const DeviceMessage& message : messages) {
    result.push_back(message.time_s);
  }
  return result;
}

TEST(FaultyMessages, SendsWhatTheFaultSays) {
  FaultyMessages device(0.5);
  EXPECT_THAT(times(device.pass(image(1, 10), std::nullopt, 1)), ElementsAre(1));
  EXPECT_THAT(times(device.pass(image(2, 20), DeviceFault::drop, 2)), IsEmpty());
  EXPECT_THAT(times(device.pass(image(3, 30), DeviceFault::duplicate, 3)), ElementsAre(3, 3));
  EXPECT_THAT(times(device.pass(image(4, 40), DeviceFault::reorder, 4)), IsEmpty());
  EXPECT_THAT(times(device.pass(image(5, 50), DeviceFault::reorder, 5)), ElementsAre(5, 4));
  EXPECT_THAT(times(device.pass(image(6, 60), DeviceFault::delay, 6)), IsEmpty());
  EXPECT_THAT(times(device.pass(image(6.4, 60), DeviceFault::delay, 6.4)), IsEmpty());
  EXPECT_THAT(times(device.pass(image(6.6, 60), DeviceFault::delay, 6.6)), ElementsAre(6));
  const auto frozen = device.pass(image(7, 70), DeviceFault::freeze, 7);
  ASSERT_THAT(times(frozen), ElementsAre(7));
  EXPECT_EQ(frozen[0].units[0], 10) << "of the last image without fault";
  EXPECT_THAT(device.pass(image(8, 80), DeviceFault::black, 8)[0].units, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(device.pass(image(9, 90), DeviceFault::wrong_size, 9)[0].height_px, 1);
  EXPECT_THAT(times(device.pass(image(10, 1), DeviceFault::fast_clock, 10)), ElementsAre(3610));
  EXPECT_THAT(times(device.pass(image(11, 1), DeviceFault::slow_clock, 11)), ElementsAre(-3589));
  EXPECT_THAT(times(device.pass(image(12, 1), std::nullopt, 12)), ElementsAre(12)) << "what was held back is gone";
}

/// A cell of two cameras, and answers of it that break no rule.
struct Day {
  cell::Cell cell = cell::parse_cell(day_cell({.cameras = 2}), "day.yaml");
  cell::CellSetup setup = cell::setup(cell);
  DayPlan plan{.begin_s = 100, .seconds = 14, .faults = {}};

  [[nodiscard]] std::shared_ptr<const sensors::SimulatedCell> simulated() const {
    return std::make_shared<const sensors::SimulatedCell>(
        sensors::SimulatedCellSettings{.robot = setup.robot, .person = true, .seed = 1, .begin_s = plan.begin_s});
  }
};

bool is_within(const DayPlan& plan, const std::string& device, double time_s) {
  return std::any_of(plan.faults.begin(), plan.faults.end(), [&](const PlannedFault& fault) {
    return fault.device == device && hides(fault.fault) && fault.begin_s <= time_s && time_s < fault.end_s;
  });
}

/// Of the newest message at a time, of so many a second.
double newest_s(const DayPlan& plan, const std::string& device, double time_s, double rate_hz) {
  double n = std::floor(time_s * rate_hz);
  while (is_within(plan, device, n / rate_hz)) {
    --n;
  }
  return n / rate_hz;
}

/// What changes an answer before it is written. `truth_m`: of each part.
using Change = std::function<void(double time_s, const std::vector<double>& truth_m, Json& answer)>;

std::string answers_of(const Day& day, const Change& change) {
  constexpr double kRate_hz = 25;
  RunningTruth truth(day.cell, day.setup, day.simulated());
  std::string text;
  for (double time_s = 1; time_s < day.plan.seconds; time_s += 1 / kRate_hz) {
    const double joints_age_s = time_s - newest_s(day.plan, "joints", time_s, 200);
    const bool known = joints_age_s <= day.cell.ages.joints_s;
    Json answer;
    answer["time_s"] = day.plan.begin_s + time_s;
    answer["stop"] = !known;
    answer["state"] = known ? "obstacle" : "no joint state";
    answer["blind_m"] = 0.05;
    answer["latency_s"] = 0.02;
    answer["exposure_s"] = day.plan.begin_s + newest_s(day.plan, "back", time_s, 15);
    answer["joints_age_s"] = joints_age_s;
    for (const auto& camera : day.cell.cameras) {
      const double age_s = time_s - newest_s(day.plan, camera.name, time_s, 15);
      answer["cameras"].push_back({{"state", "live"}, {"age_s", age_s}, {"late", age_s > day.cell.ages.image_s}});
    }
    std::vector<double> truth_m;
    for (std::size_t i = 0; i < day.setup.parts.size(); ++i) {
      truth_m.push_back(truth.distance_m(i, time_s));
      answer["parts"].push_back(
          {{"distance_m", known ? Json(std::min(day.cell.ask.rho_m, std::max(0.0, truth_m.back() - 0.01))) : Json()}});
    }
    change(time_s, truth_m, answer);
    text += answer.dump() + "\n";
  }
  return text;
}

DayReport checked(const Day& day, const Change& change, const std::string& memory = "") {
  std::istringstream answers(answers_of(day, change));
  std::istringstream sizes(memory);
  return check_day({.cell = day.cell, .setup = day.setup, .plan = day.plan}, answers, sizes);
}

void nothing(double /*time_s*/, const std::vector<double>& /*truth_m*/, Json& /*answer*/) {}

Day faulty_day() {
  Day day;
  day.plan.faults = {{"front", DeviceFault::freeze, 3, 5}, {"joints", DeviceFault::drop, 7, 8}};
  return day;
}

TEST(DayCheck, FindsNothingWhereNoRuleIsBroken) {
  const DayReport report = checked(faulty_day(), nothing);
  EXPECT_THAT(report.failures(), IsEmpty()) << testing::PrintToString(report.findings);
  EXPECT_GT(report.compared, 1000U);
  EXPECT_GT(report.blind, 10U);
  ASSERT_EQ(report.rows.size(), 2U);
  EXPECT_EQ(report.rows[0].of, "camera");
  EXPECT_NEAR(report.rows[0].noticed_s.median(), 0.3, 0.1);
  EXPECT_LE(report.rows[0].missed_s.median(), 1);
  EXPECT_NEAR(report.rows[1].noticed_s.median(), 0.05, 0.05);
  EXPECT_THAT(to_markdown(report), HasSubstr("| joints | drop | 1 | "));
}

TEST(DayCheck, FindsAnOverEstimate) {
  std::size_t changed = 0;
  const DayReport report = checked(faulty_day(), [&](double time_s, const auto& truth_m, Json& answer) {
    // No image counts, so that none can have hidden what is nearest in the robot's layer, or behind it.
    if (time_s > 8.5 && changed < 5 && truth_m[0] > 0.3 && truth_m[0] < 2) {
      answer["parts"][0]["distance_m"] = truth_m[0] + 0.05;
      answer["cameras"][0]["late"] = true;
      answer["cameras"][1]["late"] = true;
      ++changed;
    }
  });
  ASSERT_GT(changed, 0U);
  EXPECT_EQ(report.over_estimates, changed);
  EXPECT_NEAR(report.largest_excess_m, 0.05, 1e-3);
  EXPECT_THAT(report.failures(), ElementsAre(HasSubstr("distances are more than the truth, by up to 0.0500 m")));
}

// With live images: what is excused is only what lies within the robot's layer, or hidden right behind it.
TEST(DayCheck, ExcusesNoOverEstimateFarFromTheRobot) {
  std::size_t changed = 0;
  const DayReport report = checked(faulty_day(), [&](double time_s, const auto& truth_m, Json& answer) {
    if (time_s > 8.5 && changed < 5 && truth_m[0] > 0.3 && truth_m[0] < 2) {
      answer["blind_m"] = 0;
      answer["parts"][0]["distance_m"] = truth_m[0] + 0.05;
      ++changed;
    }
  });
  ASSERT_GT(changed, 0U);
  EXPECT_EQ(report.over_estimates, changed);
  EXPECT_EQ(report.unclaimed, 0U);
}

TEST(DayCheck, FindsAFrozenImageThatIsUsed) {
  const DayReport report = checked(faulty_day(), [](double time_s, const auto& /*truth_m*/, Json& answer) {
    if (time_s > 3.5 && time_s < 4) {
      answer["cameras"][0]["age_s"] = 0.01;
      answer["cameras"][0]["late"] = false;
    }
  });
  EXPECT_GT(report.hidden_used, 5U);
  EXPECT_GT(report.not_told, 0U);
  ASSERT_FALSE(report.findings.empty());
  EXPECT_THAT(report.findings.front(), HasSubstr("front: an image is used that is none: freeze"));
}

TEST(DayCheck, FindsAMomentThatIsNotStopped) {
  const DayReport report = checked(faulty_day(), [](double time_s, const auto& /*truth_m*/, Json& answer) {
    if (time_s > 7.5 && time_s < 7.7) {
      answer["stop"] = false;
      answer["state"] = "obstacle";
    }
  });
  EXPECT_GT(report.not_stopped, 0U);
  EXPECT_THAT(report.failures(), ElementsAre(HasSubstr("answers do not say stop though nothing is known")));
}

TEST(DayCheck, FindsADeviceThatDoesNotComeBack) {
  const DayReport report = checked(faulty_day(), [](double time_s, const auto& /*truth_m*/, Json& answer) {
    if (time_s > 5) {
      answer["cameras"][0]["age_s"] = time_s - 3;
      answer["cameras"][0]["late"] = true;
    }
  });
  EXPECT_THAT(report.failures(), ElementsAre(HasSubstr("1 times a device was not used again")));
}

TEST(DayCheck, FindsMemoryThatGrows) {
  std::string flat;
  std::string growing;
  for (int n = 0; n < 100; ++n) {
    flat += std::to_string(n) + " " + std::to_string(30000 + n % 7) + "\n";
    growing += std::to_string(n) + " " + std::to_string(30000 + 200 * n) + "\n";
  }
  EXPECT_THAT(checked(faulty_day(), nothing, flat).failures(), IsEmpty());
  const DayReport report = checked(faulty_day(), nothing, growing);
  EXPECT_THAT(report.failures(), ElementsAre(HasSubstr("the memory grew by 9.8 MB")));
  EXPECT_NEAR(report.memory_mb_per_hour, 3600 * 200 / 1024.0, 1);
}

TEST(DayCheck, NamesALineThatIsNone) {
  const Day day = faulty_day();
  std::istringstream answers("{\"time_s\": 1}\n");
  std::istringstream memory;
  EXPECT_THAT(test::thrown_message(
                  [&] { (void)check_day({.cell = day.cell, .setup = day.setup, .plan = day.plan}, answers, memory); }),
              HasSubstr("answers: line 1 is none of this cell"));
}

// The whole room, so that nothing is cut off: the scene's own distances, of points along the axis.
TEST(RunningTruth, IsTheDistanceOfTheNearestPointOfTheAxis) {
  Day day;
  day.cell.space = {Eigen::Vector3d::Constant(-20), Eigen::Vector3d::Constant(20)};
  const auto simulated = day.simulated();
  RunningTruth truth(day.cell, day.setup, simulated);
  // A person's hand is the nearest only while it is at the arm.
  for (double time_s = 0; time_s < 40; time_s += 0.35) {
    const simulation::Scene scene = simulated->scene_at(time_s);
    std::vector<double> q(simulated->joints());
    simulated->joints_at(time_s, q);
    const std::vector<Pose> T_world_link = day.setup.robot->link_poses(q);
    for (std::size_t i = 0; i < day.setup.parts.size(); ++i) {
      Capsule capsule;
      robot::place({&*day.setup.parts[i].on_robot, 1}, T_world_link, {&capsule, 1});
      double least_m = std::numeric_limits<double>::infinity();
      constexpr int kPoints = 400;
      for (int n = 0; n <= kPoints; ++n) {
        const Eigen::Vector3d p = capsule.a + (capsule.b - capsule.a) * n / kPoints;
        least_m = std::min(least_m, scene.distance(p).distance_m - capsule.radius_m);
      }
      EXPECT_NEAR(truth.distance_m(i, time_s), std::max(0.0, least_m), 1e-4) << time_s << " " << i;
    }
  }
}

TEST(RunningTruth, CutsOffWhatIsOutsideOfTheSpace) {
  Day day;
  const auto simulated = day.simulated();
  day.cell.space.low_world.z() = 0.25;  // the table and the workpiece lie below
  RunningTruth high(day.cell, day.setup, simulated);
  day.cell.space.low_world.z() = -0.4;
  RunningTruth all(day.cell, day.setup, simulated);
  bool is_ever_more = false;
  for (double time_s = 0; time_s < 6; time_s += 0.5) {
    for (std::size_t i = 0; i < day.setup.parts.size(); ++i) {
      EXPECT_GE(high.distance_m(i, time_s), all.distance_m(i, time_s) - 1e-6);
      is_ever_more = is_ever_more || high.distance_m(i, time_s) > all.distance_m(i, time_s) + 0.05;
    }
  }
  EXPECT_TRUE(is_ever_more);
}

}  // namespace
}  // namespace depthgrid::lab
