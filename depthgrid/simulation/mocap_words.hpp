// The words of a text, with the line that each stands on. Internal to the reading of motion files. Internal.
#pragma once

#include <Eigen/Core>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/text_encoding.hpp"

namespace depthgrid::simulation {

/// Reads word by word; from a '#' on a line is a remark.
class MocapWords {
 public:
  MocapWords(std::string_view text, std::string name)
      : text_(without_byte_order_mark(text, name + ": ")), name_(std::move(name)) {
    advance();
  }

  [[nodiscard]] bool at_end() const noexcept { return word_.empty(); }
  [[nodiscard]] std::string_view peek() const noexcept { return word_; }
  /// Whether the word in peek() is on the same line as the one taken last.
  [[nodiscard]] bool on_same_line() const noexcept { return !at_end() && line_ == taken_line_; }

  std::string take() {
    if (at_end()) {
      refuse("ends too early");
    }
    std::string taken(word_);
    taken_line_ = line_;
    advance();
    return taken;
  }
  bool take_if(std::string_view word) {
    if (word_ != word) {
      return false;
    }
    (void)take();
    return true;
  }
  double take_number() {
    const std::string word = take();
    double value = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (problem != std::errc() || end != word.data() + word.size() || !(std::abs(value) < 1e9)) {
      refuse("'" + printable_excerpt(word) + "' is no number below 1e9");
    }
    return value;
  }
  Eigen::Vector3d take_vector() {
    const double x = take_number();
    const double y = take_number();
    return {x, y, take_number()};
  }

  [[noreturn]] void refuse(const std::string& why) const { fail(name_, ", line ", taken_line_, ": ", why); }

 private:
  static bool is_space(char c) noexcept { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  void advance() {
    while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == '#')) {
      if (text_[at_] == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') {
          ++at_;
        }
      } else {
        line_ += text_[at_] == '\n' ? 1 : 0;
        ++at_;
      }
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) {
      ++at_;
    }
    word_ = text_.substr(begin, at_ - begin);
  }

  std::string_view text_;
  std::string name_;
  std::string_view word_;
  std::size_t at_ = 0;
  int line_ = 1;
  int taken_line_ = 1;
};

}  // namespace depthgrid::simulation
