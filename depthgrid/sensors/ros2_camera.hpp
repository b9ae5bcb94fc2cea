// A depth camera whose driver is a ROS 2 node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/dds/node.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/messages/image.hpp"
#include "depthgrid/sensors/source.hpp"
#include "depthgrid/sensors/transform_history.hpp"

namespace depthgrid::sensors {

/// Where a camera of a moving or unmeasured mount stands: its frame on /tf and /tf_static.
struct Ros2Place {
  std::string world;  ///< frame that is the world
  std::string frame;  ///< the depth imager's optical frame; empty: the place is stated elsewhere
  /// Between two transforms of a moving frame, and for how long after an image the later one may come.
  double max_age_s = 0.1;
  std::string image_frame{};  ///< what the images say they are taken in; empty: `frame`
  double max_speed_m_s = std::numeric_limits<double>::infinity();   ///< faster than it may move: an image is a failure
  double max_turn_rad_s = std::numeric_limits<double>::infinity();  ///< the same of its turning
};

/// Images of sensor_msgs/Image: 16UC1 in millimetres, 32FC1 in metres; of a topic that ends with /compressedDepth those
/// of sensor_msgs/CompressedImage, 16UC1. With a place each image has the pose of its stamp: open() throws where no
/// transforms lead to the frame within two seconds; an image of which the pose is not known in time is a failure. Their
/// stamps are taken for the middle of the
/// exposure, by this computer's clock. Intrinsics are those of the topic camera_info beside it, where one comes within
/// two seconds of the first open(); another one that comes later ends next() as failed, and the next open() knows it. A
/// topic with "rect" in its name has those of rectified images. Images of a lens that distorts are refused: they have
/// to be rectified. So are images of two frames on one topic, and with a place those of another frame than that.
class Ros2Camera final : public DepthSource {
 public:
  /// `topic`: "/camera/depth/image_raw".
  Ros2Camera(std::shared_ptr<dds::Node> node, std::string topic, Ros2Place place = {});

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

 private:
  [[nodiscard]] Reading newest(DepthReading& reading);
  /// Of the message into the reading, time and pose left out.
  messages::Header read_image(DepthReading& reading);
  /// Throws Error where an image of this frame is none of the camera's.
  void check_frame(const std::string& frame);
  /// Waits for the pose of the image at hand, at most so long.
  [[nodiscard]] Reading place_image(DepthReading& reading, double longest_s);
  void listen_to_frames();
  /// Throws Error where it moved faster than is stated before the image at hand, taken from there.
  void check_motion(const Pose& T_world_camera) const;
  /// Throws Error where no transforms lead there.
  void find_frame();
  /// Whether camera_info says something else than at the last look, or what is refused.
  [[nodiscard]] bool has_other_calibration();

  std::shared_ptr<dds::Node> node_;
  std::string topic_;
  std::optional<dds::Subscription> images_;
  std::vector<std::byte> message_;
  messages::DepthPixels pixels_;
  files::Gray16Image png_;
  Ros2Place place_;
  bool is_compressed_;
  std::optional<dds::Subscription> moving_;
  std::optional<dds::Subscription> standing_;
  std::vector<std::byte> frames_message_;
  TransformHistory frames_;
  std::optional<double> system_ahead_s_;     ///< at the last look
  std::optional<DepthReading> waiting_;      ///< for its pose; its pixels are in message_, pixels_ or png_
  std::int64_t waiting_ns_ = 0;              ///< its stamp
  std::optional<PinholeCamera> intrinsics_;  ///< as they were told last
  std::optional<dds::Subscription> calibrations_;
  std::string refused_;        ///< why the calibration that was told last is; empty: it is not
  std::string frame_;          ///< of the first image
  std::int64_t stamp_ns_ = 0;  ///< of the image that was given last
  double time_s_ = 0;          ///< the same on our clock
  SourceInfo info_;
  std::string reason_;
};

}  // namespace depthgrid::sensors
