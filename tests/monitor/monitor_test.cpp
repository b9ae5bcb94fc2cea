// The simulated cell, running, with faults.
#include "depthgrid/monitor/monitor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/monitor/open_cell.hpp"
#include "depthgrid/network/datagram_writer.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/simulated_camera.hpp"
#include "depthgrid/sensors/simulated_joints.hpp"
#include "monitor/faulty_source.hpp"
#include "monitor/small_cell.hpp"

namespace depthgrid::monitor {
namespace {

using test::Fault;
using test::small_cell;
using ::testing::HasSubstr;

struct Running {
  explicit Running(const std::string& text = small_cell()) {
    const cell::Cell cell = cell::parse_cell(text, "small.yaml");
    const cell::CellSetup setup = cell::setup(cell);
    sensors::SimulatedCellSettings scene;
    scene.robot = setup.robot;
    const auto simulated = std::make_shared<const sensors::SimulatedCell>(scene);
    Sources sources;
    for (std::size_t k = 0; k < 2; ++k) {
      sources.cameras.push_back(std::make_unique<test::FaultyCamera>(
          std::make_unique<sensors::SimulatedCamera>(simulated, setup.rig.cameras[k], 20, k), faults.at(k)));
    }
    sources.joints =
        std::make_unique<test::FaultyJoints>(std::make_unique<sensors::SimulatedJoints>(simulated, 100), joint_fault);
    monitor.emplace(setup, monitor_settings(cell), std::move(sources));
    monitor->add(call([this](const CellAnswer& answer) {
      const std::lock_guard lock(mutex);
      newest = answer;
      if (answer.sequence <= last) {
        in_order = false;
      }
      last = answer.sequence;
    }));
  }

