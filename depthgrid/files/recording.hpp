// A recording: a rig file and its sequences of 16-bit depth images.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/distortion.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/files/rig_file.hpp"

namespace depthgrid::files {

/// What to take of a recording.
struct RecordingOptions {
  std::vector<std::string> camera_ids;  ///< cameras in the order wanted; empty: all, in the file's order
  std::optional<double> near_m;         ///< in place of every camera's own nearest measurable depth
  std::optional<double> far_m;          ///< in place of every camera's own farthest measurable depth
  /// In place of every camera's own treatment of readings beyond far_m. It is needed before distortion is removed.
  std::optional<bool> clamp_beyond_far = std::nullopt;
};

/// Frames are counted from index 0; the number in the file's name is first_frame + index. Not thread-safe.
class Recording {
 public:
  /// `path` is the folder that holds a rig.json, or a rig file of any name. Throws Error as load_rig(), and for unknown
  /// or doubled camera ids, cameras without depth images, and near and far that exclude each other. No image is read.
  explicit Recording(const std::filesystem::path& path, const RecordingOptions& options = {});

  /// The cameras chosen, as their images are handed out: lens distortion is removed, so the model is `none`.
  [[nodiscard]] const Rig& rig() const noexcept { return file_.rig; }
  [[nodiscard]] int frame_count() const noexcept { return file_.frame_count; }
  /// The number of frame `index` in the names of the image files.
  [[nodiscard]] int frame_number(int index) const noexcept { return file_.first_frame + index; }
  /// Frames a second; none when the recording does not say.
  [[nodiscard]] std::optional<double> rate_hz() const noexcept { return file_.rate_hz; }
  /// Whether images of the same frame were taken at the same time.
  [[nodiscard]] bool simultaneous() const noexcept { return file_.simultaneous; }
  /// The image file of frame `index` of camera `camera` (index in rig()).
  [[nodiscard]] std::filesystem::path depth_file(int index, std::size_t camera) const;

  /// Reads frame `index` of all cameras: one Frame a camera, in the order of rig(), valid until the next read or the
  /// end of the recording. Depth is the file's own 16-bit buffer (apply the camera's rule to it), or float metres where
  /// a distortion was removed; there is no robot in view. time_s is index / rate_hz; where the rate is unknown the
  /// index itself stands in for seconds: ask rate_hz() before using it as a time. Throws Error that names the file when
  /// it is absent or broken or its size is not the calibration's, or when index is not in [0, frame_count()).
  std::span<const Frame> read(int index);

 private:
  struct Channel {
    Gray16Image raw;
    std::optional<DepthUndistortion> undistortion;
    DepthImage distorted;
    DepthImage undistorted;
  };
  std::filesystem::path rig_file_;
  RigFile file_;  ///< reduced to the chosen cameras
  std::vector<Channel> channels_;
  std::vector<Frame> frames_;
};

}  // namespace depthgrid::files
