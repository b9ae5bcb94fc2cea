#include "depthgrid/sensors/ros2_camera.hpp"

#include <exception>
#include <utility>

#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"

namespace depthgrid::sensors {
namespace {

constexpr double kLongestForInfo_s = 2;

std::string beside(const std::string& topic, const std::string& name) {
  return topic.substr(0, topic.rfind('/') + 1) + name;
}

/// Of images as the sensor has them: distortion is for the rig file to say.
std::optional<PinholeCamera> intrinsics_on(dds::Node& node, const std::string& topic) {
  dds::Subscription infos = node.subscribe(topic, messages::type_of<messages::CameraInfo>(), dds::kSensorData);
  std::vector<std::byte> message;
  if (!infos.wait(kLongestForInfo_s) || !infos.take(message).message) {
    return std::nullopt;
  }
  return messages::camera_model(messages::from_bytes<messages::CameraInfo>(message), false).intrinsics;
}

}  // namespace

Ros2Camera::Ros2Camera(std::shared_ptr<dds::Node> node, std::string topic)
    : node_(std::move(node)), topic_(std::move(topic)) {}

void Ros2Camera::open() {
  images_.emplace(node_->subscribe(topic_, messages::type_of<messages::Image>(), dds::kSensorData));
  info_ = {.name = "ROS 2 topic " + topic_, .serial = topic_, .clock = "this computer's, by the messages' stamps"};
  info_.intrinsics = intrinsics_on(*node_, beside(topic_, "camera_info"));
  info_.metres_per_unit = messages::kMetresPerUnit;
  reason_.clear();
}

void Ros2Camera::close() noexcept { images_.reset(); }

Reading Ros2Camera::newest(DepthReading& reading) {
  std::int64_t taken = 0;
  while (images_->take(message_).message) {
    ++taken;
  }
  if (taken == 0) {
    return Reading::nothing;
  }
  const auto image = messages::from_bytes<messages::Image>(message_);
  reading.depth = messages::depth_view(image, pixels_);
  reading.time_s = clock_time_s(image.header.stamp);
  reading.T_world_camera.reset();
  reading.skipped = taken - 1;
  return Reading::got;
}

Reading Ros2Camera::next(DepthReading& reading, double longest_s) noexcept try {
  if (!images_) {
    reason_ = "is not open";
    return Reading::failed;
  }
  return images_->wait(longest_s) ? newest(reading) : Reading::nothing;
} catch (const std::exception& error) {
  reason_ = topic_ + ": " + error.what();
  return Reading::failed;
}

}  // namespace depthgrid::sensors
