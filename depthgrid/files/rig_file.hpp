// The rig file: calibrated cameras and the depth images that belong to them, as JSON (docs/rig-file.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/rig.hpp"

namespace depthgrid::files {

/// A rig and where its recorded depth images are. In the file the principal point counts from the centre of the
/// top-left pixel (OpenCV's convention); here, as everywhere in the library, from that pixel's edge: half a pixel more.
struct RigFile {
  Rig rig;
  /// One a camera of `rig`, in its order: path relative to the file's folder, with at most one %d or %0Nd in place of
  /// the frame number. Empty: the camera has no recorded images.
  std::vector<std::string> depth_files;
  int first_frame = 0;            ///< number of the first frame
  int frame_count = 1;            ///< frames are numbered first_frame ... first_frame + frame_count - 1
  bool simultaneous = true;       ///< images of the same number were taken at the same time
  std::optional<double> rate_hz;  ///< frames a second; none: unknown
};

/// Loads a rig file. Throws Error with one line that names the file, the place (line and column of a syntax error, JSON
/// pointer of everything else), the value and the rule: the JSON schema's keyword or the library's own check. Refused
/// are unknown and doubled keys, missing values, NaN and infinity, double camera ids, rotations that deviate by more
/// than kRotationTolerance, and depth_files that leave the folder or hold a conversion other than one %d or %0Nd.
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
