// A recording: a rig file and its sequences of 16-bit depth images.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/distortion.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/files/rig_file.hpp"

namespace depthgrid::files {

/// The recording is as it should be, and what was asked of it does not fit: a camera that it does not have, a near
/// limit beyond its far limit.
class ChoiceError : public Error {
 public:
  using Error::Error;
};

/// What a file of ROS messages (MCAP) leaves open. Of a folder with a rig file nothing of it may be set.
struct McapChoice {
  /// Topics of depth images, "/left/depth/image_raw" or "left=/left/depth/image_raw" with the camera's id. Empty: all
  /// that there are; ids are then the topics' names without "/depth/image_...".
  std::vector<std::string> depth_topics;
  std::string world_frame;              ///< empty: the frame at the root of /tf_static
  std::filesystem::path rig;            ///< in place of camera_info and /tf_static: a rig file; its images are not read
  std::optional<double> tolerance_s{};  ///< how far apart images of one frame may be; none: the rig file's
  // Of one camera chosen alone, without a rig file:
  std::string info_topic;                     ///< its sensor_msgs/CameraInfo; empty: camera_info beside its images
  std::optional<PinholeCamera> intrinsics{};  ///< in place of that, without lens distortion
  std::optional<Pose> T_world_camera{};       ///< in place of /tf_static

  [[nodiscard]] bool is_set() const noexcept {
    return !depth_topics.empty() || !world_frame.empty() || !rig.empty() || tolerance_s || !info_topic.empty() ||
           intrinsics || T_world_camera;
  }
};

/// What to take of a recording.
struct RecordingOptions {
  std::vector<std::string> camera_ids;  ///< cameras in the order wanted; empty: all, in the file's order
  std::optional<double> near_m;         ///< in place of every camera's own nearest measurable depth
  std::optional<double> far_m;          ///< in place of every camera's own farthest measurable depth
  /// In place of every camera's own treatment of readings beyond far_m. It is needed before distortion is removed.
  std::optional<bool> clamp_beyond_far = std::nullopt;
  /// In place of every camera's own filter radius (SensorMargin::lateral_px; 1 where it states no margins), which is
  /// needed before distortion is removed, too.
  std::optional<int> lateral_px = std::nullopt;
  McapChoice mcap{};
};

/// Whether a recording there is an MCAP file, or the folder of a ROS 2 bag with one. Throws Error for several.
[[nodiscard]] bool is_mcap(const std::filesystem::path& recording);

class McapImages;
struct McapPixels;
class FrameTable;
class CameraPoses;

/// Frames are counted from index 0. Images have a number (the frame's) or a time stamp; then every image of the first
/// camera chosen is a frame, and of every other camera the image nearest in time, if there is one within the rig file's
/// tolerance. Not thread-safe.
class Recording {
 public:
  /// `path` is the folder that holds a rig.json, or a rig file of any name; or an MCAP file of ROS 2, or the folder of
  /// a ROS 2 bag with one such file (docs/recordings-mcap.md). Throws Error as load_rig(), and for cameras without
  /// depth images, lists and trajectories that are broken; ChoiceError for unknown or doubled camera ids, and near and
  /// far that exclude each other. No image is read.
  explicit Recording(const std::filesystem::path& path, const RecordingOptions& options = {});

  /// The cameras chosen, as their images are handed out: lens distortion is removed, so the model is `none` and the
  /// intrinsics are those of rectified_camera(), whose image may be larger than the one recorded. The pose of a
  /// camera that moves is the identity: see T_world_camera().
  [[nodiscard]] const Rig& rig() const noexcept { return file_.rig; }
  /// The rig file that it was opened from; of an MCAP file without one the file itself.
  [[nodiscard]] const std::filesystem::path& rig_file() const noexcept { return rig_file_; }
  [[nodiscard]] int frame_count() const noexcept;
  /// The number of frame `index`: in the names of the image files, or counted in the order of time. They ascend.
  [[nodiscard]] int frame_number(int index) const noexcept;
  /// Frames a second; none when the recording does not say.
  [[nodiscard]] std::optional<double> rate_hz() const noexcept { return file_.rate_hz; }
  /// Since the first frame, from the time stamps or the rate; none when the recording says neither.
  [[nodiscard]] std::optional<double> time_s(int index) const;
  /// The time stamp of the first frame, on the clock of the images; 0 where they have none.
  [[nodiscard]] double start_s() const;
  /// Whether images have time stamps of their own.
  [[nodiscard]] bool has_time_stamps() const noexcept;
  /// Whether all time stamps are of one clock; none: the rig file does not say.
  [[nodiscard]] std::optional<bool> shared_clock() const noexcept { return file_.shared_clock; }
  /// Whether images of the same frame were taken at the same time.
  [[nodiscard]] bool simultaneous() const noexcept;
  /// Whether the camera has an image in frame `index`. Numbered images are not looked for.
  [[nodiscard]] bool has_image(int index, std::size_t camera) const;
  /// The MCAP file that the images are in; empty: they are PNG files.
  [[nodiscard]] const std::filesystem::path& mcap_file() const noexcept { return mcap_file_; }
  /// What was found in an MCAP file, and what is missing of it: lines for people.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// The image file of frame `index` of camera `camera` (index in rig()). Throws Error where there is none.
  [[nodiscard]] std::filesystem::path depth_file(int index, std::size_t camera) const;

