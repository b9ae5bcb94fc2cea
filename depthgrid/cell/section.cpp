#include "depthgrid/cell/section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "depthgrid/cell/guarded_yaml.hpp"
#include "depthgrid/cell/nearest_name.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::cell {
namespace {

std::string at(const std::string& file, const YAML::Mark& mark) {
  return file + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1) + ": ";
}

std::string with_hint(std::string_view hint) { return hint.empty() ? "" : ": " + std::string(hint); }

std::string line_of(const YAML::Mark& mark) { return "line " + std::to_string(mark.line + 1); }

std::string scalar(const YAML::Node& node, const std::string& where, std::string_view hint) {
  if (!node.IsScalar() || node.Scalar().empty()) {
    fail(where, ": ", node.IsNull() || node.IsScalar() ? "is empty" : "must be one value", with_hint(hint));
  }
  if (!is_printable(node.Scalar())) {
    fail(where, ": holds a control character or a byte that is no UTF-8, must be one line");
  }
  return node.Scalar();
}

double finite(const YAML::Node& node, const std::string& where, std::string_view hint) {
  const std::string word = scalar(node, where, hint);
  const std::optional<double> value = parse_number<double>(word);
  if (!value || !std::isfinite(*value)) {
    fail(where, ": '", printable_excerpt(word), "' must be a finite number", with_hint(hint));
  }
  return *value;
}

}  // namespace

Section::Section(std::string_view text, const std::string& file, std::vector<ShownValue>& shown,
                 std::span<const std::string_view> known)
    : Section(guarded_yaml(text, file, "a cell file"), "", file, shown, known) {}

Section::Section(const YAML::Node& node, std::string path, std::string file, std::vector<ShownValue>& shown,
                 std::span<const std::string_view> known)
    : file_(std::move(file)), path_(std::move(path)), mark_(node.Mark()), shown_(&shown) {
  if (!node.IsMap()) {
    fail(place(), ": must be a map of keys and values", suggestion("", known));
  }
  for (const auto& item : node) {
    const YAML::Node& key = item.first;
    const std::string name = key.IsScalar() ? key.Scalar() : "";
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      fail(at(file_, key.Mark()), path_.empty() ? "" : path_ + ": ", "unknown key '", printable_excerpt(name), "'",
           suggestion(name, known));
    }
    if (has(name)) {
      fail(at(file_, key.Mark()), this->path(name), ": stands here for the second time, first in ",
           line_of(find(name)->mark), ": remove one");
    }
    entries_.push_back({name, key.Mark(), item.second});
  }
}

std::optional<Section::Entry> Section::find(std::string_view key) const {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.key == key; });
  return found == entries_.end() ? std::nullopt : std::optional(*found);
}

Section::Entry Section::need(std::string_view key, std::string_view hint) const {
  const std::optional<Entry> entry = find(key);
  if (!entry) {
    fail(place(), ": '", key, "' is missing", with_hint(hint));
  }
  return *entry;
}

std::string Section::path(std::string_view key) const {
  return path_ + (path_.empty() || key.empty() ? "" : ".") + std::string(key);
}

std::string Section::place(std::string_view key) const {
  const std::optional<Entry> entry = find(key);
  const std::string name = path(entry ? key : std::string_view());
  return at(file_, entry ? entry->mark : mark_) + (name.empty() ? "the file" : name);
}

void Section::show(std::string_view key, const std::string& value, std::string_view unit,
                   const std::string& origin) const {
  shown_->push_back({path(key), value, std::string(unit), origin});
}

Section Section::map(std::string_view key, std::span<const std::string_view> known, std::string_view hint) const {
  const Entry entry = need(key, hint);
  if (!entry.value.IsMap()) {
    refuse(key, "must be a map of keys and values", with_hint(hint));
  }
  return {entry.value, path(key), file_, *shown_, known};
}

Section Section::map_or_empty(std::string_view key, std::span<const std::string_view> known) const {
  return has(key) ? map(key, known, "") : Section(YAML::Node(YAML::NodeType::Map), path(key), file_, *shown_, known);
}

std::vector<Section> Section::maps(std::string_view key, std::span<const std::string_view> known,
                                   std::string_view hint) const {
  const Entry entry = need(key, hint);
  if (!entry.value.IsSequence() || entry.value.size() == 0) {
    refuse(key, "must be a list with at least one entry, each begun by '- '", with_hint(hint));
  }
  std::vector<Section> result;
  for (const YAML::Node& element : entry.value) {
    result.push_back(Section(element, path(key) + "[" + std::to_string(result.size()) + "]", file_, *shown_, known));
  }
  return result;
}

