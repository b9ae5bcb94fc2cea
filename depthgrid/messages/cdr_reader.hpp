// Reads the parts of a CDR message (XCDR1), never beyond its end.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace depthgrid::messages {

template <class Number>
concept CdrNumber = std::is_arithmetic_v<Number> && !std::same_as<Number, bool>;

/// A place in the bytes of a message. Every function reads what comes next and throws Error with `what`, the name of
/// the field and the bytes it needs where it does not fit; then the place is not to be used any more.
/// - Memory: neither the bytes nor `what` nor names are owned; what is handed out as a view is one of the bytes.
class CdrReader {
 public:
  /// `bytes` begin with the four that say how they are written: 00 00 big, 00 01 little endian, two of options. Throws
  /// Error for any other. `what` stands in messages.
  CdrReader(std::span<const std::byte> bytes, std::string_view what);

  /// At a multiple of its size, as CDR has it.
  template <CdrNumber Number>
  [[nodiscard]] Number number(std::string_view name) {
    align(sizeof(Number));
    std::array<std::byte, sizeof(Number)> raw{};
    copy(take(sizeof(Number), name), raw);
    return std::bit_cast<Number>(raw);
  }
  /// One byte; everything but 0 is true.
  [[nodiscard]] bool flag(std::string_view name) { return number<std::uint8_t>(name) != 0; }
  /// Its length with the zero at its end, and the bytes; the zero may be missing.
  [[nodiscard]] std::string_view text(std::string_view name);
  /// The length of a list. It is not known whether its elements are there.
  [[nodiscard]] std::uint32_t count(std::string_view name) { return number<std::uint32_t>(name); }
  /// A list of bytes, in place.
  [[nodiscard]] std::span<const std::byte> bytes(std::string_view name) { return take(count(name), name); }
  /// `numbers.size()` numbers in a row.
  template <CdrNumber Number>
  void numbers(std::span<Number> numbers, std::string_view name) {
    require_numbers(numbers.size(), sizeof(Number), name);
    for (Number& number : numbers) {
      number = this->number<Number>(name);
    }
  }
  /// Throws unless so many numbers can follow: before memory is taken for them.
  void require_numbers(std::size_t count, std::size_t size, std::string_view name) const;

 private:
  /// Nothing is read: what comes next begins at such a multiple, counted from the byte after the first four.
  void align(std::size_t size) noexcept;
  std::span<const std::byte> take(std::size_t size, std::string_view name);
  /// In the machine's byte order.
  void copy(std::span<const std::byte> from, std::span<std::byte> to) const noexcept;
  [[noreturn]] void fail_at(std::size_t needed, std::string_view name) const;

  std::span<const std::byte> body_;  ///< after the first four
  std::string_view what_;
  std::size_t at_ = 0;  ///< may lie beyond the end by alignment; then nothing more can be taken
  bool swap_ = false;
};

}  // namespace depthgrid::messages
