// How much memory something takes: the growth of the process's peak.
#pragma once

#include <cstddef>

namespace depthgrid::lab {

/// Resets the kernel's record of the peak when constructed.
class MemoryPeak {
 public:
  MemoryPeak();
  /// Bytes by which the peak of the resident memory exceeds what was resident at the start; page by page, and what the
  /// allocator kept from before is returned first. NaN where the kernel does not let a process reset its peak.
  [[nodiscard]] double growth_bytes() const;

 private:
  bool usable_ = false;
  double start_bytes_ = 0;
};

}  // namespace depthgrid::lab
