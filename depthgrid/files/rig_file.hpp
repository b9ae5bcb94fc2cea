// The rig file: calibrated cameras and the depth images that belong to them, as JSON (docs/rig-file.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/rig.hpp"

namespace depthgrid::files {

/// Where a camera's images and places stand, when names of files by number and one pose do not say it. Paths are
/// relative to the rig file's folder.
struct CameraTrack {
  std::string depth_list;  ///< text file of "time_s file"; empty: the names are depth_files
  std::string trajectory;  ///< text file of "time_s tx ty tz qx qy qz qw"; empty: none
  std::string pose_files;  ///< a text file a frame with a 4 x 4 matrix, with %d or %0Nd for its number; empty: none
  Pose T_body_camera = Pose::Identity();  ///< the camera on the body whose poses those are

  [[nodiscard]] bool moves() const noexcept { return !trajectory.empty() || !pose_files.empty(); }
};

/// A rig and where its recorded depth images are. In the file the principal point counts from the centre of the
/// top-left pixel (OpenCV's convention); here, as everywhere in the library, from that pixel's edge: half a pixel more.
struct RigFile {
  Rig rig;
  /// One a camera of `rig`, in its order: path relative to the file's folder, with at most one %d or %0Nd in place of
  /// the frame number, or %f in place of a time; with a slash at its end all images of a folder. Empty: the camera has
  /// no recorded images, or a list of them.
  std::vector<std::string> depth_files{};
  int first_frame = 0;              ///< number of the first frame
  int frame_count = 1;              ///< frames are numbered first_frame ... first_frame + frame_count - 1
  bool simultaneous = true;         ///< images of the same number were taken at the same time
  std::optional<double> rate_hz{};  ///< frames a second; none: unknown
  bool count_stated = false;        ///< frame_count is said; where images are listed it otherwise is all there are
  /// One a camera, or none at all: every camera stands still and its images are numbered. The pose in `rig` of a camera
  /// that moves is the identity.
  std::vector<CameraTrack> tracks{};
  std::optional<double> tolerance_s{};  ///< how far apart images of one frame may be, by their time stamps
  std::optional<double> pose_gap_s{};   ///< how far apart poses may be between which one is interpolated
  std::optional<bool> shared_clock{};   ///< whether all time stamps are of one clock; none: not said
};

/// Loads a rig file. Throws Error with one line that names the file, the place (line and column of a syntax error, JSON
/// pointer of everything else), the value and the rule: the JSON schema's keyword or the library's own check. Refused
/// are unknown and doubled keys, missing values, NaN and infinity, double camera ids, rotations that deviate by more
/// than kRotationTolerance, and depth_files that leave the folder or hold a conversion other than one %d, %0Nd or %f.
RigFile load_rig(const std::filesystem::path& file);

/// The same from text. `name` stands for the file in messages.
RigFile parse_rig(std::string_view text, const std::string& name);

/// The text of a rig file, in the file's conventions; parse_rig() gives back the same rig up to rounding of a pose's
/// rotation. Throws Error when `rig_file` breaks a rule of the file.
std::string to_json(const RigFile& rig_file);

/// Writes to_json() to `file`, under a temporary name that is then renamed. Throws Error.
void save_rig(const RigFile& rig_file, const std::filesystem::path& file);

/// Puts the frame number in place of the conversion: ("a/%03d.png", 7) gives "a/007.png". `pattern` is one that
/// parse_rig() accepts.
std::string depth_file_name(const std::string& pattern, int frame);

/// The JSON schema (draft 4) that rig files are checked against: the text of docs/rig.schema.json.
std::string_view rig_schema() noexcept;

}  // namespace depthgrid::files
