#include "lab/measure/json_file.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::lab {

namespace {

constexpr int kDeepestNesting = 32;

}  // namespace

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string text_of(const Json& json) { return json.dump(1) + "\n"; }

void write_json_file(const std::filesystem::path& file, const Json& json) {
  files::write_text_file(file, text_of(json));
}

Json parse_json(std::string_view text, const std::string& name, std::string_view what,
                std::initializer_list<const char*> keys) {
  const auto within_depth = [&name](int depth, Json::parse_event_t /*event*/, const Json& /*parsed*/) {
    if (depth >= kDeepestNesting) {
      fail(name, ": is nested deeper than ", kDeepestNesting, " levels");
    }
    return true;
  };
  Json json = Json::parse(text, within_depth, false);
  if (!json.is_object() ||
      !std::all_of(keys.begin(), keys.end(), [&](const char* key) { return json.contains(key); })) {
    fail(name, ": is no ", what);
  }
  return json;
}

Json read_json_file(const std::filesystem::path& file, std::string_view what, std::initializer_list<const char*> keys) {
  return parse_json(files::read_text_file(file), file.string(), what, keys);
}

void refuse_json(const std::string& name, std::string_view what, const char* reason) {
  fail(name, ": is no ", what, ": ", printable(reason));
}

std::uint64_t whole_number_of(const Json& json, std::uint64_t most) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > most) {
    fail(printable_excerpt(json.dump(-1, ' ', true)), " must be a whole number from 0 to ", most);
  }
  return json.get<std::uint64_t>();
}

std::int64_t count_of(const Json& json) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 50U;
  return static_cast<std::int64_t>(whole_number_of(json, kMost));
}

double quantity_of(const Json& json) {
  if (!json.is_number() || !(json.get<double>() >= 0)) {
    fail(printable_excerpt(json.dump(-1, ' ', true)), " must be a number from 0");
  }
  return json.get<double>();
}

}  // namespace depthgrid::lab
