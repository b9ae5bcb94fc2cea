#include "depthgrid/files/json_check.hpp"

#include <rapidjson/pointer.h>
#include <rapidjson/schema.h>
#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::files {
namespace {

using rapidjson::Value;

std::string_view text_of(const Value& string) { return {string.GetString(), string.GetStringLength()}; }

std::string pointer_text(const rapidjson::Pointer& pointer) {
  rapidjson::StringBuffer buffer;
  pointer.Stringify(buffer);
  return buffer.GetSize() == 0 ? "top level" : std::string(buffer.GetString(), buffer.GetSize());
}

/// Number of inserted, removed or changed characters between two keys.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({row[j] + 1, row[j + 1] + 1, changed}));
    }
  }
  return row.back();
}

/// "did you mean ..." where a known key is near, else all known keys.
std::string suggestion(std::string_view key, const Value& properties) {
  constexpr std::size_t kLongestTypo = 64;  // keeps the comparison short for absurd keys
  std::string known;
  std::string_view nearest;
  std::size_t least = std::max<std::size_t>(2, key.size() / 3) + 1;
  for (const auto& property : properties.GetObject()) {
    const std::string_view candidate = text_of(property.name);
    known.append(known.empty() ? "" : ", ").append(candidate);
    const std::size_t distance = key.size() <= kLongestTypo ? edit_distance(key, candidate) : least;
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest.empty() ? "known keys are " + known : "did you mean '" + std::string(nearest) + "'?";
}

/// Walks document and schema together and refuses keys that the schema does not list. The schema's own
/// additionalProperties would stop at the same place but does not name the key.
class KeyCheck {
 public:
  KeyCheck(const Value& schema_root, const std::string& name) : schema_root_(schema_root), name_(name) {}

  void walk(const Value& value, const Value& schema, const rapidjson::Pointer& place) const {
    const Value& rules = resolve(schema);
    const auto properties = rules.FindMember("properties");
    const auto items = rules.FindMember("items");
    if (value.IsObject() && properties != rules.MemberEnd()) {
      walk_object(value, properties->value, place);
    } else if (value.IsArray() && items != rules.MemberEnd()) {
      for (rapidjson::SizeType k = 0; k < value.Size(); ++k) {
        walk(value[k], items->value, place.Append(k));
      }
    }
  }

 private:
  void walk_object(const Value& object, const Value& properties, const rapidjson::Pointer& place) const {
    std::set<std::string_view> seen;
    for (const auto& member : object.GetObject()) {
      const std::string_view key = text_of(member.name);
      const auto property = properties.FindMember(member.name);
      if (property == properties.MemberEnd()) {
        fail(name_, ": ", pointer_text(place), ": unknown key ", excerpt(member.name), ", ",
             suggestion(key, properties));
      }
      if (!seen.insert(key).second) {
        fail(name_, ": ", pointer_text(place), ": key ", excerpt(member.name), " occurs twice");
      }
      walk(member.value, property->value, place.Append(member.name.GetString(), member.name.GetStringLength()));
    }
  }

  [[nodiscard]] const Value& resolve(const Value& schema) const {
    const auto reference = schema.FindMember("$ref");
    if (reference == schema.MemberEnd()) {
      return schema;
    }
    const rapidjson::Pointer pointer(reference->value.GetString(), reference->value.GetStringLength());
    const Value* target = pointer.Get(schema_root_);
    return target != nullptr ? *target : schema;
  }

  const Value& schema_root_;
  const std::string& name_;
};

/// What our schema says beside its rules about values that break them.
std::string hint_of(const Value& rules, const std::string& keyword) {
  const auto hints = rules.FindMember("hints");
  if (hints == rules.MemberEnd() || !hints->value.IsObject() || !hints->value.HasMember(keyword.c_str())) {
    return {};
  }
  return "; " + std::string(text_of(hints->value[keyword.c_str()]));
}

/// What the schema says under the keyword that failed, and for `required` which key is missing.
std::string broken_rule(const Value& value, const Value* rules, const std::string& keyword) {
  if (rules == nullptr || !rules->IsObject() || !rules->HasMember(keyword.c_str())) {
    return "value " + excerpt(value) + " breaks the rule \"" + keyword + "\"";
  }
  const Value& rule = (*rules)[keyword.c_str()];
  if (keyword == "required" && value.IsObject()) {
    for (const Value& key : rule.GetArray()) {
      if (!value.HasMember(key)) {
        return "key " + excerpt(key) + " is missing (rule \"required\")";
      }
    }
  }
  const bool exclusive = keyword == "minimum" && rules->HasMember("exclusiveMinimum");
  return "value " + excerpt(value) + " breaks the rule \"" + keyword + "\": " + excerpt(rule) +
         (exclusive ? " (exclusive)" : "") + hint_of(*rules, keyword);
}

}  // namespace

std::string excerpt(const Value& value) {
  constexpr std::size_t kLongest = 60;
  rapidjson::StringBuffer buffer;
  rapidjson::Writer<rapidjson::StringBuffer> writer(buffer);
  value.Accept(writer);
  std::string text = printable({buffer.GetString(), buffer.GetSize()});  // an escaped half of a surrogate is no UTF-8
  if (text.size() > kLongest) {
    std::size_t end = kLongest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
      --end;  // not inside a UTF-8 character
    }
    text.resize(end);
    text += "...";
  }
  return text;
}

void check_schema(const rapidjson::Document& document, const rapidjson::Document& schema, const std::string& name) {
  KeyCheck(schema, name).walk(document, schema, rapidjson::Pointer());
  const rapidjson::SchemaDocument rules(schema);
  rapidjson::SchemaValidator validator(rules);
  if (document.Accept(validator)) {
    return;
  }
  const rapidjson::Pointer place = validator.GetInvalidDocumentPointer();
  const Value* value = place.Get(document);
  fail(name, ": ", pointer_text(place), ": ",
       broken_rule(value != nullptr ? *value : document, validator.GetInvalidSchemaPointer().Get(schema),
                   validator.GetInvalidSchemaKeyword()));
}

}  // namespace depthgrid::files
