// dds_peer DOMAIN COUNT: until its standard input ends it sends COUNT numbered images on /depth, 10 ms apart and once
// somebody listens; sends back on /joint_states_back and /image_back what comes on /joint_states and /image; says once,
// for whoever comes later, /description.
#include <poll.h>

#include <chrono>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <thread>

#include "dds/loopback.hpp"

namespace {

using depthgrid::messages::type_of;
namespace dds = depthgrid::dds;
namespace messages = depthgrid::messages;

/// So deep that nothing is lost while a slow reader asks for lost fragments again.
constexpr dds::Qos kEverything{dds::Reliability::reliable, dds::Durability::volatile_, 100};

/// At most a minute.
bool goes_on(std::chrono::steady_clock::time_point begin) {
  pollfd input{.fd = 0, .events = POLLIN, .revents = 0};
  return poll(&input, 1, 0) == 0 && std::chrono::steady_clock::now() < begin + std::chrono::minutes(1);
}

int play(int domain, int count) {
  using Clock = std::chrono::steady_clock;
  dds::Node node(dds::loopback("dds_peer", domain));
  dds::Publisher depth = node.publish("/depth", type_of<messages::Image>(), kEverything);
  dds::Publisher joints_back = node.publish("/joint_states_back", type_of<messages::JointState>(), dds::kReliable);
  dds::Publisher image_back = node.publish("/image_back", type_of<messages::Image>(), kEverything);
  dds::Publisher description = node.publish("/description", type_of<messages::Text>(), dds::kLatched);
  dds::Publisher distances = node.publish("/distances", type_of<messages::Distances>(), dds::kReliable);
  dds::Subscription joints = node.subscribe("/joint_states", type_of<messages::JointState>(), dds::kReliable);
  dds::Subscription image = node.subscribe("/image", type_of<messages::Image>(), dds::kSensorData);
  messages::Text text;
  text.data = "<robot name='said once'/>";
  bool whole = description.write(messages::to_bytes(text));
  std::vector<std::byte> message;
  int sent = 0;
  auto due = Clock::now();
  for (const auto begin = due; goes_on(begin);) {
    if (sent < count && depth.subscribers() > 0 && Clock::now() >= due) {
      whole = depth.write(dds::numbered_image(sent++)) && whole;
      due = Clock::now() + std::chrono::milliseconds(10);
    }
    while (joints.take(message).message) {
      whole = joints_back.write(message) && whole;
    }
    while (image.take(message).message) {
      whole = image_back.write(message) && whole;
    }
    (void)joints.wait(0.002);
  }
  return whole ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return argc == 3 ? play(std::atoi(argv[1]), std::atoi(argv[2])) : 2;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
