// A running cell is recorded: what is in the file, what is not, and what happens when it cannot be written.
#include "depthgrid/monitor/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/files/mcap_reader.hpp"
#include "depthgrid/files/recording.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/monitor/open_cell.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "files/temporary_folder.hpp"
#include "monitor/small_cell.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::monitor {
namespace {

using ::testing::HasSubstr;

struct Recorded {
  MonitorReport report;
  std::vector<std::string> log;
};

Recorded record(const std::filesystem::path& file, double seconds) {
  cell::Cell cell = cell::parse_cell(test::small_cell(), "small.yaml");
  cell.outputs.record = file;
  const cell::CellSetup setup = cell::setup(cell);
  Monitor monitor(setup, monitor_settings(cell), make_sources(cell, setup, nullptr));
  monitor.record(recorder(cell, setup, monitor.names()));
  monitor.start();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  monitor.stop();
  Recorded result;
  result.report = monitor.report();
  for (const Event& event : monitor.events()) {
    result.log.push_back(event_line(event, monitor.names()));
  }
  return result;
}

std::vector<messages::Distances> answers_of(files::McapReader& reader) {
  std::vector<messages::Distances> answers;
  for (const files::McapEntry& entry : reader.entries(reader.channel("/distances")->id)) {
    answers.push_back(messages::from_bytes<messages::Distances>(reader.read(entry).data));
  }
  return answers;
}

TEST(Recorder, EverythingIsInTheFile) {
  const test::TemporaryFolder folder;
  const Recorded recorded = record(folder / "run.mcap", 1.5);
  const RecorderCounts& counts = *recorded.report.recorded;
  EXPECT_FALSE(counts.failed);
  EXPECT_EQ(counts.answers + counts.dropped_answers, recorded.report.answers);
  EXPECT_EQ(counts.joint_states + counts.dropped_joint_states,
            static_cast<std::uint64_t>(recorded.report.joints.taken));
  files::McapReader reader(folder / "run.mcap");
  EXPECT_EQ(reader.damage(), "");
  const auto& told = reader.metadata().at("depthgrid");
  EXPECT_EQ(told.at("cell"), test::small_cell());
  EXPECT_THAT(told.at("cell_file"), HasSubstr("small.yaml"));
  std::map<std::string, std::size_t> sizes;
  for (const files::McapChannel& channel : reader.channels()) {
    sizes[channel.topic] = reader.entries(channel.id).size();
  }
  EXPECT_EQ(sizes.at("/front/depth/image_raw") + sizes.at("/back/depth/image_raw"), counts.images);
  EXPECT_EQ(sizes.at("/front/depth/camera_info"), sizes.at("/front/depth/image_raw"));
  EXPECT_EQ(sizes.at("/joint_states"), counts.joint_states);
  EXPECT_EQ(sizes.at("/distances"), counts.answers);
  EXPECT_EQ(sizes.at("/tf_static"), 1U);
  EXPECT_GE(sizes.at("/events"), 3U) << "two cameras and the joints were opened";
  // What an answer stands on is in the file.
  std::set<std::int64_t> images;
  for (const files::McapEntry& entry : reader.entries(reader.channel("/front/depth/image_raw")->id)) {
    images.insert(messages::nanoseconds(messages::from_bytes<messages::Image>(reader.read(entry).data).header.stamp));
  }
  const std::vector<messages::Distances> answers = answers_of(reader);
  const messages::Distances& last = answers.back();
  ASSERT_EQ(last.image_stamps.size(), 2U);
  EXPECT_TRUE(images.contains(messages::nanoseconds(last.image_stamps[0])));
  EXPECT_GT(messages::nanoseconds(last.image_joint_stamps.at(0)), 0);
  EXPECT_LE(messages::nanoseconds(last.image_joint_stamps.at(0)), messages::nanoseconds(last.joint_stamp));
  EXPECT_EQ(last.sequence, recorded.report.answers);
  EXPECT_NEAR(messages::seconds(last.header.stamp) - messages::seconds(last.image_stamps[0]), last.image_ages[0], 1e-6);
}

TEST(Recorder, OthersFindCamerasAndPlacesInIt) {
  const test::TemporaryFolder folder;
  (void)record(folder / "run.mcap", 1.0);
  files::RecordingOptions options;
  options.mcap.tolerance_s = 0.05;
  files::Recording recording(folder / "run.mcap", options);
  ASSERT_EQ(recording.rig().cameras.size(), 2U);
  const std::size_t front = recording.rig().cameras[0].id == "front" ? 0 : 1;
  EXPECT_TRUE(recording.rig().cameras[front].T_world_camera.translation().isApprox(Eigen::Vector3d(2.3, -1.6, 1.4)));
  EXPECT_GT(recording.frame_count(), 5);
}

TEST(Recorder, ACutFileIsReadUpToThereWithWhatItsAnswersStandOn) {
  const test::TemporaryFolder folder;
  (void)record(folder / "run.mcap", 2.5);
  const auto size = std::filesystem::file_size(folder / "run.mcap");
  for (const double part : {0.3, 0.6, 0.95}) {
    std::filesystem::copy_file(folder / "run.mcap", folder / "cut.mcap",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(folder / "cut.mcap", static_cast<std::uintmax_t>(part * static_cast<double>(size)));
    files::McapReader reader(folder / "cut.mcap");
    EXPECT_NE(reader.damage(), "");
    EXPECT_EQ(reader.metadata().at("depthgrid").at("cell"), test::small_cell());
    std::set<std::int64_t> images;
    for (const files::McapEntry& entry : reader.entries(reader.channel("/front/depth/image_raw")->id)) {
      images.insert(static_cast<std::int64_t>(entry.log_time_ns));
    }
    std::size_t with_image = 0;
    for (const messages::Distances& answer : answers_of(reader)) {
      const std::int64_t stamp = messages::nanoseconds(answer.image_stamps.at(0));
      EXPECT_TRUE(stamp == 0 || images.contains(stamp));
      with_image += stamp != 0 ? 1 : 0;
    }
    EXPECT_TRUE(part < 0.5 || with_image > 0) << "nothing was looked at";
  }
}

TEST(Recorder, NothingIsWrittenOver) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("run.mcap", "mine");
  EXPECT_THAT(test::thrown_message([&] { (void)record(file, 0); }),
              HasSubstr("run.mcap: is there already, and is not written over: choose another name"));
  EXPECT_EQ(std::filesystem::file_size(file), 4U);
  EXPECT_NE(test::thrown_message([&] { (void)record(folder / "nowhere" / "run.mcap", 0); }), "");
  (void)record(folder / "run-{time}.mcap", 0);
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    found += entry.path().filename().string().starts_with("run-20") ? 1 : 0;
  }
  EXPECT_EQ(found, 1);
}

