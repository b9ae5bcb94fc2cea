#include "depthgrid/files/foreign_recording.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/whole_file.hpp"

namespace depthgrid::files {
namespace {

namespace fs = std::filesystem;

struct Container {
  std::string_view extension;
  std::string_view first_bytes;  ///< empty: told by the name alone
  const char* what;
  const char* tool;
};

constexpr const char* kRosTool = "the Python package rosbags reads it";
constexpr std::string_view kMcapBegin = "\x89MCAP0\r\n";
constexpr std::array<Container, 6> kContainers{{
    {".bag", "#ROSBAG V", "a ROS 1 bag, as rosbag and RealSense cameras write it", kRosTool},
    {".db3", "", "a ROS 2 bag", "or let rosbags-convert or ros2 bag convert make an MCAP file of it, which is read"},
    {".oni", "NI10", "an OpenNI recording of a Kinect or Xtion", "OpenNI 2 reads it"},
    {".mkv", "", "a Matroska recording, as Azure Kinects write it", "the Azure Kinect SDK reads it"},
    {".svo", "", "a recording of a ZED camera", "the ZED SDK reads it"},
    {".svo2", "", "a recording of a ZED camera", "the ZED SDK reads it"},
}};

[[noreturn]] void refuse(const fs::path& path, const Container& container) {
  fail(path.string(), ": is ", container.what,
       ", which depthgrid does not read: write its depth images as 16-bit PNG "
       "files into a folder (",
       container.tool,
       ") and a rig.json beside them; docs/rig-file.md, \"From a bag to a "
       "folder\", says how");
}

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// Whether it looks like the folder of a ROS 2 bag.
bool holds_a_bag(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / "metadata.yaml", error)) {
    return true;
  }
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string extension = lower_extension(entry->path());
    if (extension == ".mcap" || extension == ".db3") {
      return true;
    }
  }
  return false;
}

/// Nothing where it cannot be read: whoever reads it says why.
std::string first_bytes(const fs::path& file) {
  try {
    std::array<char, 16> bytes{};
    const InputStream stream = open_regular_file(file);
    return {bytes.data(), std::fread(bytes.data(), 1, bytes.size(), stream.get())};
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

fs::path mcap_recording(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    const bool is_called_so = lower_extension(path) == ".mcap" && fs::is_regular_file(path, error);
    return is_called_so || first_bytes(path).starts_with(kMcapBegin) ? path : fs::path();
  }
  if (fs::exists(path / "rig.json", error)) {
    return {};
  }
  fs::path found;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
    if (lower_extension(entry->path()) == ".mcap") {
      if (!found.empty()) {
        fail(path.string(), ": holds several MCAP files; name one of them, such as ",
             std::min(found, entry->path()).string());
      }
      found = entry->path();
    }
  }
  return found;
}

void refuse_foreign_recording(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    if (holds_a_bag(path) && !fs::exists(path / "rig.json", ignored)) {
      refuse(path, kContainers[1]);
    }
    return;
  }
  const std::string extension = lower_extension(path);
  const std::string begin = first_bytes(path);
  const bool is_there = fs::is_regular_file(path, ignored);
  for (const Container& container : kContainers) {
    const bool is_such = !container.first_bytes.empty() && begin.rfind(container.first_bytes, 0) == 0;
    if (is_such || (extension == container.extension && is_there)) {
      refuse(path, container);
    }
  }
}

}  // namespace depthgrid::files
