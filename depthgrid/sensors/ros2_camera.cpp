#include "depthgrid/sensors/ros2_camera.hpp"

#include <algorithm>
#include <exception>
#include <span>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"

namespace depthgrid::sensors {
namespace {

constexpr double kLongestForInfo_s = 2;

std::string beside(const std::string& topic, const std::string& name) {
  return topic.substr(0, topic.rfind('/') + 1) + name;
}

/// None where the camera is not calibrated. Throws Error for images that are no pinhole's.
std::optional<PinholeCamera> intrinsics_of(std::span<const std::byte> message, const std::string& topic) {
  const auto info = messages::from_bytes<messages::CameraInfo>(message);
  if (std::all_of(info.k.begin(), info.k.end(), [](double value) { return value == 0; })) {
    return std::nullopt;
  }
  const messages::CameraModel model = messages::camera_model(info, topic.find("rect") != std::string::npos);
  if (distorts(model.distortion)) {
    fail("the lens distorts these images: take the topic of rectified ones");
  }
  return model.intrinsics;
}

}  // namespace

Ros2Camera::Ros2Camera(std::shared_ptr<dds::Node> node, std::string topic)
    : node_(std::move(node)), topic_(std::move(topic)) {}

void Ros2Camera::open() {
  images_.emplace(node_->subscribe(topic_, messages::type_of<messages::Image>(), dds::kSensorData));
  info_ = {.name = "ROS 2 topic " + topic_, .serial = topic_, .clock = "this computer's, by the messages' stamps"};
  if (!calibrations_ && !intrinsics_) {
    calibrations_.emplace(
        node_->subscribe(beside(topic_, "camera_info"), messages::type_of<messages::CameraInfo>(), dds::kSensorData));
    (void)calibrations_->wait(kLongestForInfo_s);
    (void)look_for_calibration();
  }
  info_.intrinsics = intrinsics_;
  info_.metres_per_unit = messages::kMetresPerUnit;
  reason_.clear();
}

void Ros2Camera::close() noexcept { images_.reset(); }

bool Ros2Camera::look_for_calibration() {
  if (!calibrations_ || !calibrations_->take(message_).message) {
    return false;
  }
  intrinsics_ = intrinsics_of(message_, topic_);
  calibrations_.reset();
  return intrinsics_.has_value();
}

Reading Ros2Camera::newest(DepthReading& reading) {
  if (look_for_calibration()) {  // whoever opened it has to see that
    reason_ = topic_ + ": its camera_info has come, later than it was opened";
    return Reading::failed;
  }
  std::int64_t taken = 0;
  while (images_->take(message_).message) {
    ++taken;
  }
  if (taken == 0) {
    return Reading::nothing;
  }
  const auto image = messages::from_bytes<messages::Image>(message_);
  if (frame_.empty()) {
    frame_ = image.header.frame_id;
  } else if (image.header.frame_id != frame_) {
    fail("images of two frames come on one topic, '", printable_excerpt(frame_), "' and '",
         printable_excerpt(image.header.frame_id), "': does a second driver publish there?");
  }
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
