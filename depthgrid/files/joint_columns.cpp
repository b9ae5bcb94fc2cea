#include "depthgrid/files/joint_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "depthgrid/core/number_parsing.hpp"

namespace depthgrid::files {

namespace {

constexpr std::array<TimeUnit, 4> kTimeUnits{
    {{"seconds", 1}, {"milliseconds", 1e-3}, {"microseconds", 1e-6}, {"nanoseconds", 1e-9}}};

struct UnitWord {
  std::string_view word;
  JointUnit joint;
  int time = -1;  ///< which of the units of time; -1: none
};

constexpr std::array<UnitWord, 26> kUnitWords{{{"radians", JointUnit::radians},
                                               {"radian", JointUnit::radians},
                                               {"rad", JointUnit::radians},
                                               {"degrees", JointUnit::degrees},
                                               {"degree", JointUnit::degrees},
                                               {"deg", JointUnit::degrees},
                                               {"metres", JointUnit::metres},
                                               {"meters", JointUnit::metres},
                                               {"m", JointUnit::metres},
                                               {"nanoseconds", JointUnit::not_said, 3},
                                               {"nanosecs", JointUnit::not_said, 3},
                                               {"nanosec", JointUnit::not_said, 3},
                                               {"nsecs", JointUnit::not_said, 3},
                                               {"nsec", JointUnit::not_said, 3},
                                               {"ns", JointUnit::not_said, 3},
                                               {"microseconds", JointUnit::not_said, 2},
                                               {"usec", JointUnit::not_said, 2},
                                               {"us", JointUnit::not_said, 2},
                                               {"milliseconds", JointUnit::not_said, 1},
                                               {"msec", JointUnit::not_said, 1},
                                               {"ms", JointUnit::not_said, 1},
                                               {"seconds", JointUnit::not_said, 0},
                                               {"secs", JointUnit::not_said, 0},
                                               {"second", JointUnit::not_said, 0},
                                               {"sec", JointUnit::not_said, 0},
                                               {"s", JointUnit::not_said, 0}}};

constexpr std::array<std::string_view, 9> kTimeWords{"time",   "t",     "timestamp",       "stamp", "time_stamp",
                                                     "__time", "%time", "rosbagtimestamp", "clock"};
/// Not "index": many tables have one of their rows (pandas), which says nothing of images.
constexpr std::array<std::string_view, 4> kFrameWords{"frame", "frame_number", "frame_index", "image"};
constexpr std::array<std::string_view, 6> kPositionWords{"position", "positions", "pos",
                                                         "angle",    "q",         "actual_position"};

std::string small(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view text) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

/// Takes a unit off the end of the name: name_rad, name.rad, "name rad", name[rad], name(rad). Null: there is none.
const UnitWord* take_unit(std::string& name) {
  std::string_view text = name;
  const bool bracket = !text.empty() && (text.back() == ']' || text.back() == ')');
  text.remove_suffix(bracket ? 1 : 0);
  for (const UnitWord& unit : kUnitWords) {
    if (!text.ends_with(unit.word) || text.size() <= unit.word.size()) {
      continue;
    }
    const std::string_view before = text.substr(0, text.size() - unit.word.size());
    const std::string_view separators = bracket ? "[(" : "_. /";
    if (separators.find(before.back()) != std::string_view::npos) {
      name = std::string(trimmed(before.substr(0, before.size() - 1)));
      return &unit;
    }
  }
  return nullptr;
}

/// The parts of a path between / or dots.
std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("/."), text.size());
    if (end > 0) {
      parts.emplace_back(text.substr(0, end));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// The names of joints that a name without its unit may be: as it is, and of paths the part that counts.
void add_joint_names(const std::string& text, std::vector<std::string>& names) {
  names.push_back(text);
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() > 1 && is_one_of(kPositionWords, parts.back())) {
    names.push_back(parts[parts.size() - 2]);
  } else if (parts.size() > 1 && is_one_of(kPositionWords, parts[parts.size() - 2])) {
    names.push_back(parts.back());
  }
  for (const std::string_view word : kPositionWords) {
    if (text.size() > word.size() + 1 && text.ends_with(word) && text[text.size() - word.size() - 1] == '_') {
      names.push_back(text.substr(0, text.size() - word.size() - 1));
    }
  }
}

}  // namespace

std::span<const TimeUnit> time_units() noexcept { return kTimeUnits; }

bool ColumnName::is_of(const std::string& joint) const {
  return std::find(joints.begin(), joints.end(), small(joint)) != joints.end();
}

ColumnName column_name(const std::string& column, std::span<const std::string> joints) {
  ColumnName result;
  const std::string whole = small(column);
  result.joints.push_back(whole);
  const auto is_joint = [&] {
    return std::any_of(joints.begin(), joints.end(), [&](const std::string& joint) { return result.is_of(joint); });
  };
  if (is_joint()) {
    return result;  // m_s may be a joint
  }
  std::string bare = whole;
  const UnitWord* const unit = take_unit(bare);
  add_joint_names(bare, result.joints);
  if (unit != nullptr && unit->time < 0) {
    result.joint_unit = unit->joint;
  }
  if (is_joint()) {
    return result;
  }
  const std::vector<std::string> parts = parts_of(bare);
  const std::string last = parts.empty() ? bare : parts.back();
  const bool names_unit = std::any_of(kUnitWords.begin(), kUnitWords.end(), [&whole](const UnitWord& word) {
    return word.time >= 0 && word.word.size() > 2 && word.word == whole;
  });
  if (names_unit) {  // "secs", "nsecs"
    const auto* const word = std::find_if(kUnitWords.begin(), kUnitWords.end(),
                                          [&whole](const UnitWord& item) { return item.word == whole; });
    result.is_time = true;
    result.time_unit = &kTimeUnits.at(static_cast<std::size_t>(word->time));
  } else if (is_one_of(kTimeWords, last) || is_one_of(kTimeWords, bare)) {
    result.is_time = true;
    result.time_unit =
        unit != nullptr && unit->time >= 0 ? &kTimeUnits.at(static_cast<std::size_t>(unit->time)) : nullptr;
  }
  result.is_frame = is_one_of(kFrameWords, whole);
  return result;
}

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

}  // namespace depthgrid::files
