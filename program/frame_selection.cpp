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

struct Range {
  long from = 0;
  long to = 0;
  long step = 1;
};

/// Within first ... last; an empty text is all of it.
std::vector<Range> ranges_of(const std::string& text, long first, long last) {
  if (text.empty()) {
    return {{first, last, 1}};
  }
  std::vector<Range> ranges;
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
    ranges.push_back({from, to, step});
  }
  return ranges;
}

/// Numbers of all ranges, ascending, without repetition.
std::vector<int> frame_numbers_of(const std::vector<Range>& ranges) {
  constexpr std::size_t kMostFrames = 10'000'000;
  std::vector<int> frames;
  for (const Range& range : ranges) {
    for (long n = range.from; n <= range.to; n += range.step) {
      if (frames.size() == kMostFrames) {
        fail_usage("--frames: more than ", kMostFrames,
                   " frames; choose fewer, for instance every tenth, 0:1000000:10");
      }
      frames.push_back(static_cast<int>(n));
    }
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

}  // namespace

std::vector<int> select_frames(const std::string& text, int first, int count) {
  return frame_numbers_of(ranges_of(text, first, static_cast<long>(first) + count - 1));
}

std::vector<int> select_frames(const std::string& text, const files::Recording& recording) {
  const int count = recording.frame_count();
  const int first = recording.frame_number(0);
  const int last = recording.frame_number(count - 1);
  if (last - first == count - 1) {
    std::vector<int> indices = select_frames(text, first, count);
    std::for_each(indices.begin(), indices.end(), [first](int& index) { index -= first; });
    return indices;
  }
  const std::vector<Range> ranges = ranges_of(text, first, last);
  std::vector<int> indices;
  for (int index = 0; index < count; ++index) {
    const long number = recording.frame_number(index);
    if (std::any_of(ranges.begin(), ranges.end(), [number](const Range& range) {
          return number >= range.from && number <= range.to && (number - range.from) % range.step == 0;
        })) {
      indices.push_back(index);
    }
  }
  for (const Range& range : ranges) {
    const bool is_there = std::any_of(indices.begin(), indices.end(), [&](int index) {
      return recording.frame_number(index) >= range.from && recording.frame_number(index) <= range.to;
    });
    if (!is_there) {
      fail_usage("--frames ", text, ": the recording has no frame from ", range.from, " to ", range.to, " (every ",
                 range.step, "th); its numbers have gaps");
    }
  }
  return indices;
}

}  // namespace depthgrid::program
