#include "depthgrid/files/camera_poses.hpp"

#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::files {
namespace {

constexpr std::uint64_t kLargestPoseText = 65536;

}  // namespace

CameraPoses::CameraPoses(CameraTrack track, std::filesystem::path folder, std::optional<double> gap_s)
    : track_(std::move(track)), folder_(std::move(folder)), gap_s_(gap_s) {
  if (!track_.trajectory.empty()) {
    const std::filesystem::path path = file(0);
    trajectory_ = parse_trajectory(read_text_file(path), path.string());
  }
}

std::filesystem::path CameraPoses::file(int number) const {
  return folder_ / (track_.trajectory.empty() ? depth_file_name(track_.pose_files, number) : track_.trajectory);
}

Pose CameraPoses::at(int number, std::optional<double> time_s) const {
  const std::filesystem::path path = file(number);
  if (track_.trajectory.empty()) {
    return parse_pose_matrix(read_text_file(path, kLargestPoseText), path.string()) * track_.T_body_camera;
  }
  try {
    return pose_at(trajectory_, time_s.value(), gap_s_) * track_.T_body_camera;
  } catch (const Error& error) {
    fail(path.string(), ": frame ", number, ": ", error.what());
  }
}

}  // namespace depthgrid::files
