#include "depthgrid/files/recording.hpp"

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"

namespace depthgrid::files {
namespace {

std::filesystem::path rig_path(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored) ? path / "rig.json" : path;
}

std::size_t index_of(const Rig& rig, const std::string& id, const std::string& name) {
  try {
    return camera_index(rig, id);
  } catch (const Error& error) {
    fail(name, ": ", error.what());
  }
}

/// The file with only the cameras of `ids`, in that order.
RigFile select(RigFile all, const std::vector<std::string>& ids, const std::string& name) {
  if (ids.empty()) {
    return all;
  }
  RigFile chosen = all;
  chosen.rig.cameras.clear();
  chosen.depth_files.clear();
  std::set<std::string> seen;
  for (const std::string& id : ids) {
    if (!seen.insert(id).second) {
      fail(name, ": camera '", id, "' is chosen twice");
    }
    const std::size_t k = index_of(all.rig, id, name);
    chosen.rig.cameras.push_back(all.rig.cameras[k]);
    chosen.depth_files.push_back(all.depth_files[k]);
  }
  return chosen;
}

}  // namespace

Recording::Recording(const std::filesystem::path& path, const RecordingOptions& options) {
  rig_file_ = rig_path(path);
  const std::string name = rig_file_.string();
  file_ = select(load_rig(rig_file_), options.camera_ids, name);
  channels_.resize(file_.rig.cameras.size());
  frames_.resize(file_.rig.cameras.size());
  for (std::size_t k = 0; k < file_.rig.cameras.size(); ++k) {
    RigCamera& camera = file_.rig.cameras[k];
    if (file_.depth_files[k].empty()) {
      fail(name, ": camera '", camera.id, "' has no depth_files, so there are no images to read");
    }
    camera.rule.near_m = options.near_m.value_or(camera.rule.near_m);
    camera.rule.far_m = options.far_m.value_or(camera.rule.far_m);
    camera.rule.clamp_beyond_far = options.clamp_beyond_far.value_or(camera.rule.clamp_beyond_far);
    validate(camera.rule, (name + ": camera '" + camera.id + "'").c_str());
    const PinholeCamera& intrinsics = camera.intrinsics;
    if (distorts(camera.distortion)) {
      channels_[k].undistortion.emplace(intrinsics, camera.distortion, intrinsics);
      channels_[k].distorted = DepthImage(intrinsics.width_px, intrinsics.height_px);
      channels_[k].undistorted = DepthImage(intrinsics.width_px, intrinsics.height_px);
    }
    camera.distortion = {};
  }
}

std::filesystem::path Recording::depth_file(int index, std::size_t camera) const {
  if (index < 0 || index >= frame_count()) {
    fail(rig_file_.string(), ": there is no frame index ", index, ", must be from 0 to ", frame_count() - 1);
  }
  if (camera >= file_.depth_files.size()) {
    fail(rig_file_.string(), ": there is no camera index ", camera, ", must be below ", file_.depth_files.size());
  }
  return rig_file_.parent_path() / depth_file_name(file_.depth_files[camera], frame_number(index));
}

std::span<const Frame> Recording::read(int index) {
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    const RigCamera& camera = file_.rig.cameras[k];
    Channel& channel = channels_[k];
    const std::filesystem::path image_file = depth_file(index, k);
    read_png16(image_file, channel.raw);
    const int width_px = camera.intrinsics.width_px;
    const int height_px = camera.intrinsics.height_px;
    if (channel.raw.width_px != width_px || channel.raw.height_px != height_px) {
      fail(image_file.string(), ": is ", channel.raw.width_px, " x ", channel.raw.height_px,
           " pixels, the calibration of camera '", camera.id, "' is for ", width_px, " x ", height_px);
    }
    Frame& frame = frames_[k];
    frame.depth = depth_view(channel.raw.pixels, width_px, height_px, camera.metres_per_unit);
    if (channel.undistortion) {
      normalise(frame.depth, camera.rule, channel.distorted);
      channel.undistortion->apply(channel.distorted, channel.undistorted);
      const auto pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
      frame.depth = depth_view(std::span<const float>(channel.undistorted.data(), pixels), width_px, height_px);
    }
    frame.time_s = file_.rate_hz ? index / *file_.rate_hz : index;
  }
  return frames_;
}

}  // namespace depthgrid::files
