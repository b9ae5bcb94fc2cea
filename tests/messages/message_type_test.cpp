// Names, definitions and hashes of message types; the hashes are compared with another program's by messages_peer.
#include "depthgrid/messages/message_type.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string>

#include "depthgrid/core/whole_file.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::messages {
namespace {

TEST(MessageTypes, NamesFollowTheRulesOfRos) {
  std::set<std::string_view> hashes;
  for (const MessageType& type : message_types()) {
    const std::string name(type.name);
    const std::size_t slash = name.rfind('/');
    const std::string package = name.substr(0, name.find('/'));
    EXPECT_EQ(name.substr(0, slash), package + "/msg");
    EXPECT_EQ(type.dds_name, package + "::msg::dds_::" + name.substr(slash + 1) + "_");
    EXPECT_EQ(type.hash.substr(0, 7), "RIHS01_");
    EXPECT_EQ(type.hash.size(), 71U);
    EXPECT_EQ(type.hash.find_first_not_of("0123456789abcdef", 7), std::string_view::npos);
    EXPECT_TRUE(hashes.insert(type.hash).second) << name;
    EXPECT_EQ(&message_type(name), &type);
  }
  EXPECT_EQ(hashes.size(), 9U);
}

TEST(MessageTypes, EveryMessageHasItsOwn) {
  EXPECT_EQ(type_of<Image>().name, "sensor_msgs/msg/Image");
  EXPECT_EQ(type_of<Transforms>().dds_name, "tf2_msgs::msg::dds_::TFMessage_");
  EXPECT_EQ(type_of<Distances>().name, "depthgrid_msgs/msg/Distances");
  EXPECT_EQ(type_of<Text>().definition, "string data\n");
}

TEST(MessageTypes, StatesAreNumberedAsInTheDefinition) {
  const std::string text(type_of<Distances>().definition);
  for (int state = 0; state <= static_cast<int>(ProximityState::beyond_rho); ++state) {
    std::string name(to_string(static_cast<ProximityState>(state)));
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_THAT(text, ::testing::HasSubstr("uint8 " + name + "=" + std::to_string(state) + "\n"));
  }
}

/// The package that ROS users build says the same.
TEST(MessageTypes, OursAreThoseOfThePackage) {
  const std::string folder = std::string(DEPTHGRID_SOURCE) + "/ros2/depthgrid_msgs/msg/";
  const std::string text(type_of<Distances>().definition);
  const std::string distances = read_whole_file(folder + "Distances.msg", 10000);
  EXPECT_EQ(text.substr(0, distances.size()), distances);
  EXPECT_THAT(text, ::testing::HasSubstr("=\nMSG: depthgrid_msgs/Distance\n" +
                                         read_whole_file(folder + "Distance.msg", 10000) + "="));
}

TEST(MessageTypes, AnUnknownOneIsNamed) {
  EXPECT_THAT(test::thrown_message([] { static_cast<void>(message_type("a/msg/B")); }),
              ::testing::StartsWith("there is no message type 'a/msg/B' here, known are sensor_msgs/msg/Image, "));
}

TEST(DistancesMessage, HoldsTheAnswer) {
  Answer answer;
  answer.nearest.distance_m = 0.5;
  answer.nearest.state = ProximityState::measured;
  answer.nearest.nearest_world = {1, 2, 3};
  answer.nearest.direction_world = {0, 0, 1};
  answer.nearest.stale = true;
  answer.distance_now_m = 0.25;
  answer.blind_m = 0.1;
  Distances message;
  message.distances.push_back(distance_of(answer, "hand", "left", "a surface"));
  message.distances.push_back(distance_of({}, "elbow", ""));
  const Distances read = from_bytes<Distances>(to_bytes(message));
  EXPECT_EQ(read.distances[0].id, "hand");
  EXPECT_EQ(read.distances[0].distance, 0.5);
  EXPECT_EQ(read.distances[0].distance_now, 0.25);
  EXPECT_EQ(read.distances[0].state, static_cast<std::uint8_t>(ProximityState::measured));
  EXPECT_EQ(read.distances[0].nearest.z, 3);
  EXPECT_EQ(read.distances[0].direction.z, 1);
  EXPECT_EQ(read.distances[0].blind, 0.1);
  EXPECT_TRUE(read.distances[0].stale);
  EXPECT_EQ(read.distances[0].camera, "left");
  EXPECT_EQ(read.distances[0].reason, "a surface");
  EXPECT_TRUE(std::isnan(read.distances[1].distance_now)) << "nothing is known";
  EXPECT_FALSE(read.distances[1].distance_now >= 0.0);
}

}  // namespace
}  // namespace depthgrid::messages
