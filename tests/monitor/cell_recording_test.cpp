// A running cell is recorded, and its answers are asked again: the same to the bit, or it is said why not.
#include "depthgrid/monitor/cell_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/files/mcap_writer.hpp"
#include "depthgrid/monitor/open_cell.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "files/temporary_folder.hpp"
#include "monitor/faulty_source.hpp"
#include "monitor/small_cell.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::monitor {
namespace {

using ::testing::HasSubstr;

/// Says of another source's images that they come from elsewhere each time.
class MovingCamera final : public sensors::DepthSource {
 public:
  MovingCamera(std::unique_ptr<sensors::DepthSource> source, const Pose& about)
      : source_(std::move(source)), about_(about) {}
  void open() override { source_->open(); }
  void close() noexcept override { source_->close(); }
  [[nodiscard]] const sensors::SourceInfo& info() const noexcept override { return source_->info(); }
  [[nodiscard]] std::string_view reason() const noexcept override { return source_->reason(); }
  [[nodiscard]] sensors::Reading next(sensors::DepthReading& reading, double longest_s) noexcept override {
    const sensors::Reading result = source_->next(reading, longest_s);
    const double turn_rad = 0.03 * std::sin(3.0 * reading.time_s);
    reading.T_world_camera = about_ * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d(0.1, 0.7, 0.2).normalized());
    return result;
  }

 private:
  std::unique_ptr<sensors::DepthSource> source_;
  Pose about_;
};

struct Options {
  double seconds = 1.5;
  bool moves = false;
  test::Fault fault = test::Fault::none;  ///< of the first camera, in the second half
  bool from_the_start = false;            ///< and in the first
};

void record(const std::filesystem::path& file, const std::string& text, const Options& options = {}) {
  cell::Cell cell = cell::parse_cell(text, "small.yaml");
  cell.outputs.record = file;
  const cell::CellSetup setup = cell::setup(cell);
  Sources sources = make_sources(cell, setup, nullptr);
  std::atomic<test::Fault> fault{options.from_the_start ? options.fault : test::Fault::none};
  if (options.moves) {
    sources.cameras[1] =
        std::make_unique<MovingCamera>(std::move(sources.cameras[1]), setup.rig.cameras[1].T_world_camera);
  }
  sources.cameras[0] = std::make_unique<test::FaultyCamera>(std::move(sources.cameras[0]), fault);
  Monitor monitor(setup, monitor_settings(cell), std::move(sources));
  monitor.record(recorder(cell, setup, monitor.names()));
  monitor.start();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds / 2));
  fault = options.fault;
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds / 2));
  monitor.stop();
}

AskedAgain asked(const std::filesystem::path& file) {
  CellRecording recording(file);
  const cell::Cell cell = recording.cell();
  return recording.ask_again(cell, cell::setup(cell));
}

TEST(CellRecording, EveryAnswerIsTheSameToTheBit) {
  const test::TemporaryFolder folder;
  record(folder / "run.mcap", test::small_cell(), {.seconds = 3});
  const AskedAgain again = asked(folder / "run.mcap");
  EXPECT_GT(again.equal, 20U);
  EXPECT_EQ(again.differ, 0U) << again.first_difference;
  EXPECT_EQ(again.without_images + again.without_joints, 0U);
  EXPECT_EQ(again.equal, again.answers);
  EXPECT_EQ(CellRecording(folder / "run.mcap").damage(), "");
}

TEST(CellRecording, ACameraThatMovesIsWhereItWas) {
  const test::TemporaryFolder folder;
  record(folder / "run.mcap", test::small_cell(), {.seconds = 2, .moves = true});
  const AskedAgain again = asked(folder / "run.mcap");
  EXPECT_EQ(again.differ, 0U) << again.first_difference;
  EXPECT_GT(again.equal, 20U);
  EXPECT_EQ(again.equal, again.answers);
  EXPECT_THAT(test::thrown_message([&] { (void)CellRecording(folder / "run.mcap").played(); }),
              HasSubstr("camera 'back' moves, and only cameras that stand are played"));
}

TEST(CellRecording, ACameraThatFailedIsBlindAgain) {
  for (const test::Fault fault : {test::Fault::wrong_size, test::Fault::black, test::Fault::drop}) {
    const test::TemporaryFolder folder;
    record(folder / "run.mcap", test::small_cell(), {.seconds = 2, .fault = fault});
    const AskedAgain again = asked(folder / "run.mcap");
    EXPECT_EQ(again.differ, 0U) << test::name_of(fault) << ": " << again.first_difference;
    EXPECT_GT(again.equal, 20U) << test::name_of(fault);
    EXPECT_EQ(again.equal, again.answers) << test::name_of(fault);
  }
}

TEST(CellRecording, AnotherCellAnswersDifferently) {
  const test::TemporaryFolder folder;
  record(folder / "run.mcap", test::small_cell());
  CellRecording recording(folder / "run.mcap");
  cell::Cell cell = recording.cell();
  cell.robot->padding_m += 0.01;
  cell.v_max_m_s += 0.1;
  std::size_t heard = 0;
  const AskedAgain again = recording.ask_again(
      cell, cell::setup(cell), [&](const messages::Distances&, const messages::Distances&) { ++heard; });
  EXPECT_GT(again.differ, 0U);
  EXPECT_EQ(heard, again.differ + again.equal);
  EXPECT_THAT(again.first_difference, HasSubstr(" m, recorded "));
  cell.ask.points.clear();
  EXPECT_THAT(test::thrown_message([&] { (void)recording.ask_again(cell, cell::setup(cell)); }),
              HasSubstr("it is not the one that was recorded"));
}

