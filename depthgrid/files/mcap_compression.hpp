// How the records of a chunk are compressed: zstd, LZ4 frames, or not. Internal.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "depthgrid/files/mcap_writer.hpp"

namespace depthgrid::files {

/// Its name in files: "", "lz4", "zstd".
[[nodiscard]] std::string_view mcap_name(McapCompression compression) noexcept;

/// In place of what `out` held. Throws Error.
void mcap_compress(McapCompression compression, std::span<const std::byte> in, std::vector<std::byte>& out);

/// In place of what `out` held: exactly `size` bytes. Memory grows with what comes out of `in`, not with what is
/// promised. Throws Error that begins with `context`: an unknown name, broken data, another size.
void mcap_decompress(std::string_view name, std::span<const std::byte> in, std::size_t size,
                     std::vector<std::byte>& out, std::string_view context);

}  // namespace depthgrid::files
