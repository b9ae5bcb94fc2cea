// What an MCAP file is made of: records of an opcode, a length and little endian contents. Internal.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace depthgrid::files {

inline constexpr std::array<std::uint8_t, 8> kMcapMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class McapOpcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  metadata = 12,
  metadata_index = 13,
  summary_offset = 14,
  data_end = 15,
};

/// Opcode and length before the contents of a record.
inline constexpr std::size_t kMcapRecordHead = 9;
/// Contents of a footer: two positions and a CRC.
inline constexpr std::size_t kMcapFooterBytes = 20;
/// Contents of a message before its data: channel, sequence, two times.
inline constexpr std::size_t kMcapMessageHead = 22;
/// A chunk is held in memory: larger ones are refused before memory is taken. Recorders make them of some megabytes.
inline constexpr std::uint64_t kLargestMcapChunk = std::uint64_t{1} << 28U;

/// Of zlib; `so_far` is that of the bytes before, 0 at the beginning.
[[nodiscard]] std::uint32_t mcap_crc(std::span<const std::byte> bytes, std::uint32_t so_far = 0) noexcept;

/// Reads the contents of a record. Throws Error that begins with `context` where they end too early.
class McapContents {
 public:
  McapContents(std::span<const std::byte> bytes, std::string_view context) : bytes_(bytes), context_(context) {}

  template <class Number>
  requires std::is_unsigned_v<Number>
  [[nodiscard]] Number number(const char* name) {
    const std::span<const std::byte> raw = bytes(sizeof(Number), name);
    Number value = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      value = static_cast<Number>(value | static_cast<Number>(std::to_integer<Number>(raw[i]) << (8U * i)));
    }
    return value;
  }
  [[nodiscard]] std::span<const std::byte> bytes(std::uint64_t count, const char* name);
  [[nodiscard]] std::string_view text(const char* name);
  /// Of texts, by 32-bit lengths.
  [[nodiscard]] std::map<std::string, std::string> texts(const char* name);
  /// What a map or list fills, by its length in bytes.
  [[nodiscard]] McapContents list(const char* name);
  [[nodiscard]] std::size_t left() const noexcept { return bytes_.size(); }
  [[nodiscard]] std::span<const std::byte> rest() const noexcept { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
  std::string_view context_;
};

/// One record in memory.
struct McapRecord {
  McapOpcode opcode{};
  std::span<const std::byte> contents;
};

/// Takes the first record off `bytes`. Throws Error where it is longer than they are.
[[nodiscard]] McapRecord take_mcap_record(std::span<const std::byte>& bytes, std::string_view context);

/// Appends the parts of a record.
class McapBuilder {
 public:
  template <class Number>
  requires std::is_unsigned_v<Number> McapBuilder& number(Number value) {
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      bytes_.push_back(static_cast<std::byte>(value >> (8U * i)));
    }
    return *this;
  }
  McapBuilder& text(std::string_view value);
  McapBuilder& raw(std::span<const std::byte> value);
  McapBuilder& texts(const std::map<std::string, std::string>& value);
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }
  /// Everything before it becomes the contents of a record, appended to `to`.
  void end_record(McapOpcode opcode, std::vector<std::byte>& to);

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace depthgrid::files
