// Joint states of a robot whose driver is a ROS 2 node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/dds/node.hpp"
#include "depthgrid/messages/joint_state.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

/// sensor_msgs/JointState, whose stamps are by this computer's clock. Joints are found by their names. Messages that do
/// not have all of them (a gripper's, on the same topic) are passed over; after a hundred in a row it has failed.
class Ros2Joints final : public JointSource {
 public:
  /// `joints`: the robot's, in its order.
  Ros2Joints(std::shared_ptr<dds::Node> node, std::string topic, std::vector<std::string> joints);

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(JointReading& reading, double longest_s) noexcept override;

 private:
  /// Into q_. False: a joint is missing, which the reason names.
  [[nodiscard]] bool read(const messages::JointState& state);

  std::shared_ptr<dds::Node> node_;
  std::string topic_;
  std::vector<std::string> joints_;
  std::optional<dds::Subscription> states_;
  std::vector<std::byte> message_;
  std::vector<double> q_;
  int incomplete_ = 0;         ///< messages in a row
  std::int64_t stamp_ns_ = 0;  ///< of the state that was given last
  double time_s_ = 0;          ///< the same on our clock
  SourceInfo info_;
  std::string reason_;
};

}  // namespace depthgrid::sensors
