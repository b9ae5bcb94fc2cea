// An MCAP file's bytes: its records one by one, its chunks decompressed. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "depthgrid/core/whole_file.hpp"

namespace depthgrid::files {

/// Of a record, before its contents.
struct McapHead {
  std::uint8_t opcode = 0;
  std::uint64_t length = 0;  ///< of the contents
};

/// - Positions count from the file's beginning.
/// - Errors: Error that names the file and the byte; no length that stands in the file takes memory by itself.
/// - Threads: one.
class McapBytes {
 public:
  /// Throws Error where it is no MCAP file.
  explicit McapBytes(const std::filesystem::path& file);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  void read_at(std::uint64_t position, std::uint64_t count, std::vector<std::byte>& bytes);
  /// There must be such a head.
  [[nodiscard]] McapHead head_at(std::uint64_t position);
  /// Whether the file has all of the record there.
  [[nodiscard]] bool fits(std::uint64_t position, const McapHead& head) const noexcept;
  /// Of a record that is taken into memory.
  [[nodiscard]] std::uint64_t checked_length(std::uint64_t position, const McapHead& head) const;
  /// Its records, decompressed, the CRC checked; valid until the next call.
  [[nodiscard]] const std::vector<std::byte>& chunk_at(std::uint64_t position);

 private:
  struct Chunk {
    std::uint64_t position = 0;
    std::vector<std::byte> records;
  };
  void check_magic();

  std::string name_;
  InputStream stream_;
  std::uint64_t size_ = 0;
  std::vector<Chunk> kept_;
  std::vector<std::byte> head_;
  std::vector<std::byte> raw_chunk_;
};

}  // namespace depthgrid::files
