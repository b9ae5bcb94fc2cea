#include "depthgrid/robot/mesh_path.hpp"

#include <system_error>

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

namespace {

namespace fs = std::filesystem;

bool begins_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

/// The folder of a package: as stated, else a folder of that name that holds the URDF file, or stands beside one.
fs::path package_folder(const std::string& package, const fs::path& urdf, const UrdfOptions& options,
                        const std::string& context) {
  if (const auto stated = options.packages.find(package); stated != options.packages.end()) {
    return stated->second;
  }
  std::error_code unused;
  for (fs::path folder = fs::absolute(urdf, unused).parent_path();; folder = folder.parent_path()) {
    if (folder.filename() == package) {
      return folder;
    }
    if (fs::is_directory(folder / package, unused)) {
      return folder / package;
    }
    if (folder == folder.parent_path()) {
      fail(context, "no folder is stated for package '", package, "', and none of that name holds the file");
    }
  }
}

}  // namespace

fs::path mesh_path(const std::string& name, const fs::path& urdf, const UrdfOptions& options,
                   const std::string& context) {
  const std::string package_scheme = "package://";
  const std::string file_scheme = "file://";
  fs::path path;
  if (begins_with(name, package_scheme)) {
    const std::string rest = name.substr(package_scheme.size());
    const std::size_t slash = rest.find('/');
    if (slash == std::string::npos || slash == 0) {
      fail(context, "mesh '", name, "' must be package://NAME/FILE");
    }
    path = package_folder(rest.substr(0, slash), urdf, options, context + "mesh '" + name + "': ") /
           rest.substr(slash + 1);
  } else if (begins_with(name, file_scheme)) {
    path = name.substr(file_scheme.size());
  } else {
    path = urdf.parent_path() / name;
  }
  std::error_code unused;
  if (options.require_meshes && !fs::is_regular_file(path, unused)) {
    fail(context, "mesh '", name, "' is ", path, ", which is not there");
  }
  return path;
}

}  // namespace depthgrid::robot
