#include "depthgrid/files/recording.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/plausibility.hpp"
#include "depthgrid/core/rectification.hpp"
#include "depthgrid/files/camera_poses.hpp"
#include "depthgrid/files/foreign_recording.hpp"
#include "depthgrid/files/frame_table.hpp"
#include "depthgrid/files/mcap_images.hpp"
#include "depthgrid/files/rig_selection.hpp"

namespace depthgrid::files {
namespace {

std::filesystem::path rig_path(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored) ? path / "rig.json" : path;
}

/// Before anybody takes memory for such images.
void check_size(const RigCamera& camera, const std::string& name) {
  const PinholeCamera& c = camera.intrinsics;
  const auto pixels = static_cast<std::uint64_t>(c.width_px) * static_cast<std::uint64_t>(c.height_px);
  if (pixels > kLargestImagePixels) {
    fail(name, ": camera '", camera.id, "' has ", c.width_px, " x ", c.height_px, " = ", pixels,
         " pixels, images must have at most ", kLargestImagePixels);
  }
}

}  // namespace

Recording::Recording(const std::filesystem::path& path, const RecordingOptions& options) {
  mcap_file_ = mcap_recording(path);
  rig_file_ = mcap_file_.empty() ? rig_path(path) : options.mcap.rig.empty() ? mcap_file_ : options.mcap.rig;
  const std::string name = rig_file_.string();
  const std::filesystem::path folder = rig_file_.parent_path();
  if (mcap_file_.empty()) {
    refuse_foreign_recording(path);
    if (options.mcap.is_set() && std::filesystem::exists(rig_file_)) {
      fail_choice(name, ": topics, world frame, tolerance and rig file are chosen of MCAP files only");
    }
    file_ = select_cameras(load_rig(rig_file_), options.camera_ids, name);
    table_ = std::make_shared<const FrameTable>(file_, folder, name);
  } else {
    mcap_ = std::make_shared<McapImages>(mcap_file_, options.mcap, options.camera_ids);
    file_ = mcap_->rig_file();
    table_ = std::make_shared<const FrameTable>(file_, mcap_->times_s(), name);
  }
  poses_.resize(file_.rig.cameras.size());
  for (std::size_t k = 0; k < file_.tracks.size(); ++k) {
    if (file_.tracks[k].moves()) {
      if (!file_.tracks[k].trajectory.empty() && !table_->by_time()) {
        fail(name, ": camera '", file_.rig.cameras[k].id,
             "' has a trajectory, and its images have numbers, not times; give a depth_list (time_s file)");
      }
      poses_[k] = std::make_shared<const CameraPoses>(file_.tracks[k], folder, file_.pose_gap_s);
    }
  }
  channels_.resize(file_.rig.cameras.size());
  frames_.resize(file_.rig.cameras.size());
  for (std::size_t k = 0; k < file_.rig.cameras.size(); ++k) {
    RigCamera& camera = file_.rig.cameras[k];
    camera.rule.near_m = options.near_m.value_or(camera.rule.near_m);
    camera.rule.far_m = options.far_m.value_or(camera.rule.far_m);
    camera.rule.clamp_beyond_far = options.clamp_beyond_far.value_or(camera.rule.clamp_beyond_far);
    try {
      validate(camera.rule, (name + ": camera '" + camera.id + "'").c_str());
      check_plausible(camera.rule, (name + ": camera '" + camera.id + "'").c_str());
    } catch (const Error& error) {
      throw ChoiceError(error.what());  // the file's own rule is valid
    }
    const PinholeCamera& intrinsics = camera.intrinsics;
    channels_[k].recorded = intrinsics;
    channels_[k].recorded_distortion = camera.distortion;
    channels_[k].pixels = mcap_ ? std::make_shared<McapPixels>() : nullptr;
    check_size(camera, name);
    if (distorts(camera.distortion)) {
      const PinholeCamera rectified = rectified_camera(intrinsics, camera.distortion);
      const int own_lateral_px = camera.margins ? camera.margins->sensor.lateral_px : SensorMargin{}.lateral_px;
      channels_[k].undistortion.emplace(intrinsics, camera.distortion, rectified,
                                        options.lateral_px.value_or(own_lateral_px));
      channels_[k].distorted = DepthImage(intrinsics.width_px, intrinsics.height_px);
      channels_[k].undistorted = DepthImage(rectified.width_px, rectified.height_px);
      camera.intrinsics = rectified;
    }
    camera.distortion = {};
  }
}

bool is_mcap(const std::filesystem::path& recording) { return !mcap_recording(recording).empty(); }

