#include "lab/speed/memory.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace depthgrid::lab {
namespace {

/// "VmRSS" or "VmHWM", in bytes; NaN when there is no such line.
double status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind(name + ":", 0) == 0) {
      return 1024 * std::stod(line.substr(name.size() + 1));
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

MemoryPeak::MemoryPeak() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
  start_bytes_ = status_bytes("VmRSS");
  std::ofstream reset("/proc/self/clear_refs");
  reset << 5 << std::flush;
  usable_ = reset.good() && status_bytes("VmHWM") <= 1.05 * start_bytes_;
}

double MemoryPeak::growth_bytes() const {
  return usable_ ? std::max(0.0, status_bytes("VmHWM") - start_bytes_) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace depthgrid::lab