TEST(Recorder, ADiskThatIsFullIsToldAndTheCellRunsOn) {
  const test::TemporaryFolder folder;
  // As of a full disk: no file of this process becomes larger.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  (void)std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = 60'000, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const Recorded recorded = record(folder / "run.mcap", 4);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_TRUE(recorded.report.recorded->failed);
  EXPECT_GT(recorded.report.recorded->dropped_answers, 0U);
  EXPECT_EQ(recorded.report.recorded->answers + recorded.report.recorded->dropped_answers, recorded.report.answers);
  EXPECT_THAT(recorded.log, ::testing::Contains(::testing::AllOf(
                                HasSubstr("recording: "), HasSubstr("run.mcap: cannot be written: File too large"),
                                HasSubstr("; nothing more is recorded"))));
  files::McapReader reader(folder / "run.mcap");
  EXPECT_EQ(reader.metadata().at("depthgrid").at("cell"), test::small_cell());
}

TEST(Recorder, OfOneThatCannotBeginNothingIsLeft) {
  const test::TemporaryFolder folder;
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  (void)std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = 100, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string why = test::thrown_message([&] { (void)record(folder / "run.mcap", 0); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_THAT(why, HasSubstr("run.mcap: cannot be written"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run.mcap"));
}

TEST(Recorder, ACameraWhoseNameIsNoTopicsIsRefused) {
  const test::TemporaryFolder folder;
  RecorderSettings settings;
  settings.file = folder / "run.mcap";
  settings.rig.cameras.resize(1);
  settings.rig.cameras[0].id = "left eye";
  EXPECT_THAT(test::thrown_message([&] { (void)Recorder(settings); }), HasSubstr("camera 'left eye': its name cannot"));
  EXPECT_FALSE(std::filesystem::exists(settings.file));
}

}  // namespace
}  // namespace depthgrid::monitor
