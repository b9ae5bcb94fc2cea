// Text of lines and words, as lists of images and trajectories are. Internal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/text_encoding.hpp"

namespace depthgrid::files {

/// Where something stands in a text: "poses.txt: line 7: ".
struct LinePlace {
  const std::string& name;
  std::size_t line = 0;  ///< from 1
};

template <class... Parts>
[[noreturn]] void fail_at_line(const LinePlace& place, const Parts&... parts) {
  fail(place.name, ": line ", place.line, ": ", parts...);
}

/// The words between blanks; what follows a word that begins with # is a comment.
inline std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(kBlank); begin != std::string_view::npos && line[begin] != '#';) {
    const std::size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlank, end);
  }
  return words;
}

/// Calls take(place, words) for every line that has any.
template <class Take>
void for_each_line(std::string_view text, const std::string& name, const Take& take) {
  text = without_byte_order_mark(text, name + ": ");
  LinePlace place{name};
  while (!text.empty()) {
    ++place.line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (const auto words = words_of(text.substr(0, end)); !words.empty()) {
      take(place, words);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// A time stamp in seconds, at most 1e11 from 0: what is larger was written in another unit. Throws Error.
double time_of(const LinePlace& place, std::string_view word);

}  // namespace depthgrid::files
