// JSON files of the lab: figures, and the states from which long campaigns go on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace depthgrid::lab {

/// The keys keep their order.
using Json = nlohmann::ordered_json;

/// Null for what JSON cannot hold.
[[nodiscard]] Json finite(double value);

/// As it is written, with one blank a level.
[[nodiscard]] std::string text_of(const Json& json);

/// The file is written whole or not at all. Throws Error that names it.
void write_json_file(const std::filesystem::path& file, const Json& json);

/// A JSON text. Throws Error "NAME: is no WHAT" unless it is one and holds an object with these keys, "NAME: is nested
/// deeper than 32 levels" where that is so, before anything is built of it. What the keys hold is checked by those who
/// read them, within taken_apart().
[[nodiscard]] Json parse_json(std::string_view text, const std::string& name, std::string_view what,
                              std::initializer_list<const char*> keys);

/// The same of a file, which may have up to 64 MB.
[[nodiscard]] Json read_json_file(const std::filesystem::path& file, std::string_view what,
                                  std::initializer_list<const char*> keys);

/// "NAME: is no WHAT: REASON", as an Error of one line.
[[noreturn]] void refuse_json(const std::string& name, std::string_view what, const char* reason);

/// Calls take(), which takes a JSON text apart. What it throws becomes an Error "NAME: is no WHAT: REASON".
template <class Take>
auto taken_apart(const std::string& name, std::string_view what, const Take& take) {
  try {
    return take();
  } catch (const std::exception& error) {
    refuse_json(name, what, error.what());
  }
}

/// A whole number from 0 to `most`. Json's own conversion takes truths, cuts fractions off and wraps what is too large.
/// Throws Error.
[[nodiscard]] std::uint64_t whole_number_of(const Json& json, std::uint64_t most);

/// How often something was seen: so small that counts of many files can be added.
[[nodiscard]] std::int64_t count_of(const Json& json);

/// A number that is not negative. Throws Error.
[[nodiscard]] double quantity_of(const Json& json);

}  // namespace depthgrid::lab
