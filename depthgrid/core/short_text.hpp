// A sentence in a buffer of somebody else: no allocation, and an end where the buffer ends. Internal.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <system_error>

namespace depthgrid {

class ShortText {
 public:
  explicit ShortText(std::span<char> buffer) noexcept : buffer_(buffer) {}

  ShortText& add(std::string_view words) noexcept {
    const std::size_t room = std::min(words.size(), buffer_.size() - used_);
    std::copy_n(words.begin(), room, buffer_.begin() + static_cast<std::ptrdiff_t>(used_));
    used_ += room;
    return *this;
  }
  /// Three digits; "?" where there is no number.
  ShortText& add(double value, std::string_view unit) noexcept {
    std::array<char, 32> digits{};
    const auto [end, error] =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 3);
    const bool readable = std::isfinite(value) && error == std::errc{};
    return readable ? add({digits.data(), static_cast<std::size_t>(end - digits.data())}).add(unit)
                    : add("?").add(unit);
  }
  /// All digits.
  template <class Integer>
  ShortText& add_count(Integer value) noexcept {
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc{} ? add({digits.data(), static_cast<std::size_t>(end - digits.data())}) : add("?");
  }
  [[nodiscard]] std::string_view text() const noexcept { return {buffer_.data(), used_}; }

 private:
  std::span<char> buffer_;
  std::size_t used_ = 0;
};

}  // namespace depthgrid
