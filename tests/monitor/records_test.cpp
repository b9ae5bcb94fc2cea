// What is kept of a running cell: the log of stops, and the numbers for Prometheus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <thread>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/monitor/open_cell.hpp"
#include "depthgrid/monitor/prometheus_text.hpp"
#include "depthgrid/monitor/stop_log.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "monitor/small_cell.hpp"

namespace depthgrid::monitor {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

TEST(StopLog, SaysEveryTermAndWhatTheySumUpTo) {
  Event event;
  event.time_s = sensors::clock_now_s();
  event.kind = EventKind::stop;
  event.reason.limit = avoidance::MotionLimit::obstacle;
  event.reason.part = 0;
  event.reason.distance_m = 0.131;
  event.reason.nearest.distance_m = 0.147;
  event.reason.nearest.state = ProximityState::measured;
  event.reason.nearest.camera = 0;
  event.reason.nearest.nearest_world = {0, 0, 2};
  event.reason.blind_m = 0.093;
  event.reason.stop_m = 0.05;
  event.reason.v_max_m_s = 1.6;
  event.reason.reaction_s = 0.01;
  event.reason.part_speed_m_s = 0.42;
  event.reason.part_motion_m = 0.004;
  StopLogSettings settings;
  settings.names = {.cell = "a", .cameras = {"left"}, .parts = {"hand"}};
  settings.rig.cameras.resize(1);
  CameraMargins& margins = settings.rig.cameras[0].margins.emplace();
  margins.sensor.constant_m = 0.01;
  margins.sensor.linear = 0.005;
  margins.translation_m = 0.003;
  margins.rotation_rad = 0.002;
  settings.stopping_s = 0.3;
  const std::string line = stop_log_line(event, settings);
  EXPECT_THAT(line,
              ContainsRegex("^20[0-9][0-9]-[01][0-9]-[0-3][0-9]T[0-9:]+[.][0-9][0-9][0-9]Z stop: hand is 0.131 m"));
  EXPECT_THAT(line, HasSubstr("limit 0.05 m beyond the layer: stops at 0.143 m"));
  EXPECT_THAT(line,
              HasSubstr(" | distance 0.131 m (0.147 m at the images' time); human at most 1.6 m/s; reaction 0.01 s; "
                        "stopping 0.3 s; robot 0.42 m/s, moved up to 0.004 m since its joint state; sensor 0.027 m; "
                        "stops at 0.143 m: blind layer 0.093 m + limit 0.05 m"));
  settings.moves = {true};
  EXPECT_THAT(stop_log_line(event, settings), HasSubstr("sensor ? m")) << "the rig says nothing of where it was";
  settings.moves.clear();
  event.reason.nearest.camera.reset();
  settings.stopping_s.reset();
  EXPECT_THAT(stop_log_line(event, settings), HasSubstr("stopping not stated, within the limit; robot"));
  EXPECT_THAT(stop_log_line(event, settings), HasSubstr("sensor ? m"));
}

TEST(Prometheus, TextIsWellFormedAndCounts) {
  const cell::Cell cell = cell::parse_cell(test::small_cell(), "small.yaml");
  const cell::CellSetup setup = cell::setup(cell);
  Monitor monitor(setup, monitor_settings(cell), make_sources(cell, setup, nullptr));
  monitor.start();
  CellAnswer answer;
  const double end_s = sensors::clock_now_s() + 20;
  while (!(std::isfinite(answer.distance_m) && std::isfinite(answer.reason.part_speed_m_s)) &&
         sensors::clock_now_s() < end_s) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    (void)monitor.newest(answer);
  }
  monitor.stop();
  EXPECT_LT(answer.reason.part_speed_m_s, 5);
  EXPECT_GE(answer.reason.part_motion_m, 0);
  const std::string text = prometheus_text(monitor, answer);
  std::istringstream lines(text);
  double answers = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_THAT(line, ::testing::MatchesRegex("# (HELP|TYPE) depthgrid_[a-z_]+ .+|"
                                              "depthgrid_[a-z_]+([{][^{}]*[}])? (NaN|[+-]Inf|[-+0-9.e]+)"));
    if (line.starts_with("depthgrid_answers_total{")) {
      answers += std::stod(line.substr(line.rfind(' ')));
    }
  }
  EXPECT_EQ(answers, static_cast<double>(monitor.report().answers));
  EXPECT_THAT(text, ContainsRegex("depthgrid_images_total[{]camera=\"front\",result=\"taken\"[}] [1-9]"));
  EXPECT_THAT(text, ContainsRegex("depthgrid_exposure_to_answer_seconds[{]quantile=\"0.999\"[}] [0-9]"));
  EXPECT_THAT(text, HasSubstr("# TYPE depthgrid_stop gauge\ndepthgrid_stop "));
  EXPECT_THAT(text, ContainsRegex("\ndepthgrid_answer_time_seconds [0-9.e+]+\n"));
  answer.stop = false;
  answer.cameras[0].state = CameraState::live;
  answer.cameras[0].late = false;
  const std::string live = prometheus_text(monitor, answer);
  EXPECT_THAT(live, HasSubstr("\ndepthgrid_stop 0\n"));
  EXPECT_THAT(live, HasSubstr("\ndepthgrid_camera_live{camera=\"front\"} 1\n"));
  const std::string ended = prometheus_text(monitor, answer, true);
  EXPECT_THAT(ended, HasSubstr("\ndepthgrid_stop 1\n")) << "nobody answers any more";
  EXPECT_THAT(ended, HasSubstr("\ndepthgrid_camera_live{camera=\"front\"} 0\n"));
  EXPECT_THAT(ended, HasSubstr("\ndepthgrid_distance_metres NaN\n"));
  EXPECT_THAT(prometheus_text(monitor, {}), HasSubstr("\ndepthgrid_answer_time_seconds NaN\n"));
}

}  // namespace
}  // namespace depthgrid::monitor
