// JSON files of the lab: figures, and the states from which long campaigns go on.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string_view>

namespace depthgrid::lab {

/// The keys keep their order.
using Json = nlohmann::ordered_json;

/// Null for what JSON cannot hold.
[[nodiscard]] Json finite(double value);

/// The file is written whole or not at all, with one blank a level. Throws Error that names it.
void write_json_file(const std::filesystem::path& file, const Json& json);

/// Throws Error "FILE: is no WHAT" unless the file can be read and holds an object with these keys. What the keys hold
/// is checked by those who read them: Json's own exceptions.
[[nodiscard]] Json read_json_file(const std::filesystem::path& file, std::string_view what,
                                  std::initializer_list<const char*> keys);

}  // namespace depthgrid::lab
