#include "depthgrid/sensors/ros2_camera.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <span>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"
#include "depthgrid/sensors/system_clock.hpp"

namespace depthgrid::sensors {
namespace {

constexpr double kLongestForInfo_s = 2;

bool same(const std::optional<PinholeCamera>& a, const std::optional<PinholeCamera>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->width_px == b->width_px && a->height_px == b->height_px && a->fx_px == b->fx_px &&
                 a->fy_px == b->fy_px && a->cx_px == b->cx_px && a->cy_px == b->cy_px));
}

constexpr std::string_view kCompressedDepth = "/compressedDepth";
constexpr double kLookAgain_s = 0.002;
/// Over this time the motion is looked at. What it comes to at rest, by the joints' noise, is none.
constexpr std::int64_t kMotion_ns = 50'000'000;
constexpr double kStill_m = 0.001;
constexpr double kStill_rad = 0.002;
/// The system's clock was set: more than the two clocks drift apart between two looks.
constexpr double kClockStep_s = 0.002;
/// As many as come within a tenth of a second at 1 kHz.
constexpr dds::Qos kTransforms{dds::Reliability::best_effort, dds::Durability::volatile_, 100};

std::string_view without_slash(std::string_view frame) { return frame.substr(frame.starts_with('/') ? 1 : 0); }

