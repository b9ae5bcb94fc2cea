// Writes the parts of a CDR message: XCDR1, little endian.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "depthgrid/messages/cdr_reader.hpp"

namespace depthgrid::messages {

/// Appends to bytes of somebody else, which must outlive it.
class CdrWriter {
 public:
  /// Empties `bytes` and begins a message in them: 00 01 00 00.
  explicit CdrWriter(std::vector<std::byte>& bytes);

  template <CdrNumber Number>
  void number(Number value) {
    align(sizeof(Number));
    auto raw = std::bit_cast<std::array<std::byte, sizeof(Number)>>(value);
    if constexpr (std::endian::native != std::endian::little) {
      std::reverse(raw.begin(), raw.end());
    }
    append(raw);
  }
  void flag(bool value) { number(static_cast<std::uint8_t>(value ? 1 : 0)); }
  /// With the zero at its end. Throws Error from 4 GiB on, as do the next two.
  void text(std::string_view value);
  /// The length of a list, whose elements come next.
  void count(std::size_t size);
  void bytes(std::span<const std::byte> value);

 private:
  void align(std::size_t size);
  void append(std::span<const std::byte> value);

  std::vector<std::byte>& bytes_;
};

}  // namespace depthgrid::messages