bool Section::is_map(std::string_view key) const {
  const std::optional<Entry> entry = find(key);
  return entry && entry->value.IsMap();
}

bool Section::is_list(std::string_view key) const {
  const std::optional<Entry> entry = find(key);
  return entry && entry->value.IsSequence();
}

std::string Section::text(std::string_view key, std::string_view hint,
                          std::optional<std::string_view> otherwise) const {
  if (otherwise && !has(key)) {
    if (!otherwise->empty()) {
      show(key, std::string(*otherwise), "", "default");
    }
    return std::string(*otherwise);
  }
  const Entry entry = need(key, hint);
  std::string result = scalar(entry.value, place(key), hint);
  show(key, result, "", line_of(entry.mark));
  return result;
}

std::string Section::word(std::string_view key, std::span<const std::string_view> words, std::string_view hint,
                          std::optional<std::string_view> otherwise) const {
  if (otherwise && !has(key)) {
    return text(key, hint, otherwise);
  }
  const Entry entry = need(key, hint);
  std::string value = scalar(entry.value, place(key), hint);
  if (std::find(words.begin(), words.end(), value) == words.end()) {
    refuse(key, "'", printable_excerpt(value), "' is not known", suggestion(value, words));
  }
  show(key, value, "", line_of(entry.mark));
  return value;
}

bool Section::yes(std::string_view key, bool otherwise) const {
  constexpr std::array<std::string_view, 2> kWords{"true", "false"};
  return word(key, kWords, "true or false", otherwise ? "true" : "false") == "true";
}

double Section::number(std::string_view key, const Range& range, std::string_view unit, std::string_view hint,
                       std::optional<double> otherwise) const {
  if (otherwise && !has(key)) {
    show(key, number_text(*otherwise), unit, "default");
    return *otherwise;
  }
  const Entry entry = need(key, hint);
  const double value = finite(entry.value, place(key), hint);
  if (!(value <= range.most) || !(range.above ? value > range.least : value >= range.least)) {
    refuse(key, number_text(value), " ", unit, unit.empty() ? "" : " ", "must be ",
           range.above ? "above " : "at least ", number_text(range.least), " and at most ", number_text(range.most),
           with_hint(hint));
  }
  show(key, number_text(value), unit, line_of(entry.mark));
  return value;
}

std::optional<double> Section::number_if(std::string_view key, const Range& range, std::string_view unit) const {
  return has(key) ? std::optional(number(key, range, unit, "")) : std::nullopt;
}

int Section::whole(std::string_view key, int least, int most, std::string_view unit, std::string_view hint) const {
  const double value = number(key, {static_cast<double>(least), static_cast<double>(most), false}, unit, hint);
  if (value != std::floor(value)) {
    refuse(key, number_text(value), " must be a whole number", with_hint(hint));
  }
  return static_cast<int>(value);
}

std::vector<double> Section::numbers(std::string_view key, std::size_t count, double most, std::string_view unit,
                                     std::string_view hint) const {
  const Entry entry = need(key, hint);
  if (!entry.value.IsSequence()) {
    refuse(key, "must be a list of ", count, " numbers in [ ]", with_hint(hint));
  }
  if (entry.value.size() != count) {
    refuse(key, "has ", entry.value.size(), " numbers, must have ", count, with_hint(hint));
  }
  std::vector<double> result;
  std::string value;
  for (const YAML::Node& element : entry.value) {
    result.push_back(finite(element, place(key), hint));
    if (!(std::abs(result.back()) <= most)) {
      refuse(key, number_text(result.back()), " must be within +-", number_text(most), with_hint(hint));
    }
    value += (value.empty() ? "" : ", ") + number_text(result.back());
  }
  show(key, value, unit, line_of(entry.mark));
  return result;
}

Eigen::Vector3d Section::vector(std::string_view key, std::string_view hint) const {
  constexpr double kFarthest_m = 1e5;
  const std::vector<double> value = numbers(key, 3, kFarthest_m, "m", hint);
  return {value[0], value[1], value[2]};
}

std::vector<std::string> Section::texts(std::string_view key, std::string_view hint) const {
  const Entry entry = need(key, hint);
  if (!entry.value.IsSequence() || entry.value.size() == 0) {
    refuse(key, "must be a list of names in [ ]", with_hint(hint));
  }
  std::vector<std::string> result;
  std::string value;
  for (const YAML::Node& element : entry.value) {
    result.push_back(scalar(element, place(key), hint));
    value += (value.empty() ? "" : ", ") + result.back();
  }
  show(key, value, "", line_of(entry.mark));
  return result;
}

}  // namespace depthgrid::cell
