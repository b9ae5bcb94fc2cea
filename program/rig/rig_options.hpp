// What calibration files leave open, as the command line says it.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/files/rig_file.hpp"
#include "program/rig/imported_camera.hpp"

namespace depthgrid::program {

struct RigOptions {
  std::vector<std::string> files;
  ImportOptions import;
  std::vector<std::string> ids;              ///< new ids, in the order of the cameras
  std::vector<std::string> metres_per_unit;  ///< "0.001" for all, "ID=0.001" for one
  std::vector<std::string> sensors;          ///< the same; "none" where no model is known
  std::vector<std::string> poses;            ///< T_world_camera: "identity", 7 or 16 numbers; with or without "ID="
  std::vector<std::string> depth_files;      ///< patterns of image names
  std::string frames;                        ///< "FIRST:LAST"
  std::string output;
};

/// The rig of the cameras. Everything that neither files nor options say is named in one UsageError; nothing is
/// guessed. Throws Error where a value breaks a rule.
[[nodiscard]] files::RigFile make_rig(const std::vector<ImportedCamera>& cameras, const RigOptions& options);

}  // namespace depthgrid::program