int Recording::frame_count() const noexcept { return table_->count(); }
int Recording::frame_number(int index) const noexcept { return table_->number(index); }
bool Recording::has_time_stamps() const noexcept { return table_->by_time(); }
bool Recording::simultaneous() const noexcept { return table_->simultaneous(); }

void Recording::check_place(int index, std::size_t camera) const {
  if (index < 0 || index >= frame_count()) {
    fail(rig_file_.string(), ": there is no frame index ", index, ", must be from 0 to ", frame_count() - 1);
  }
  if (camera >= file_.depth_files.size()) {
    fail(rig_file_.string(), ": there is no camera index ", camera, ", must be below ", file_.depth_files.size());
  }
}

std::vector<std::string> Recording::notes() const { return mcap_ ? mcap_->notes() : std::vector<std::string>(); }

double Recording::stamp_s(int index, std::size_t camera) const {
  check_place(index, camera);
  return table_->time_s(index, camera).value_or(index);
}

double Recording::start_s() const { return table_->by_time() ? table_->time_s(0, 0).value_or(0) : 0.0; }

std::optional<double> Recording::time_s(int index) const {
  check_place(index, 0);
  const auto time_s = table_->time_s(index, 0);
  return time_s ? std::optional(*time_s - *table_->time_s(0, 0)) : std::nullopt;
}

bool Recording::has_image(int index, std::size_t camera) const {
  check_place(index, camera);
  return mcap_ ? table_->image(index, camera).has_value() : table_->file(index, camera).has_value();
}

std::filesystem::path Recording::depth_file(int index, std::size_t camera) const {
  if (!has_image(index, camera)) {
    fail(rig_file_.string(), ": camera '", file_.rig.cameras[camera].id, "' has no image in frame ",
         frame_number(index));
  }
  return mcap_ ? mcap_file_ : rig_file_.parent_path() / *table_->file(index, camera);
}

bool Recording::moves() const noexcept {
  return std::any_of(poses_.begin(), poses_.end(), [](const auto& poses) { return poses != nullptr; });
}

bool Recording::has_trajectory() const noexcept {
  return std::any_of(file_.tracks.begin(), file_.tracks.end(),
                     [](const auto& track) { return !track.trajectory.empty(); });
}

Pose Recording::T_world_camera(int index, std::size_t camera) const {
  check_place(index, camera);
  return moves(camera) ? poses_[camera]->at(frame_number(index), table_->time_s(index, camera))
                       : file_.rig.cameras[camera].T_world_camera;
}

std::vector<std::filesystem::path> Recording::files_of(int index) const {
  std::vector<std::filesystem::path> files;
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (has_image(index, k)) {
      files.push_back(depth_file(index, k));
    }
    if (moves(k)) {
      files.push_back(poses_[k]->file(frame_number(index)));
    }
    if (k < file_.tracks.size() && !file_.tracks[k].depth_list.empty()) {
      files.push_back(rig_file_.parent_path() / file_.tracks[k].depth_list);
    }
  }
  return files;
}

const DepthImage* Recording::distorted(std::size_t camera) const {
  return channels_.at(camera).undistortion ? &channels_[camera].distorted : nullptr;
}

std::vector<bool> Recording::pixels_read(std::size_t camera) const {
  return channels_.at(camera).undistortion ? channels_[camera].undistortion->pixels_read() : std::vector<bool>();
}

DepthView Recording::read_recorded(int index, std::size_t camera) {
  const std::filesystem::path file = depth_file(index, camera);
  const RigCamera& of = file_.rig.cameras[camera];
  Channel& channel = channels_[camera];
  if (mcap_) {
    return mcap_->read(camera, *table_->image(index, camera), of, channel.recorded, *channel.pixels);
  }
  read_png16(file, channel.recorded, of.id, channel.raw);
  return depth_view(channel.raw.pixels, channel.recorded.width_px, channel.recorded.height_px, of.metres_per_unit);
}

std::span<const Frame> Recording::read(int index) {
  check_place(index, 0);
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    const RigCamera& camera = file_.rig.cameras[k];
    Channel& channel = channels_[k];
    Frame& frame = frames_[k];
    frame = Frame{};
    const auto time_s = table_->time_s(index, k);
    frame.time_s = time_s ? *time_s - *table_->time_s(0, 0) : index;
    if (table_->by_time() && !has_image(index, k)) {
      continue;
    }
    frame.depth = read_recorded(index, k);
    if (channel.undistortion) {
      normalise(frame.depth, camera.rule, channel.distorted);
      channel.undistortion->apply(channel.distorted, channel.undistorted);
      frame.depth = depth_view(channel.undistorted);
    }
  }
  return frames_;
}

}  // namespace depthgrid::files
