#include <rapidjson/error/en.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/text_encoding.hpp"
#include "depthgrid/files/json_check.hpp"

namespace depthgrid::files {
namespace {

constexpr int kDeepestNesting = 32;

// Iterative, so that no text can exhaust the stack. Numbers come as text, because RapidJSON 1.1 leaves its own exact
// conversion undefined for zeros such as 0e9.
constexpr unsigned kFlags =
    rapidjson::kParseIterativeFlag | rapidjson::kParseValidateEncodingFlag | rapidjson::kParseNumbersAsStringsFlag;

/// Passes what the reader finds on to a document, converts numbers and stops at the first bracket that is nested too
/// deeply: what comes later (schema validation, writing excerpts) is recursive.
class DocumentBuilder {
 public:
  explicit DocumentBuilder(rapidjson::Document& document) : document_(document) {}

  [[nodiscard]] const char* refusal() const noexcept { return refusal_; }

  bool Null() { return document_.Null(); }
  bool Bool(bool value) { return document_.Bool(value); }
  bool String(const char* text, rapidjson::SizeType length, bool copy) { return document_.String(text, length, copy); }
  bool Key(const char* text, rapidjson::SizeType length, bool copy) { return document_.Key(text, length, copy); }
  bool StartObject() { return descend() && document_.StartObject(); }
  bool StartArray() { return descend() && document_.StartArray(); }
  bool EndObject(rapidjson::SizeType members) {
    --depth_;
    return document_.EndObject(members);
  }
  bool EndArray(rapidjson::SizeType elements) {
    --depth_;
    return document_.EndArray(elements);
  }

  bool RawNumber(const char* text, rapidjson::SizeType length, bool /*copy*/) {
    const char* end = text + length;
    std::int64_t integer = 0;
    if (const auto read = std::from_chars(text, end, integer); read.ec == std::errc() && read.ptr == end) {
      return document_.Int64(integer);
    }
    double number = 0;
    if (std::from_chars(text, end, number).ec != std::errc()) {
      refusal_ = "Number out of the range of double precision.";
      return false;
    }
    return document_.Double(number);
  }

  // Not called where numbers come as text.
  // NOLINTBEGIN(readability-convert-member-functions-to-static): the reader calls them on an object
  bool Int(int /*value*/) { return false; }
  bool Uint(unsigned /*value*/) { return false; }
  bool Int64(std::int64_t /*value*/) { return false; }
  bool Uint64(std::uint64_t /*value*/) { return false; }
  bool Double(double /*value*/) { return false; }
  // NOLINTEND(readability-convert-member-functions-to-static)

 private:
  bool descend() {
    refusal_ = "Nested deeper than 32 levels.";
    return ++depth_ <= kDeepestNesting;
  }

  rapidjson::Document& document_;
  const char* refusal_ = "";
  int depth_ = 0;
};

/// What stands around `column` (from 0) of a line, fit for a message.
std::string surroundings(std::string_view line, std::size_t column) {
  constexpr std::size_t kBefore = 20;
  constexpr std::size_t kLength = 40;
  std::string text(line.substr(std::min(line.size(), column - std::min(column, kBefore)), kLength));
  for (char& c : text) {
    c = static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f ? '?' : c;
  }
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  return text;
}

[[noreturn]] void fail_at(std::string_view text, std::size_t offset, const std::string& name, const char* what) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 = 0
  const std::size_t column = before.size() - line_begin;
  const std::string_view rest = text.substr(line_begin);
  const std::string place = surroundings(rest.substr(0, rest.find('\n')), column);
  fail(name, ": line ", line, ", column ", column + 1, ": JSON syntax: ", what, place.empty() ? "" : " Near: " + place);
}

}  // namespace

rapidjson::Document parse_json(std::string_view text, const std::string& name) {
  text = without_byte_order_mark(text, name + ": ");
  // RapidJSON takes a NUL for the end of the text and would not see what stands behind it.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    fail_at(text, nul, name, "A NUL byte.");
  }
  rapidjson::Document document;
  const auto read = [&](rapidjson::Document& target) {
    DocumentBuilder builder(target);
    rapidjson::MemoryStream stream(text.data(), text.size());
    rapidjson::Reader reader;
    const rapidjson::ParseResult result = reader.Parse<kFlags>(stream, builder);
    if (result.IsError()) {
      const bool refused = result.Code() == rapidjson::kParseErrorTermination;
      fail_at(text, result.Offset(), name, refused ? builder.refusal() : rapidjson::GetParseError_En(result.Code()));
    }
    return true;
  };
  document.Populate(read);
  return document;
}

}  // namespace depthgrid::files
