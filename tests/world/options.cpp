#include <algorithm>
#include <array>
#include <sstream>

#include "depthgrid/core/error.hpp"
#include "world/world.hpp"

namespace depthgrid::world {
namespace {

constexpr std::array<const char*, kBroken> kNames{"none",    "faster", "thinner", "black",   "clear",
                                                  "dropped", "clock",  "pose",    "readings"};

}  // namespace

const char* to_string(Broken broken) { return kNames.at(static_cast<std::size_t>(broken)); }

std::vector<std::string> broken_names() { return {kNames.begin(), kNames.end()}; }

Broken broken_of(const std::string& name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    fail("there is no assumption called '", name, "' to break");
  }
  return static_cast<Broken>(found - kNames.begin());
}

std::string command_of(const WorldOptions& options) {
  std::string command = "--world " + std::to_string(options.seed);
  if (options.width_px > 0) {
    command += " --width " + std::to_string(options.width_px);
  }
  command += options.smallest ? " --smallest" : "";
  command += options.memory ? " --memory" : "";
  if (options.broken != Broken::none) {
    command += std::string(" --broken ") + to_string(options.broken);
  }
  return command;
}

WorldOptions options_of(const std::string& command) {
  WorldOptions options;
  std::istringstream words(command);
  for (std::string word; words >> word;) {
    std::string value;
    if (word == "--world") {
      words >> options.seed;
    } else if (word == "--width") {
      words >> options.width_px;
    } else if (word == "--smallest") {
      options.smallest = true;
    } else if (word == "--memory") {
      options.memory = true;
    } else if (word == "--broken" && words >> value) {
      options.broken = broken_of(value);
    } else {
      fail("'", word, "' in '", command, "' says nothing about a world");
    }
  }
  return options;
}

std::string name_of(const WorldOptions& options) {
  const std::string width = std::to_string(options.width_px);
  const std::string height = std::to_string(options.width_px * 3 / 4);
  std::string name = options.width_px > 0 ? width + "x" + height : "40x30 to 96x72";
  name += options.smallest ? ", smallest obstacle" : "";
  name += options.memory ? ", memory" : "";
  return options.broken != Broken::none ? name + ", " + to_string(options.broken) : name;
}

}  // namespace depthgrid::world