TEST(CellRecording, OfACutFileWhatIsThereIsTheSame) {
  const test::TemporaryFolder folder;
  record(folder / "run.mcap", test::small_cell(), {.seconds = 3});
  std::filesystem::resize_file(folder / "run.mcap", std::filesystem::file_size(folder / "run.mcap") * 7 / 10);
  EXPECT_NE(CellRecording(folder / "run.mcap").damage(), "");
  const AskedAgain again = asked(folder / "run.mcap");
  EXPECT_EQ(again.differ, 0U) << again.first_difference;
  EXPECT_GT(again.equal, 0U);
  EXPECT_EQ(again.equal, again.answers);
}

TEST(CellRecording, WhatCannotBeAskedSaysWhy) {
  const test::TemporaryFolder folder;
  {
    files::McapWriter writer(folder / "other.mcap");
    writer.close();
  }
  EXPECT_THAT(test::thrown_message([&] { (void)asked(folder / "other.mcap"); }),
              HasSubstr("other.mcap: holds no cell: depthgrid run --record makes such recordings. Of others, name"));
  std::string text = test::small_cell();
  text.replace(text.find("memory: none"), 12, "memory: {start: unknown}");
  text.replace(text.find("robot_pockets: ignored, ignored_pocket_m: 0.1"), 45, "robot_pockets: obstacle");
  record(folder / "memory.mcap", text, {.seconds = 0.2});
  EXPECT_THAT(test::thrown_message([&] { (void)asked(folder / "memory.mcap"); }),
              HasSubstr("memory.mcap: the cell has a memory"));
}

TEST(CellRecording, AnotherCalibrationIsRefused) {
  const test::TemporaryFolder folder;
  const auto write_rig = [&](const char* z) {
    (void)folder.write("rig.json", std::string(R"({"name": "r", "cameras": [{"id": "front", "width": 96, "height": 72,
      "fx": 75, "fy": 75, "cx": 47.5, "cy": 35.5, "metres_per_unit": 0.001, "sensor": "ideal",
      "T_world_cam": [[1,0,0,0],[0,1,0,0],[0,0,1,)") +
                                       z + "],[0,0,0,1]]}]}");
  };
  write_rig("-2");
  std::string text = test::small_cell();
  const std::size_t at = text.find("    intrinsics:");
  text.replace(at, text.find("    sensor:", at) - at, "    rig: " + (folder / "rig.json").string() + "\n");
  record(folder / "run.mcap", text, {.seconds = 0.2});
  EXPECT_EQ(CellRecording(folder / "run.mcap").cell().cameras.size(), 2U);
  EXPECT_TRUE(CellRecording(folder / "run.mcap").played().cameras[0].rig_file.empty()) << "as recorded";
  write_rig("-2.01");
  EXPECT_THAT(test::thrown_message([&] { (void)CellRecording(folder / "run.mcap").cell(); }),
              HasSubstr("rig.json states now"));
}

TEST(CellRecording, ACameraThatGaveNoImageIsBlindAgain) {
  const test::TemporaryFolder folder;
  record(folder / "run.mcap", test::small_cell(), {.fault = test::Fault::drop, .from_the_start = true});
  const CellRecording recording(folder / "run.mcap");
  const cell::Cell cell = recording.played();
  EXPECT_TRUE(cell.cameras[0].is_silent);
  EXPECT_FALSE(cell.cameras[1].is_silent);
  const cell::CellSetup setup = cell::setup(recording.cell());
  Sources sources = make_sources(cell, setup, nullptr);
  sensors::DepthReading reading;
  sources.cameras[0]->open();
  EXPECT_EQ(sources.cameras[0]->next(reading, 0), sensors::Reading::ended);
}

TEST(CellRecording, ItIsPlayedInPlaceOfItsCamerasAndJoints) {
  const test::TemporaryFolder folder;
  record(folder / "run.mcap", test::small_cell(), {.seconds = 2});
  const CellRecording recording(folder / "run.mcap");
  const cell::Cell cell = recording.played();
  const cell::CellSetup setup = cell::setup(recording.cell());
  Monitor monitor(setup, monitor_settings(cell), make_sources(cell, setup, nullptr));
  monitor.start();
  CellAnswer answer;
  bool knew = false;
  const double end_s = sensors::clock_now_s() + 20;
  const auto has_ended = [&] {
    return answer.camera_count == 2 && answer.cameras[0].state == CameraState::ended &&
           answer.cameras[1].state == CameraState::ended;
  };
  while (!has_ended() && sensors::clock_now_s() < end_s) {
    (void)monitor.newest(answer);
    knew = knew || std::isfinite(answer.distance_m);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  monitor.stop();
  EXPECT_TRUE(has_ended());
  EXPECT_TRUE(knew) << "images and joints were of one time";
  EXPECT_GT(monitor.report().cameras[0].taken, 10);
  EXPECT_GT(monitor.report().joints.taken, 100);
}

}  // namespace
}  // namespace depthgrid::monitor
