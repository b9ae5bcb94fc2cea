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

}  // namespace
}  // namespace depthgrid::files
