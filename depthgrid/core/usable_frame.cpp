#include "depthgrid/core/usable_frame.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace depthgrid {

const char* why_unusable(const DepthView& depth, const PinholeCamera& camera) noexcept {
  if (depth.data == nullptr) {
    return "there is no depth image";
  }
  if (depth.width_px != camera.width_px || depth.height_px != camera.height_px) {
    return "the depth image has another size than the camera's intrinsics";
  }
  if (std::abs(with_stride(depth).stride_bytes) < row_bytes(depth.format, depth.width_px)) {
    return "the depth image's rows overlap: the stride is less than a row";
  }
  const std::ptrdiff_t bytes = row_bytes(depth.format, 1);
  if (depth.stride_bytes % bytes != 0 ||
      reinterpret_cast<std::uintptr_t>(depth.data) % static_cast<std::uintptr_t>(bytes) != 0) {
    return "the depth image's values are not aligned: data and stride must be multiples of a value's bytes";
  }
  return nullptr;
}

const char* why_unusable(const Frame& frame, const RigCamera& camera) noexcept {
  const DepthView& depth = frame.depth;
  const RobotView& robot = frame.robot;
  if (const char* reason = why_unusable(depth, camera.intrinsics)) {
    return reason;
  }
  if (depth.format == DepthFormat::uint16_units && depth.metres_per_unit != camera.metres_per_unit) {
    return "the depth image has another scale than the camera's metres_per_unit";
  }
  if ((robot.near_m == nullptr) != (robot.far_m == nullptr)) {
    return "the robot view has only one of near_m and far_m";
  }
  if (robot.near_m != nullptr && robot.stride_px != 0 && std::abs(robot.stride_px) < depth.width_px) {
    return "the robot view's rows overlap: the stride is less than a row";
  }
  const double inf = std::numeric_limits<double>::infinity();
  if (robot.near_m != nullptr &&
      (robot.blind_m < 0 || robot.blind_m == inf || robot.reach_m < 0 || robot.reach_m == inf)) {
    return "the robot view's blind layer or reach is negative or infinite";
  }
  return nullptr;
}

DepthView with_stride(DepthView depth) noexcept {
  if (depth.stride_bytes == 0) {
    depth.stride_bytes = row_bytes(depth.format, depth.width_px);
  }
  return depth;
}

Frame with_strides(Frame frame) noexcept {
  frame.depth = with_stride(frame.depth);
  if (frame.robot.stride_px == 0) {
    frame.robot.stride_px = frame.depth.width_px;
  }
  return frame;
}

}  // namespace depthgrid