  /// Whether the camera moves, so that each of its images has a pose of its own.
  [[nodiscard]] bool moves(std::size_t camera) const noexcept { return poses_[camera] != nullptr; }
  [[nodiscard]] bool moves() const noexcept;
  /// Whether a trajectory with time stamps says where a camera was.
  [[nodiscard]] bool has_trajectory() const noexcept;
  /// The time stamp of the camera's image on the clock of the images; where they have none, since the first frame by
  /// the rate, or the index where there is no rate either. Of a camera without image in the frame: the frame's.
  [[nodiscard]] double stamp_s(int index, std::size_t camera) const;
  /// Where the camera was when it took its image of frame `index`. Throws Error where the recording does not say.
  [[nodiscard]] Pose T_world_camera(int index, std::size_t camera) const;

  /// All files that are read for frame `index` besides the rig file.
  [[nodiscard]] std::vector<std::filesystem::path> files_of(int index) const;

  /// The intrinsics of a camera's images in their files, before lens distortion is removed.
  [[nodiscard]] const PinholeCamera& recorded_intrinsics(std::size_t camera) const {
    return channels_.at(camera).recorded;
  }

  [[nodiscard]] const Distortion& recorded_distortion(std::size_t camera) const {
    return channels_.at(camera).recorded_distortion;
  }

  /// One camera's image of frame `index` as it was recorded, before lens distortion is removed; valid until the next
  /// read. Throws Error as read(), and where the camera has no image in this frame.
  [[nodiscard]] DepthView read_recorded(int index, std::size_t camera);

  /// Reads frame `index` of all cameras: one Frame a camera, in the order of rig(), valid until the next read or the
  /// end of the recording. Depth is the file's own 16-bit buffer (apply the camera's rule to it), or float metres where
  /// a distortion was removed; without data where the camera has no image in this frame; there is no robot in view.
  /// Frame::time_s is the image's time since the first frame; where the recording says no times the index itself stands
  /// in for seconds: ask time_s() before using it as a time. Throws Error that names the file when it is absent or
  /// broken or its size is not the calibration's, or when index is not in [0, frame_count()).
  std::span<const Frame> read(int index);

  /// The image of a camera with lens distortion as recorded, by the camera's rule, of the frame read last; null where
  /// there is no distortion to remove. Valid as the frames are.
  [[nodiscard]] const DepthImage* distorted(std::size_t camera) const;
  /// Of each of its pixels, row-major, whether the rectified image reads it; empty where there is no distortion.
  [[nodiscard]] std::vector<bool> pixels_read(std::size_t camera) const;

 private:
  struct Channel {
    Gray16Image raw;
    std::shared_ptr<McapPixels> pixels;  ///< in place of `raw` for an MCAP file
    PinholeCamera recorded;              ///< intrinsics of the images in the files
    Distortion recorded_distortion;
    std::optional<DepthUndistortion> undistortion;
    DepthImage distorted;
    DepthImage undistorted;
  };
  void check_place(int index, std::size_t camera) const;

  std::filesystem::path rig_file_;
  std::filesystem::path mcap_file_;
  std::shared_ptr<McapImages> mcap_;  ///< null: images are files
  RigFile file_;                      ///< reduced to the chosen cameras
  std::shared_ptr<const FrameTable> table_;
  std::vector<std::shared_ptr<const CameraPoses>> poses_;  ///< one a camera; null: it stands still
  std::vector<Channel> channels_;
  std::vector<Frame> frames_;
};

}  // namespace depthgrid::files
