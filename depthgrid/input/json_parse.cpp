#include <rapidjson/error/en.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include <algorithm>

#include "depthgrid/core/error.hpp"
#include "depthgrid/input/json_check.hpp"

namespace depthgrid::input {
namespace {

constexpr int kDeepestNesting = 32;

// Iterative, so that no text can exhaust the stack.
constexpr unsigned kFlags =
    rapidjson::kParseIterativeFlag | rapidjson::kParseValidateEncodingFlag | rapidjson::kParseFullPrecisionFlag;

/// Stops the reader at the first bracket that is nested too deeply. What comes later (schema validation, writing
/// excerpts) is recursive.
struct NestingLimit : rapidjson::BaseReaderHandler<rapidjson::UTF8<>, NestingLimit> {
  int depth = 0;
  bool StartObject() { return ++depth <= kDeepestNesting; }
  bool StartArray() { return ++depth <= kDeepestNesting; }
  bool EndObject(rapidjson::SizeType /*members*/) { return --depth >= 0; }
  bool EndArray(rapidjson::SizeType /*elements*/) { return --depth >= 0; }
};

[[noreturn]] void fail_at(std::string_view text, std::size_t offset, const std::string& name, const char* what) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 = 0
  fail(name, ": line ", line, ", column ", before.size() - line_begin + 1, ": ", what);
}

}  // namespace

rapidjson::Document parse_json(std::string_view text, const std::string& name) {
  // RapidJSON takes a NUL for the end of the text and would not see what stands behind it.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    fail_at(text, nul, name, "JSON syntax: a NUL byte");
  }
  NestingLimit limit;
  rapidjson::MemoryStream stream(text.data(), text.size());
  rapidjson::Reader reader;
  if (!reader.Parse<kFlags>(stream, limit)) {
    if (reader.GetParseErrorCode() == rapidjson::kParseErrorTermination) {
      fail_at(text, reader.GetErrorOffset(), name, "JSON is nested deeper than 32 levels");
    }
    const std::string what = std::string("JSON syntax: ") + rapidjson::GetParseError_En(reader.GetParseErrorCode());
    fail_at(text, reader.GetErrorOffset(), name, what.c_str());
  }
  rapidjson::Document document;
  document.Parse<kFlags>(text.data(), text.size());
  if (document.HasParseError()) {
    fail_at(text, document.GetErrorOffset(), name, rapidjson::GetParseError_En(document.GetParseError()));
  }
  return document;
}

}  // namespace depthgrid::input
