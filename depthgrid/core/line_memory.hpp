// Memory that begins at a cache line; large pieces lie on large pages where the system has them.
#pragma once

#include <cstddef>

namespace depthgrid {

/// Throws std::bad_alloc when there is none. From 1 MiB on in whole pages of 2 MiB: an image is read and written a row
/// of each of many buffers at a time, and looked up here and there, which with small pages costs a fifth more.
[[nodiscard]] void* allocate_lines(std::size_t bytes);
/// What allocate_lines() gave for so many bytes.
void free_lines(void* memory, std::size_t bytes) noexcept;

}  // namespace depthgrid
