#include "program/frame_selection.hpp"

#include <algorithm>
#include <string_view>

#include "depthgrid/core/number_parsing.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

long frame_number(const std::string& text, const std::string& whole) {
  const auto value = parse_number<long>(text);
  if (!value) {
    fail_usage("--frames ", whole, ": '", text, "' is not a frame number; write 5, 0:80, 0:80:8 or 1,4,9");
  }
  return *value;
}

/// The parts between the separators, without the blanks around them; an empty text has one empty part.
std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.emplace_back(trimmed(text.substr(begin, end - begin)));
    if (end == text.size()) {
      return parts;
    }
    begin = end + 1;
  }
}

}  // namespace

std::vector<int> select_frames(const std::string& text, int first, int count) {
  const long last = static_cast<long>(first) + count - 1;
  std::vector<int> frames;
  if (text.empty()) {
    for (long n = first; n <= last; ++n) {
      frames.push_back(static_cast<int>(n));
    }
    return frames;
  }
  for (const std::string& part : split(text, ',')) {
    const auto range = split(part, ':');
    if (range.size() > 3) {
      fail_usage("--frames ", text, ": '", part, "' has more than first:last:step");
    }
    const long from = frame_number(range[0], text);
    const long to = range.size() > 1 ? frame_number(range[1], text) : from;
    const long step = range.size() > 2 ? frame_number(range[2], text) : 1;
    if (from > to || step < 1) {
      fail_usage("--frames ", text, ": '", part, "' needs first <= last and step >= 1");
    }
    if (from < first || to > last) {
      fail_usage("--frames ", text, ": the recording has frames ", first, " to ", last);
    }
    for (long n = from; n <= to; n += step) {
      frames.push_back(static_cast<int>(n));
    }
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

}  // namespace depthgrid::program
