// Runs the depthgrid command as a user would, and makes a recording small enough to understand.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "depthgrid/files/png.hpp"
#include "depthgrid/files/rig_file.hpp"
#include "files/temporary_folder.hpp"

namespace depthgrid::test {

struct CommandResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs `depthgrid ARGUMENTS` in `folder` through the shell; standard output and error are caught in files elsewhere.
/// `before` stands before the command: a limit, for instance.
inline CommandResult run_command(const std::string& arguments, const TemporaryFolder& folder,
                                 const std::string& before = {}) {
  const std::filesystem::path out = folder.path().string() + ".out";
  const std::filesystem::path err = folder.path().string() + ".err";
  const std::string line = "cd '" + folder.path().string() + "' && { " + before + "'" DEPTHGRID_COMMAND "' " +
                           arguments + "; } > '" + out.string() + "' 2> '" + err.string() + "' < /dev/null";
  const int status = std::system(line.c_str());  // NOLINT(cert-env33-c): the tests choose every word of it
  CommandResult result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(out), read_bytes(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return result;
}

/// Two cameras 0.4 m apart look along z at a wall 2 m away; two frames, ten a second. Floor frame: world, 1 m up.
inline files::RigFile wall_rig() {
  files::RigFile file;
  file.rig.name = "wall";
  for (const double x : {0.0, 0.4}) {
    RigCamera camera;
    camera.id = x == 0.0 ? "left" : "right";
    camera.intrinsics = {64, 48, 60.0, 60.0, 32.0, 24.0};
    camera.T_world_camera = Pose(Eigen::Translation3d(x, 0, 0));
    file.rig.cameras.push_back(camera);
    file.depth_files.push_back(camera.id + "_%03d.png");
  }
  file.rig.T_floor_world = Pose(Eigen::Translation3d(0, 0, 1));
  file.first_frame = 5;
  file.frame_count = 2;
  file.rate_hz = 10.0;
  return file;
}

/// Writes the recording into the folder.
inline void write_wall(const TemporaryFolder& folder) {
  const files::RigFile file = wall_rig();
  files::save_rig(file, folder / "rig.json");
  const std::vector<std::uint16_t> wall(std::size_t{64} * 48, 2000);
  for (const auto& pattern : file.depth_files) {
    for (int frame = 5; frame < 7; ++frame) {
      files::write_png_gray16(folder / files::depth_file_name(pattern, frame), 64, 48, wall);
    }
  }
}

/// Replaces the first occurrence of `what` in a file of the folder; fails the test when there is none.
inline void edit(const TemporaryFolder& folder, const std::string& name, const std::string& what,
                 const std::string& by) {
  std::string text = read_bytes(folder / name);
  const auto at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what << " is not in\n" << text;
  (void)folder.write(name, text.replace(at, what.size(), by));
}

}  // namespace depthgrid::test
