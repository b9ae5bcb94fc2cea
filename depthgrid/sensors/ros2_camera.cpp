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

bool same(const std::optional<PinholeCamera>& a, const std::optional<PinholeCamera>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->width_px == b->width_px && a->height_px == b->height_px && a->fx_px == b->fx_px &&
                 a->fy_px == b->fy_px && a->cx_px == b->cx_px && a->cy_px == b->cy_px));
}

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
  if (!calibrations_) {
    calibrations_.emplace(
        node_->subscribe(beside(topic_, "camera_info"), messages::type_of<messages::CameraInfo>(), dds::kSensorData));
    (void)calibrations_->wait(kLongestForInfo_s);
  }
  (void)has_other_calibration();
  if (!refused_.empty()) {
    images_.reset();
    fail(refused_);
  }
  info_.intrinsics = intrinsics_;
  info_.metres_per_unit = messages::kMetresPerUnit;
  reason_.clear();
}

void Ros2Camera::close() noexcept { images_.reset(); }

// A calibration that was refused stays refused, however often the camera is opened, until the driver says another.
bool Ros2Camera::has_other_calibration() {
  bool is_told = false;
  while (calibrations_->take(message_).message) {
    is_told = true;
  }
  if (!is_told) {
    return false;
  }
  const std::optional<PinholeCamera> before = std::exchange(intrinsics_, std::nullopt);
  refused_.clear();
  try {
    intrinsics_ = intrinsics_of(message_, topic_);
  } catch (const Error& error) {
    refused_ = error.what();
  }
  return !refused_.empty() || !same(before, intrinsics_);
}

Reading Ros2Camera::newest(DepthReading& reading) {
  if (has_other_calibration()) {  // whoever opened it has to see that
    reason_ = topic_ + ": " +
              (refused_.empty() ? "its camera_info says another calibration than when it was opened" : refused_);
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
  // The same stamp is the same time: read twice, the two clocks differ by microseconds, and an image that came twice
  // would be a new one with the pixels of the one before.
  const std::int64_t stamp_ns = messages::nanoseconds(image.header.stamp);
  if (stamp_ns != stamp_ns_) {
    stamp_ns_ = stamp_ns;
    time_s_ = clock_time_s(image.header.stamp);
  }
  reading.time_s = time_s_;
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
