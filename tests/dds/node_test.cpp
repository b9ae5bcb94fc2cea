// Messages between two processes, bit for bit, and what a node refuses.
#include "depthgrid/dds/node.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "dds/loopback.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::dds {
namespace {

using messages::type_of;

/// Of this process alone, as long as no 150 others test at once.
int test_domain() { return 50 + static_cast<int>(getpid() % 150); }

/// The other process; it ends with this.
class Peer {
 public:
  explicit Peer(int images)
      : pipe_(
            popen((std::string(DEPTHGRID_DDS_PEER) + " " + std::to_string(test_domain()) + " " + std::to_string(images))
                      .c_str(),
                  "w")) {}
  ~Peer() {
    if (pipe_ != nullptr) {
      EXPECT_EQ(pclose(pipe_), 0);
    }
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

 private:
  FILE* pipe_;
};

/// Until it holds, at most 20 s.
bool becomes(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    usleep(1000);
  }
  return true;
}

TEST(Node, HearsImagesOfAnotherProcessBitForBit) {
  constexpr int kImages = 30;
  const Peer peer(kImages);
  Node node(loopback("hearer", test_domain()));
  Subscription depth = node.subscribe("/depth", type_of<messages::Image>(), kReliable);
  std::vector<std::byte> message;
  double before_s = 0;
  for (int n = 0; n < kImages; ++n) {
    Taken taken;
    ASSERT_TRUE(becomes([&] {
      (void)depth.wait(0.1);
      taken = depth.take(message);
      return taken.message;
    })) << n;
    ASSERT_EQ(message, numbered_image(n)) << n;
    EXPECT_GE(taken.sent_s, before_s);
    before_s = taken.sent_s;
  }
  const double now_s = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  EXPECT_LT(now_s - before_s, 20) << "sent lately";
  EXPECT_GE(now_s, before_s);
  EXPECT_FALSE(depth.take(message).message);
  EXPECT_FALSE(depth.wait(0.01)) << "nothing waits";
  EXPECT_EQ(depth.publishers(), 1U);
}

TEST(Node, HearsWhatWasSaidBeforeItCame) {
  const Peer peer(0);
  usleep(1'500'000);
  Node node(loopback("late", test_domain()));
  Subscription description = node.subscribe("/description", type_of<messages::Text>(), kLatched);
  std::vector<std::byte> message;
  ASSERT_TRUE(becomes([&] { return description.take(message).message; }));
  EXPECT_EQ(messages::from_bytes<messages::Text>(message).data, "<robot name='said once'/>");
}

TEST(Node, IsHeardAndAnswered) {
  const Peer peer(0);
  Node node(loopback("asker", test_domain()));
  Publisher joints = node.publish("/joint_states", type_of<messages::JointState>(), kReliable);
  Subscription back = node.subscribe("/joint_states_back", type_of<messages::JointState>(), kReliable);
  ASSERT_TRUE(becomes([&] { return joints.subscribers() == 1 && back.publishers() == 1; }));
  messages::JointState state;
  state.name = {"a", "b"};
  state.position = {0.25, -1};
  const std::vector<std::byte> sent = messages::to_bytes(state);
  ASSERT_TRUE(joints.write(sent));
  std::vector<std::byte> message;
  ASSERT_TRUE(becomes([&] { return back.take(message).message; }));
  EXPECT_EQ(message, sent);
  // A topic of the same name and another type is another topic.
  Subscription other = node.subscribe("/joint_states_back", type_of<messages::Text>(), kReliable);
  EXPECT_EQ(other.publishers(), 0U);
}

TEST(Node, KeepsNoMoreThanItsDepth) {
  Node node(loopback("pair", test_domain()));
  Publisher sender = node.publish("text", type_of<messages::Text>(), kReliable);
  Subscription hearer =
      node.subscribe("/text", type_of<messages::Text>(), {Reliability::reliable, Durability::volatile_, 2});
  ASSERT_TRUE(becomes([&] { return sender.subscribers() == 1; }));
  messages::Text text;
  for (const std::string word : {"one", "two", "three"}) {
    text.data = word;
    ASSERT_TRUE(sender.write(messages::to_bytes(text)));
  }
  std::vector<std::byte> message;
  for (const std::string word : {"two", "three"}) {
    ASSERT_TRUE(becomes([&] { return hearer.take(message).message; }));
    EXPECT_EQ(messages::from_bytes<messages::Text>(message).data, word);
  }
  EXPECT_FALSE(hearer.take(message).message);
}

TEST(Node, RefusesWhatNobodyCouldHear) {
  const auto node_message = [](auto&& change) {
    NodeSettings settings = loopback("node", test_domain());
    change(settings);
    return test::thrown_message([&] { const Node node(settings); });
  };
  EXPECT_EQ(node_message([](NodeSettings&) {}), "");
  EXPECT_NE(node_message([](NodeSettings& s) { s.name = "my cell"; }).find("'my cell' must begin with a letter"),
            std::string::npos);
  EXPECT_NE(node_message([](NodeSettings& s) { s.name_space = "cell"; }).find("'cell' must be / or like"),
            std::string::npos);
  EXPECT_NE(node_message([](NodeSettings& s) { s.name_space = "/cell/"; }).find("must be / or like"),
            std::string::npos);
  EXPECT_NE(node_message([](NodeSettings& s) { s.domain = 233; }).find("233 must be from 0 to 232"), std::string::npos);
  EXPECT_NE(node_message([](NodeSettings& s) {
              s.domain = 200 + static_cast<int>(getpid() % 30);
              s.configuration = "<CycloneDDS><Domain><General><Nonsense/></General></Domain></CycloneDDS>";
            }).find("the configuration: Error: config: //CycloneDDS/Domain/General: Nonsense: unknown element"),
            std::string::npos);
  Node node(loopback("node", test_domain()));
  for (const std::string topic : {"", "/", "depth image", "/depth//image", "/2nd", "/depth/"}) {
    EXPECT_NE(test::thrown_message([&] {
                (void)node.publish(topic, type_of<messages::Text>(), kReliable);
              }).find("topic '" + topic + "' must be like"),
              std::string::npos)
        << topic;
  }
  EXPECT_NE(
      test::thrown_message([&] {
        (void)node.subscribe("/text", type_of<messages::Text>(), {Reliability::reliable, Durability::volatile_, 0});
      }).find("depth is 0, must be at least 1"),
      std::string::npos);
}

}  // namespace
}  // namespace depthgrid::dds