/// Of image_transport's topic that of the images themselves counts.
std::string beside(const std::string& topic, const std::string& name) {
  const std::string base =
      topic.ends_with(kCompressedDepth) ? topic.substr(0, topic.size() - kCompressedDepth.size()) : topic;
  return base.substr(0, base.rfind('/') + 1) + name;
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

Ros2Camera::Ros2Camera(std::shared_ptr<dds::Node> node, std::string topic, Ros2Place place)
    : node_(std::move(node)),
      topic_(std::move(topic)),
      place_(std::move(place)),
      is_compressed_(topic_.ends_with(kCompressedDepth)),
      frames_(place_.max_age_s) {}

void Ros2Camera::open() {
  const messages::MessageType& type =
      is_compressed_ ? messages::type_of<messages::CompressedImage>() : messages::type_of<messages::Image>();
  waiting_.reset();
  images_.emplace(node_->subscribe(topic_, type, dds::kSensorData));
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
  if (!place_.frame.empty()) {
    try {
      find_frame();
    } catch (const Error&) {
      images_.reset();
      throw;
    }
  }
  info_.intrinsics = intrinsics_;
  info_.metres_per_unit = messages::kMetresPerUnit;
  reason_.clear();
}

void Ros2Camera::close() noexcept {
  waiting_.reset();
  images_.reset();
}

// The subscriptions stay, as that of the calibration does: what was said once is not said again to them.
void Ros2Camera::find_frame() {
  const messages::MessageType& type = messages::type_of<messages::Transforms>();
  if (!moving_) {
    standing_.emplace(node_->subscribe("/tf_static", type, dds::kLatched));
    moving_.emplace(node_->subscribe("/tf", type, kTransforms));
  }
  const double end_s = clock_now_s() + kLongestForInfo_s;
  for (;;) {
    listen_to_frames();
    // Of frames that move the newest transforms are enough to know that they lead there.
    const PlaceAtTime place = frames_.find(place_.world, place_.frame, messages::nanoseconds(stamp_of(clock_now_s())));
    if (place.T_world_frame || place.may_come) {
      return;
    }
    if (clock_now_s() > end_s) {
      fail(place.reason);
    }
    (void)wait_until(end_s, kLookAgain_s);
  }
}

// Transforms are kept by the system's clock, as they and the images are stamped. Where that is set, those before say
// nothing of the times after.
void Ros2Camera::listen_to_frames() {
  const double ahead_s = system_ahead_s();
  if (system_ahead_s_ && std::abs(ahead_s - *system_ahead_s_) > kClockStep_s) {
    frames_.forget_moving();
  }
  system_ahead_s_ = ahead_s;
  const std::int64_t now_ns = messages::nanoseconds(stamp_of(clock_now_s()));
  while (standing_->take(frames_message_).message) {
    frames_.add(messages::from_bytes<messages::Transforms>(frames_message_), true, now_ns);
  }
  while (moving_->take(frames_message_).message) {
    frames_.add(messages::from_bytes<messages::Transforms>(frames_message_), false, now_ns);
  }
}

// What the cell counts on of its motion within the exposure. Where it was before, nobody may know: at the beginning.
void Ros2Camera::check_motion(const Pose& T_world_camera) const {
  const PlaceAtTime before = frames_.find(place_.world, place_.frame, waiting_ns_ - kMotion_ns);
  if (!before.T_world_frame) {
    return;
  }
  constexpr double kTime_s = static_cast<double>(kMotion_ns) * 1e-9;
  const Pose moved = before.T_world_frame->inverse(Eigen::Isometry) * T_world_camera;
  const double moved_m = moved.translation().norm();
  const double turned_rad = Eigen::AngleAxisd(moved.rotation()).angle();
  if (moved_m > place_.max_speed_m_s * kTime_s + kStill_m ||
      turned_rad > place_.max_turn_rad_s * kTime_s + kStill_rad) {
    fail("it moves with ", moved_m / kTime_s, " m/s and turns with ", turned_rad / kTime_s,
         " rad/s, faster than pose: {max_speed_m_s, max_turn_deg_s} says: ", place_.max_speed_m_s, " m/s, ",
         place_.max_turn_rad_s, " rad/s");
  }
}

Reading Ros2Camera::place_image(DepthReading& reading, double longest_s) {
  const double end_s = clock_now_s() + longest_s;
  for (;;) {
    listen_to_frames();
    PlaceAtTime place = frames_.find(place_.world, place_.frame, waiting_ns_);
    if (place.T_world_frame) {
      check_motion(*place.T_world_frame);
      reading = *waiting_;
      reading.T_world_camera = place.T_world_frame;
      waiting_.reset();
      return Reading::got;
    }
    if (!place.may_come || clock_now_s() - waiting_->time_s > place_.max_age_s) {
      waiting_.reset();
      fail(place.reason, ", and no other came within ", place_.max_age_s, " s");
    }
    if (clock_now_s() >= end_s) {
      return Reading::nothing;
    }
    (void)wait_until(end_s, kLookAgain_s);
  }
}

messages::Header Ros2Camera::read_image(DepthReading& reading) {
  if (!is_compressed_) {
    const auto image = messages::from_bytes<messages::Image>(message_);
    reading.depth = messages::depth_view(image, pixels_);
    return image.header;
  }
  const auto image = messages::from_bytes<messages::CompressedImage>(message_);
  files::read_png16(messages::compressed_depth(image).png, "image", PinholeCamera{}, "", png_);  // of any size
  reading.depth = depth_view(png_.pixels, png_.width_px, png_.height_px, messages::kMetresPerUnit);
  return image.header;
}

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

void Ros2Camera::check_frame(const std::string& frame) {
  const std::string& wanted = place_.image_frame.empty() ? place_.frame : place_.image_frame;
  if (!place_.frame.empty() && without_slash(frame) != without_slash(wanted)) {
    fail("its images are taken in frame '", printable_excerpt(frame), "', and the cell looks for '",
         printable_excerpt(wanted), "' on /tf: name theirs, or say pose: {frame: ..., image_frame: ...}");
  }
  if (frame_.empty()) {
    frame_ = frame;
  } else if (frame != frame_) {
    fail("images of two frames come on one topic, '", printable_excerpt(frame_), "' and '", printable_excerpt(frame),
         "': does a second driver publish there?");
  }
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
  const messages::Header header = read_image(reading);
  check_frame(header.frame_id);
  // The same stamp is the same time: read twice, the two clocks differ by microseconds, and an image that came twice
  // would be a new one with the pixels of the one before.
  const std::int64_t stamp_ns = messages::nanoseconds(header.stamp);
  if (stamp_ns != stamp_ns_) {
    stamp_ns_ = stamp_ns;
    time_s_ = clock_time_s(header.stamp);
  }
  reading.time_s = time_s_;
  reading.T_world_camera.reset();
  reading.skipped = taken - 1;
  if (!place_.frame.empty()) {
    waiting_ = reading;
    waiting_ns_ = stamp_ns;
    return place_image(reading, 0);
  }
  return Reading::got;
}

Reading Ros2Camera::next(DepthReading& reading, double longest_s) noexcept try {
  if (!images_) {
    reason_ = "is not open";
    return Reading::failed;
  }
  if (waiting_) {
    return place_image(reading, longest_s);
  }
  return images_->wait(longest_s) ? newest(reading) : Reading::nothing;
} catch (const std::exception& error) {
  reason_ = topic_ + ": " + error.what();
  return Reading::failed;
}

}  // namespace depthgrid::sensors
