// A depth camera whose driver is a ROS 2 node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/dds/node.hpp"
#include "depthgrid/messages/image.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

/// Images of sensor_msgs/Image: 16UC1 in millimetres, 32FC1 in metres. Their stamps are taken for the middle of the
/// exposure, by this computer's clock. Intrinsics are those of the topic camera_info beside it, where one comes within
/// two seconds of the first open(); another one that comes later ends next() as failed, and the next open() knows it. A
/// topic with "rect" in its name has those of rectified images. Images of a lens that distorts are refused: they have
/// to be rectified. So are images of two frames on one topic.
class Ros2Camera final : public DepthSource {
 public:
  /// `topic`: "/camera/depth/image_raw".
  Ros2Camera(std::shared_ptr<dds::Node> node, std::string topic);

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

 private:
  [[nodiscard]] Reading newest(DepthReading& reading);
  /// Whether camera_info says something else than at the last look, or what is refused.
  [[nodiscard]] bool has_other_calibration();

  std::shared_ptr<dds::Node> node_;
  std::string topic_;
  std::optional<dds::Subscription> images_;
  std::vector<std::byte> message_;
  messages::DepthPixels pixels_;
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
