#include "depthgrid/grid/map/machine_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

namespace depthgrid::grid {
namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

// The number after `key` at the beginning of a line of a file of the kernel.
std::uint64_t number_after(const char* path, const std::string& key, std::uint64_t otherwise) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(key, 0) == 0) {
      return std::strtoull(line.c_str() + key.size(), nullptr, 10);
    }
  }
  return otherwise;
}

std::uint64_t machine_bytes() {
  const std::uint64_t kibibytes = number_after("/proc/meminfo", "MemAvailable:", kUnknown);
  return kibibytes == kUnknown ? kUnknown : kibibytes * 1024;
}

std::uint64_t control_group_bytes() {
  std::uint64_t limit = 0;
  std::uint64_t used = 0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit && std::ifstream("/sys/fs/cgroup/memory.current") >> used) {
    // Files that were read or written count as used but give way.
    const std::uint64_t gives_way = number_after("/sys/fs/cgroup/memory.stat", "inactive_file ", 0);
    used -= std::min(used, gives_way);
    return limit - std::min(limit, used);
  }
  return kUnknown;
}

}  // namespace

std::uint64_t available_memory_bytes() { return std::min(machine_bytes(), control_group_bytes()); }

}  // namespace depthgrid::grid
