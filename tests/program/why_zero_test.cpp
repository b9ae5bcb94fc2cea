// docs/why-zero.md says what the command prints: every `depthgrid distances` of the page is run on the recording that
// it names, and gives that state and, to the resolution, that distance. Skipped where the recording is absent:
// DEPTHGRID_DATA, by default ../shared/data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <vector>

#include "program/command.hpp"

namespace depthgrid::test {
namespace {

std::filesystem::path recording() {
  const char* given = std::getenv("DEPTHGRID_DATA");
  return (given != nullptr ? std::filesystem::path(given)
                           : std::filesystem::path(DEPTHGRID_SOURCE) / "../shared/data") /
         "kinect3_ball";
}

constexpr std::size_t kDistance = 6;  // columns of the CSV answers
constexpr std::size_t kState = 7;
constexpr double kResolution = 0.005;  // within which an answer may lie anywhere

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream text(line.substr(0, line.find('\n')));
  for (std::string cell; std::getline(text, cell, ',');) {
    result.push_back(cell);
  }
  return result;
}

/// Option -> value, later ones replacing earlier ones.
void read_options(const std::string& text, std::map<std::string, std::string>& options) {
  std::istringstream words(text);
  std::string last;
  for (std::string word; words >> word;) {
    if (word.rfind("--", 0) == 0) {
      const std::size_t equal = word.find('=');
      last = word.substr(0, equal);
      options[last] = equal == std::string::npos ? "" : word.substr(equal + 1);
    } else if (!last.empty()) {
      options[last] = word;
    }
  }
}

std::string command_line(const std::filesystem::path& folder, const std::map<std::string, std::string>& options) {
  std::string line = "distances '" + folder.string() + "'";
  for (const auto& [name, value] : options) {
    line += " " + name + "=" + value;
  }
  return line;
}

/// The recording with another unit of depth in its rig file.
std::filesystem::path with_small_unit(const TemporaryFolder& folder) {
  std::string rig = read_bytes(recording() / "rig.json");
  const std::string unit = "\"metres_per_unit\": 0.001";
  for (std::size_t at = rig.find(unit); at != std::string::npos; at = rig.find(unit, at + 1)) {
    rig.replace(at, unit.size(), "\"metres_per_unit\": 0.0001");
  }
  const std::filesystem::path file = folder.write("small/rig.json", rig);
  for (const char* camera : {"cam1", "cam2", "cam3"}) {
    std::filesystem::create_directory_symlink(std::filesystem::absolute(recording() / camera),
                                              file.parent_path() / camera);
  }
  return file.parent_path();
}

TEST(WhyZero, TheCommandGivesWhatThePageSays) {
  if (!std::filesystem::exists(recording() / "rig.json")) {
    GTEST_SKIP() << "the recording " << recording() << " is absent; set DEPTHGRID_DATA to the folder that holds it";
  }
  const TemporaryFolder folder;
  const std::string begin = "$ depthgrid distances kinect3_ball ";
  std::istringstream page(read_bytes(DEPTHGRID_SOURCE "/docs/why-zero.md"));
  std::map<std::string, std::string> usual;
  int compared = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind(begin, 0) != 0) {
      continue;
    }
    std::string rest = line.substr(begin.size());
    const bool small_unit = rest.find("# the same rig file") != std::string::npos;
    rest = rest.substr(0, rest.find(" #"));
    while (!rest.empty() && rest.back() == '\\') {
      std::getline(page, line);
      rest = rest.substr(0, rest.size() - 1) + line;
    }
    std::map<std::string, std::string> options = usual;
    read_options(rest, options);
    if (usual.empty()) {
      usual = options;
    }
    std::getline(page, line);
    if (line.rfind("frame,", 0) == 0) {
      std::getline(page, line);
    }
    if (options.count("--pictures") != 0) {
      continue;  // prints what it prints without
    }
    const auto result = run_command(command_line(small_unit ? with_small_unit(folder) : recording(), options), folder);
    ASSERT_EQ(result.exit_code, 0) << rest << '\n' << result.err;
    const std::vector<std::string> said = cells(line);
    const std::vector<std::string> printed = cells(result.out.substr(result.out.find('\n') + 1));
    ASSERT_GT(std::min(said.size(), printed.size()), kState) << line;
    EXPECT_EQ(said[kState], printed[kState]) << rest;
    EXPECT_EQ(said[kDistance].empty(), printed[kDistance].empty()) << rest;
    if (!said[kDistance].empty()) {
      EXPECT_NEAR(std::stod(said[kDistance]), std::stod(printed[kDistance]), kResolution) << rest;
    }
    ++compared;
  }
  EXPECT_EQ(compared, 11) << "commands of the page";
}

}  // namespace
}  // namespace depthgrid::test