  CellAnswer answer() {
    const std::lock_guard lock(mutex);
    return newest;
  }
  std::string reason() {
    std::array<char, 640> buffer{};
    return std::string(sentence(answer().reason, monitor->names(), buffer));
  }
  /// False: not within that time.
  bool wait(const std::function<bool(const CellAnswer&)>& condition, double seconds = 20) {
    const double end_s = sensors::clock_now_s() + seconds;
    while (sensors::clock_now_s() < end_s) {
      if (condition(answer())) {
        return true;
      }
      for (const Event& event : monitor->events()) {
        log.push_back(event_line(event, monitor->names()));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  /// Both cameras are used, and the robot's place is known.
  bool is_well(double seconds = 20) {
    return wait(
        [](const CellAnswer& now) {
          return now.camera_count == 2 && !now.reason.camera && std::isfinite(now.distance_m);
        },
        seconds);
  }

  std::array<std::atomic<Fault>, 2> faults{Fault::none, Fault::none};
  std::atomic<Fault> joint_fault{Fault::none};
  std::mutex mutex;
  CellAnswer newest;
  std::uint64_t last = 0;
  bool in_order = true;
  std::vector<std::string> log;
  std::optional<Monitor> monitor;
};

TEST(Monitor, AnswersStandOnTheirImages) {
  Running cell;
  cell.monitor->start();
  ASSERT_TRUE(cell.is_well()) << cell.reason();
  const CellAnswer answer = cell.answer();
  EXPECT_EQ(answer.parts.size(), cell.monitor->names().parts.size());
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(answer.cameras.at(k).state, CameraState::live);
    EXPECT_GT(answer.cameras.at(k).age_s, 0);
    EXPECT_LE(answer.cameras.at(k).age_s, 0.35);
    EXPECT_GT(answer.cameras.at(k).without_reading, 0);
    EXPECT_LT(answer.cameras.at(k).without_reading, 1);
  }
  EXPECT_NEAR(answer.skew_s, std::abs(answer.cameras[0].age_s - answer.cameras[1].age_s), 1e-9);
  EXPECT_NEAR(answer.time_s - answer.exposure_s, std::min(answer.cameras[0].age_s, answer.cameras[1].age_s), 1e-9);
  EXPECT_LE(answer.exposure_s, answer.done_s);
  double least_m = std::numeric_limits<double>::infinity();
  for (const Answer& part : answer.parts) {
    least_m = std::min(least_m, part.distance_now_m);
  }
  EXPECT_EQ(answer.distance_m, least_m);
  const depthgrid_answer sent = datagram_answer(answer);
  EXPECT_EQ(sent.sequence, answer.sequence);
  EXPECT_EQ(sent.stop, answer.stop ? 1 : 0);
  EXPECT_LE(static_cast<double>(sent.distance_m), answer.distance_m);
  EXPECT_EQ(sent.state, static_cast<int>(answer.reason.limit));
  cell.monitor->stop();
  cell.monitor->stop();  // nothing more
  EXPECT_TRUE(cell.in_order);
  const MonitorReport report = cell.monitor->report();
  EXPECT_GT(report.answers, 0U);
  std::uint64_t of_states = 0;
  for (const std::uint64_t count : report.by_state) {
    of_states += count;
  }
  EXPECT_EQ(of_states, report.answers);
  EXPECT_GT(report.cameras[0].taken, 0);
  EXPECT_GT(report.joints.taken, 0);
}

/// What the reason has to say while one camera has the fault for good; "": the camera is not to be told.
const char* words_of(Fault fault) {
  switch (fault) {
    case Fault::drop:
      return "camera front is silent, its image is ";
    case Fault::delay:
    case Fault::wrong_clock:
    case Fault::slow_clock:
      return "camera front sends images of another time";
    case Fault::freeze:
      return "camera front repeats the same image";
    case Fault::black:
      return "camera front sees nothing: no pixel has a reading";
    case Fault::wrong_size:
      return "camera front sends images that cannot be used";
    case Fault::unplug:
      return "camera front is lost";
    default:
      return "";
  }
}

TEST(Monitor, EveryFaultIsToldAndEndsWithItsCause) {
  Running cell;
  cell.monitor->start();
  ASSERT_TRUE(cell.is_well()) << cell.reason();
  for (const Fault fault : test::kFaults) {
    const MonitorReport before = cell.monitor->report();
    cell.faults[0] = fault;
    const std::string words = words_of(fault);
    if (!words.empty()) {
      std::string said;
      EXPECT_TRUE(cell.wait([&](const CellAnswer&) { return (said = cell.reason()).find(words) != std::string::npos; }))
          << name_of(fault) << ": " << said;
    } else {  // the answers go on; it is counted
      EXPECT_TRUE(cell.wait([&](const CellAnswer&) {
        const SourceCounts now = cell.monitor->report().cameras[0];
        return fault == Fault::restart ? now.opened > before.cameras[0].opened
                                       : now.refused > before.cameras[0].refused;
      })) << name_of(fault);
    }
    EXPECT_EQ(cell.answer().cameras[1].state, CameraState::live) << name_of(fault) << ": the other goes on";
    cell.faults[0] = Fault::none;
    const double end_s = sensors::clock_now_s();
    ASSERT_TRUE(cell.is_well()) << name_of(fault) << ": " << cell.reason();
    ::testing::Test::RecordProperty(std::string("recovery_s_") + name_of(fault),
                                    std::to_string(sensors::clock_now_s() - end_s));
    EXPECT_TRUE(cell.wait([&](const CellAnswer& now) { return now.sequence > before.answers; }))
        << name_of(fault) << ": nothing is answered any more";
    const MonitorReport after = cell.monitor->report();
    if (fault == Fault::duplicate || fault == Fault::reorder || fault == Fault::freeze) {
      EXPECT_GT(after.cameras[0].refused, before.cameras[0].refused) << name_of(fault);
    }
    if (fault == Fault::unplug || fault == Fault::restart) {
      EXPECT_GT(after.cameras[0].opened, before.cameras[0].opened) << name_of(fault);
    }
  }
  cell.monitor->stop();
  EXPECT_TRUE(cell.in_order);
}

TEST(Monitor, ACameraThatIsLostFreesNothingAfterItsAge) {
  Running cell;
  cell.monitor->start();
  ASSERT_TRUE(cell.is_well()) << cell.reason();
  cell.faults[0] = Fault::unplug;
  cell.faults[1] = Fault::drop;
  ASSERT_TRUE(cell.wait([](const CellAnswer& now) { return now.reason.limit == avoidance::MotionLimit::no_images; }));
  const CellAnswer blind = cell.answer();
  EXPECT_TRUE(blind.stop);
  EXPECT_TRUE(blind.cameras[0].late);
  EXPECT_TRUE(blind.cameras[1].late);
  EXPECT_FALSE(std::isfinite(blind.exposure_s));
  EXPECT_THAT(cell.reason(), HasSubstr("no camera has a new image"));
  EXPECT_EQ(datagram_answer(blind).late_cameras, 3U);
  cell.faults[0] = cell.faults[1] = Fault::none;
  EXPECT_TRUE(cell.is_well()) << cell.reason();
}

TEST(Monitor, WithoutJointsNobodyKnowsWhereTheRobotIs) {
  Running cell;
  cell.monitor->start();
  ASSERT_TRUE(cell.is_well()) << cell.reason();
  for (const Fault fault : {Fault::drop, Fault::unplug, Fault::wrong_clock}) {
    cell.joint_fault = fault;
    ASSERT_TRUE(cell.wait([](const CellAnswer& now) {
      return now.reason.limit == avoidance::MotionLimit::no_joint_state;
    })) << name_of(fault);
    const CellAnswer lost = cell.answer();
    EXPECT_TRUE(lost.stop);
    EXPECT_TRUE(std::isnan(lost.distance_m));
    EXPECT_TRUE(std::isfinite(lost.parts.back().distance_now_m)) << "the point that stands still is answered";
    EXPECT_GT(lost.joints_age_s, 0.24);
    EXPECT_THAT(cell.reason(), HasSubstr("no joint state for "));
    cell.joint_fault = Fault::none;
    ASSERT_TRUE(cell.is_well()) << name_of(fault) << ": " << cell.reason();
  }
}

TEST(Monitor, AnOutputThatHangsHoldsUpNobody) {
  Running cell;
  std::atomic<int> taken{0};
  cell.monitor->add(call([&](const CellAnswer&) {
    ++taken;
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }));
  cell.monitor->add(call([](const CellAnswer&) -> void { throw std::runtime_error("broken"); }));
  cell.monitor->start();
  ASSERT_TRUE(cell.is_well()) << cell.reason();
  ASSERT_TRUE(cell.wait([](const CellAnswer& now) { return now.sequence > 60; }));
  cell.monitor->stop();
  const MonitorReport report = cell.monitor->report();
  EXPECT_GT(report.passed_over[1], 30U) << "the newest wins";
  EXPECT_LT(report.passed_over[0], report.passed_over[1]);
  EXPECT_LT(static_cast<std::uint64_t>(taken), report.answers / 2);
}

TEST(Monitor, EventsTellWhatHappened) {
  Running cell;
  cell.monitor->start();
  ASSERT_TRUE(cell.is_well()) << cell.reason();
  cell.faults[1] = Fault::unplug;
  ASSERT_TRUE(cell.wait([](const CellAnswer& now) { return now.cameras[1].late; }));
  cell.faults[1] = Fault::none;
  ASSERT_TRUE(cell.is_well()) << cell.reason();
  (void)cell.wait([](const CellAnswer&) { return false; }, 0.1);
  EXPECT_THAT(cell.log, ::testing::Contains(HasSubstr("front: open: simulated kinect_v1")));
  EXPECT_THAT(cell.log, ::testing::Contains(HasSubstr("back: the cable was pulled")));
  EXPECT_THAT(cell.log, ::testing::Contains(HasSubstr("back: no such device")));
  EXPECT_THAT(cell.log, ::testing::Contains(::testing::StartsWith("stop: ")));
}

TEST(Monitor, WhatDoesNotFitTogetherIsRefused) {
  const cell::Cell cell = cell::parse_cell(small_cell(), "small.yaml");
  const cell::CellSetup setup = cell::setup(cell);
  const auto refused = [&](auto&& change) {
    MonitorSettings settings = monitor_settings(cell);
    Sources sources = make_sources(cell, setup, nullptr);
    change(settings, sources);
    try {
      const Monitor monitor(setup, settings, std::move(sources));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_THAT(refused([](auto& settings, auto&) { settings.rate_hz = 0; }), HasSubstr("asks 0 times a second"));
  EXPECT_THAT(refused([](auto& settings, auto&) { settings.stop_m = -1; }), HasSubstr("stops at -1 m"));
  EXPECT_THAT(refused([](auto&, auto& sources) { sources.cameras.pop_back(); }), HasSubstr("1 sources for 2 cameras"));
  EXPECT_THAT(refused([](auto&, auto& sources) { sources.joints.reset(); }), HasSubstr("no source of its joints"));
  EXPECT_EQ(refused([](auto&, auto&) {}), "taken");
}

}  // namespace
}  // namespace depthgrid::monitor
