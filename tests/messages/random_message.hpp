// Messages with random contents, and CDR of either byte order written by other code than the library's.
#pragma once

#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "depthgrid/messages/cdr_reader.hpp"
#include "depthgrid/messages/fields.hpp"

namespace depthgrid::test {

/// Fills the fields of a message. Bytes of images lie in `bytes`, which must outlive the message.
class RandomFields {
 public:
  RandomFields(std::mt19937_64& random, std::vector<std::vector<std::byte>>& bytes) : random_(random), bytes_(bytes) {
    bytes_.reserve(1000);
  }

  template <messages::CdrNumber Number>
  void operator()(const char* /*name*/, Number& value) {
    if constexpr (std::is_floating_point_v<Number>) {
      constexpr Number kSpecial[] = {0, -1, 1e-40F, std::numeric_limits<Number>::infinity(), 3.5F};
      value = below(4) == 0 ? kSpecial[below(5)] : static_cast<Number>(std::normal_distribution<>()(random_));
    } else {
      value = static_cast<Number>(random_());
    }
  }
  void operator()(const char* /*name*/, bool& value) { value = below(2) == 1; }
  void operator()(const char* /*name*/, std::string& value) {
    value.resize(below(12));
    for (char& c : value) {
      c = static_cast<char>('a' + below(26));
    }
  }
  void operator()(const char* /*name*/, std::span<const std::byte>& value) {
    std::vector<std::byte>& own = bytes_.emplace_back(below(40));
    for (std::byte& byte : own) {
      byte = static_cast<std::byte>(random_());
    }
    value = own;
  }
  template <class Element, std::size_t N>
  void operator()(const char* name, std::array<Element, N>& values) {
    for (Element& value : values) {
      (*this)(name, value);
    }
  }
  template <class Element>
  void operator()(const char* name, std::vector<Element>& values) {
    values.resize(below(4));
    for (Element& value : values) {
      (*this)(name, value);
    }
  }
  template <class Message>
  void operator()(const char* /*name*/, Message& message) {
    fields(*this, message);
  }

 private:
  std::uint64_t below(std::uint64_t end) { return random_() % end; }

  std::mt19937_64& random_;
  std::vector<std::vector<std::byte>>& bytes_;
};

/// The rules of XCDR1 once more, with little thought of speed.
class TwinWriter {
 public:
  explicit TwinWriter(bool big) : big_(big) {}

  template <messages::CdrNumber Number>
  void operator()(const char* /*name*/, const Number& value) {
    while (body_.size() % sizeof(Number) != 0) {
      body_.push_back('\0');
    }
    std::string raw(sizeof(Number), '\0');
    std::memcpy(raw.data(), &value, sizeof(Number));
    if (big_ == (std::endian::native == std::endian::little)) {
      raw.assign(raw.rbegin(), raw.rend());
    }
    body_ += raw;
  }
  void operator()(const char* /*name*/, const bool& value) { body_.push_back(value ? '\1' : '\0'); }
  void operator()(const char* name, const std::string& value) {
    (*this)(name, static_cast<std::uint32_t>(value.size() + 1));
    body_.append(value.c_str(), value.size() + 1);
  }
  void operator()(const char* name, const std::span<const std::byte>& value) {
    (*this)(name, static_cast<std::uint32_t>(value.size()));
    body_.append(reinterpret_cast<const char*>(value.data()), value.size());
  }
  template <class Element, std::size_t N>
  void operator()(const char* name, const std::array<Element, N>& values) {
    for (const Element& value : values) {
      (*this)(name, value);
    }
  }
  template <class Element>
  void operator()(const char* name, const std::vector<Element>& values) {
    (*this)(name, static_cast<std::uint32_t>(values.size()));
    for (const Element& value : values) {
      (*this)(name, value);
    }
  }
  template <class Message>
  void operator()(const char* /*name*/, const Message& message) {
    fields(*this, message);
  }

  [[nodiscard]] std::vector<std::byte> bytes() const {
    const std::string all = std::string({'\0', big_ ? '\0' : '\1', '\0', '\0'}) + body_;
    const auto* begin = reinterpret_cast<const std::byte*>(all.data());
    return {begin, begin + all.size()};
  }

 private:
  bool big_;
  std::string body_;
};

}  // namespace depthgrid::test
