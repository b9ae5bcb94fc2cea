#include "depthgrid/files/mcap_joints.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "depthgrid/files/mcap_writer.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "files/temporary_folder.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::files {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

messages::JointState state(std::int32_t sec, std::vector<std::string> names, std::vector<double> positions) {
  messages::JointState result;
  result.header.stamp = {.sec = sec, .nanosec = 500'000'000};
  result.name = std::move(names);
  result.position = std::move(positions);
  return result;
}

void write(const std::filesystem::path& file, const std::vector<messages::JointState>& states, bool twice = false) {
  McapWriter writer(file);
  const auto topic = writer.add_channel("/arm/joint_states", messages::type_of<messages::JointState>());
  if (twice) {
    (void)writer.add_channel("/joint_states", messages::type_of<messages::JointState>());
  }
  (void)writer.add_channel("/text", messages::type_of<messages::Text>());
  std::uint64_t time_ns = 0;
  for (const messages::JointState& each : states) {
    ++time_ns;
    writer.write(topic, time_ns, time_ns, messages::to_bytes(each));
  }
  writer.close();
}

const std::vector<std::string> kJoints{"a", "b"};

TEST(McapJoints, AreFoundByNamesInTheOrderOfTime) {
  const test::TemporaryFolder folder;
  write(folder / "run.mcap", {state(12, {"b", "a"}, {0.2, 0.1}), state(11, {"a", "b", "c"}, {0.3, 0.4, 0.5}),
                              state(11, {"finger"}, {9}), state(12, {"a", "b"}, {7, 7})});
  const JointTable table = load_mcap_joints(folder / "run.mcap", "", kJoints);
  EXPECT_THAT(table.time_s, ElementsAre(11.5, 12.5)) << "of one time the first";
  EXPECT_THAT(table.joints.at(0).values, ElementsAre(0.3, 0.1));
  EXPECT_THAT(table.joints.at(1).values, ElementsAre(0.4, 0.2));
  EXPECT_EQ(table.joints.at(1).unit, JointUnit::radians);
}

TEST(McapJoints, WhatIsMissingIsNamed) {
  const test::TemporaryFolder folder;
  const auto message = [&](const char* topic) {
    return test::thrown_message([&] { (void)load_mcap_joints(folder / "run.mcap", topic, kJoints); });
  };
  write(folder / "run.mcap", {state(1, {"a"}, {0.1})});
  EXPECT_THAT(message(""), HasSubstr("topic '/arm/joint_states': no state has all joints, for instance 'b'"));
  EXPECT_THAT(message("/text"),
              HasSubstr("has no joint states on topic '/text'; topics of sensor_msgs/JointState: /arm/"));
  write(folder / "run.mcap", {state(1, {"a", "b"}, {0.1})});
  EXPECT_THAT(message(""), HasSubstr("no state has all joints")) << "a position is missing";
  write(folder / "run.mcap", {}, true);
  EXPECT_THAT(message(""), HasSubstr("joint states on several topics, say which: /arm/joint_states, /joint_states"));
  EXPECT_THAT(message("/joint_states"), HasSubstr("has no messages"));
}

/// As a recorder that began anew in the middle: the same topic once more.
class TwoChannels {
 public:
  void record(std::uint8_t opcode, const std::string& contents) {
    bytes_ += static_cast<char>(opcode);
    number(contents.size(), 8);
    bytes_ += contents;
  }
  void number(std::uint64_t value, int size) { bytes_ += little(value, size); }
  static std::string little(std::uint64_t value, int size) {
    std::string bytes;
    for (int i = 0; i < size; ++i) {
      bytes += static_cast<char>(value >> (8 * i));
    }
    return bytes;
  }
  static std::string text(const std::string& words) { return little(words.size(), 4) + words; }
  void channel(std::uint16_t id) {
    record(4, little(id, 2) + little(1, 2) + text("/joint_states") + text("cdr") + little(0, 4));
  }
  void message(std::uint16_t id, std::uint64_t time_ns, const messages::JointState& joints) {
    const std::vector<std::byte> data = messages::to_bytes(joints);
    record(5, little(id, 2) + little(0, 4) + little(time_ns, 8) + little(time_ns, 8) +
                  std::string(reinterpret_cast<const char*>(data.data()), data.size()));
  }
  std::string bytes_ = "\x89MCAP0\r\n";
};

TEST(McapJoints, SeveralChannelsOfOneTopicCountAsOne) {
  const test::TemporaryFolder folder;
  TwoChannels file;
  file.record(1, TwoChannels::text("ros2") + TwoChannels::text("test"));
  file.record(3, TwoChannels::little(1, 2) + TwoChannels::text("sensor_msgs/msg/JointState") +
                     TwoChannels::text("ros2msg") + TwoChannels::text(""));
  file.channel(1);
  file.message(1, 1, state(11, {"a", "b"}, {1, 2}));
  file.channel(2);
  file.message(2, 2, state(12, {"a", "b"}, {3, 4}));
  (void)folder.write("two.mcap", file.bytes_);
  const JointTable table = load_mcap_joints(folder / "two.mcap", "", kJoints);
  EXPECT_THAT(table.joints.at(0).values, ElementsAre(1, 3));
}

}  // namespace
}  // namespace depthgrid::files
