#include "depthgrid/sensors/ros2_joints.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"

namespace depthgrid::sensors {
namespace {

constexpr int kMostIncomplete = 100;
/// As many as come within a tenth of a second at 1 kHz.
constexpr dds::Qos kJoints{dds::Reliability::best_effort, dds::Durability::volatile_, 100};

}  // namespace

Ros2Joints::Ros2Joints(std::shared_ptr<dds::Node> node, std::string topic, std::vector<std::string> joints)
    : node_(std::move(node)), topic_(std::move(topic)), joints_(std::move(joints)), q_(joints_.size()) {}

void Ros2Joints::open() {
  states_.emplace(node_->subscribe(topic_, messages::type_of<messages::JointState>(), kJoints));
  info_ = {.name = "ROS 2 topic " + topic_, .serial = topic_, .clock = "this computer's, by the messages' stamps"};
  reason_.clear();
  incomplete_ = 0;
}

void Ros2Joints::close() noexcept { states_.reset(); }

bool Ros2Joints::read(const messages::JointState& state) {
  if (state.position.size() != state.name.size()) {
    reason_ = topic_ + ": a hundred messages in a row have no position for each name";
    return false;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto found = std::find(state.name.begin(), state.name.end(), joints_[i]);
    if (found == state.name.end()) {
      reason_ = topic_ + ": a hundred messages in a row have no joint '" + joints_[i] + "'";
      return false;
    }
    q_[i] = state.position[static_cast<std::size_t>(found - state.name.begin())];
  }
  return true;
}

Reading Ros2Joints::next(JointReading& reading, double longest_s) noexcept try {
  if (!states_) {
    reason_ = "is not open";
    return Reading::failed;
  }
  if (!states_->wait(longest_s) || !states_->take(message_).message) {
    return Reading::nothing;
  }
  const auto state = messages::from_bytes<messages::JointState>(message_);
  if (!read(state)) {
    return ++incomplete_ < kMostIncomplete ? Reading::nothing : Reading::failed;
  }
  incomplete_ = 0;
  reading.q = q_;
  // As for images: a state that comes twice has one time.
  const std::int64_t stamp_ns = messages::nanoseconds(state.header.stamp);
  if (stamp_ns != stamp_ns_) {
    stamp_ns_ = stamp_ns;
    time_s_ = clock_time_s(state.header.stamp);
  }
  reading.time_s = time_s_;
  return Reading::got;
} catch (const std::exception& error) {
  reason_ = topic_ + ": " + error.what();
  return Reading::failed;
}

}  // namespace depthgrid::sensors
