// JSON text to a document that obeys a schema, with errors that name the place. Not part of the installed headers.
// Internal.
#pragma once

#include <rapidjson/document.h>

#include <string>
#include <string_view>

namespace depthgrid::files {

/// Parses strict JSON (UTF-8, no comments, no NaN). Throws Error with name, line and column, also where objects and
/// arrays are nested deeper than 32.
rapidjson::Document parse_json(std::string_view text, const std::string& name);

/// Throws Error unless `document` obeys the JSON schema (draft 4, with references inside the schema only). The error
/// names the place as a JSON pointer, the value and the schema's keyword; of an unknown key the nearest known one. Keys
/// that stand twice in an object described by the schema are refused, too.
void check_schema(const rapidjson::Document& document, const rapidjson::Document& schema, const std::string& name);

/// The value as one line of JSON, cut off after some 60 characters.
std::string excerpt(const rapidjson::Value& value);

}  // namespace depthgrid::files
