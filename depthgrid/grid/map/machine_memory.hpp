// How much memory a process may still take.
#pragma once

#include <cstdint>

namespace depthgrid::grid {

/// Memory in bytes that this machine, or the control group of this process where that is less, can still give without
/// swapping. The largest number when the system does not tell.
[[nodiscard]] std::uint64_t available_memory_bytes();

}  // namespace depthgrid::grid
