#include "lab/measure/json_file.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::lab {

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void write_json_file(const std::filesystem::path& file, const Json& json) {
  files::write_text_file(file, json.dump(1) + "\n");
}

Json read_json_file(const std::filesystem::path& file, std::string_view what, std::initializer_list<const char*> keys) {
  Json json = Json::parse(files::read_text_file(file), nullptr, false);
  if (!json.is_object() ||
      !std::all_of(keys.begin(), keys.end(), [&](const char* key) { return json.contains(key); })) {
    fail(file.string(), ": is no ", what);
  }
  return json;
}

}  // namespace depthgrid::lab
