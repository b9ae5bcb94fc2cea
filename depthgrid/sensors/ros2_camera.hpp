// A depth camera whose driver is a ROS 2 node.
#pragma once

#include <cstddef>
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
/// two seconds of open().
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

  std::shared_ptr<dds::Node> node_;
  std::string topic_;
  std::optional<dds::Subscription> images_;
  std::vector<std::byte> message_;
  messages::DepthPixels pixels_;
  SourceInfo info_;
  std::string reason_;
};

}  // namespace depthgrid::sensors
