#include "depthgrid/robot/mesh_path.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/words.hpp"

namespace depthgrid::robot {

namespace {

namespace fs = std::filesystem;

/// Where a package or the robot's own folder is; a mesh may lie below it.
struct Place {
  fs::path path;
  fs::path within;
};

/// For users of the command and for those who call the library.
std::string how_to_state(const std::string& package) {
  return "state its folder with --package " + shown(package) + "=FOLDER, in a program in UrdfOptions::packages";
}

fs::path folder_of(const fs::path& urdf) {
  std::error_code unused;
  return fs::absolute(urdf, unused).lexically_normal().parent_path();
}

bool is_package(const fs::path& folder) {
  std::error_code unused;
  return fs::is_regular_file(folder / "package.xml", unused);
}

/// What has a package's name around a URDF file.
struct Around {
  fs::path folder;     ///< the package; empty: none
  fs::path not_taken;  ///< the nearest of the name that does not say that it is a package; empty: none
};

/// The file's own folder or the one that holds it, and others only where they say that they are a package. Without that
/// any folder up to the root would do, and package://home/... would read what is nobody's robot.
Around package_around(const std::string& package, const fs::path& urdf) {
  const fs::path own = folder_of(urdf);
  Around result;
  for (fs::path folder = own;; folder = folder.parent_path()) {
    for (const fs::path& candidate : {folder.filename() == package ? folder : fs::path(), folder / package}) {
      std::error_code unused;
      if (candidate.empty() || !fs::is_directory(candidate, unused)) {
        continue;
      }
      if (candidate == own || candidate == own.parent_path() || is_package(candidate)) {
        result.folder = candidate;
        return result;
      }
      if (result.not_taken.empty()) {
        result.not_taken = candidate;
      }
    }
    if (folder == folder.parent_path()) {
      return result;
    }
  }
}

/// The folder of a package: as stated, else around the file. Empty where there is none and need not be.
fs::path package_folder(const std::string& package, const fs::path& urdf, const UrdfOptions& options,
                        const std::string& context) {
  if (const auto stated = options.packages.find(package); stated != options.packages.end()) {
    return stated->second;
  }
  const Around around = package_around(package, urdf);
  if (around.folder.empty() && options.require_meshes) {
    fail(context, "no folder is stated for package '", shown(package), "'",
         around.not_taken.empty() ? ", and none of that name is around the file: "
                                  : ", and " + around.not_taken.string() + " holds no package.xml: ",
         how_to_state(package));
  }
  return around.folder;
}

/// The nearest folder around the file that is a package, else the file's own.
fs::path robot_folder(const fs::path& urdf) {
  for (fs::path folder = folder_of(urdf); folder != folder.parent_path(); folder = folder.parent_path()) {
    if (is_package(folder)) {
      return folder;
    }
  }
  return folder_of(urdf);
}

/// With %20 and the like as the bytes that they stand for, where this is not the name of a file as it is.
fs::path decoded(const fs::path& path) {
  std::error_code unused;
  const std::string text = path.string();
  if (text.find('%') == std::string::npos || fs::exists(path, unused)) {
    return path;
  }
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* const begin = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() && std::from_chars(begin, begin + 2, value, 16).ptr == begin + 2 &&
        value >= 0x20) {
      result += static_cast<char>(value);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  std::error_code unused;
  const fs::path absolute = fs::absolute(folder / "", unused).lexically_normal();  // ends in a slash
  const std::string text = fs::absolute(path, unused).lexically_normal().string();
  return text.starts_with(absolute.string());
}

}  // namespace

fs::path mesh_path(const std::string& name, const fs::path& urdf, const UrdfOptions& options,
                   const std::string& context) {
  const std::string_view package_scheme = "package://";
  const std::string_view file_scheme = "file://";
  const std::string mesh = "mesh '" + shown(name) + "'";
  Place place{urdf.parent_path() / name, robot_folder(urdf)};
  std::string package;
  if (name.starts_with(package_scheme)) {
    const std::string rest = name.substr(package_scheme.size());
    const std::size_t slash = rest.find('/');
    if (slash == std::string::npos || slash == 0) {
      fail(context, mesh, " must be package://NAME/FILE");
    }
    package = rest.substr(0, slash);
    if (package == "." || package == "..") {
      fail(context, mesh, " must be package://NAME/FILE, and '", package, "' is no name");
    }
    place.within = package_folder(package, urdf, options, context + mesh + ": ");
    if (place.within.empty() && !options.require_meshes) {
      return name;
    }
    place.path = place.within / fs::path(rest.substr(slash + 1)).relative_path();
  } else if (name.starts_with(file_scheme)) {
    const std::string rest = name.substr(file_scheme.size());
    place.path = rest.substr(rest.starts_with("localhost/") ? std::string_view("localhost").size() : 0);
    if (!place.path.is_absolute()) {
      fail(context, mesh, " must be file:///FOLDER/FILE, or a name relative to the URDF file");
    }
  } else if (name.find("://") != std::string::npos) {
    fail(context, mesh, " must begin with package:// or file://, or be relative to the URDF file");
  }
  place.path = decoded(place.path);
  std::error_code unused;
  const bool within = lies_in(place.path, place.within) ||
                      std::any_of(options.packages.begin(), options.packages.end(),
                                  [&place](const auto& stated) { return lies_in(place.path, stated.second); });
  if (!within) {
    fail(context, mesh, " is ", place.path, ", outside of the robot's folder ", place.within, ": ",
         how_to_state("NAME"));
  }
  if (options.require_meshes && !fs::is_regular_file(place.path, unused)) {
    fail(context, mesh, " is ", place.path, ", which is not there",
         package.empty() ? std::string() : ": " + how_to_state(package));
  }
  return place.path;
}

}  // namespace depthgrid::robot
