// YAML that others wrote, read within limits. JSON is read as the YAML that it is, too. Internal.
#pragma once

#include <yaml-cpp/yaml.h>  // all of it: node/node.h alone leaves YAML::Node's inline functions undefined

#include <string>
#include <string_view>

namespace depthgrid::cell {

/// The first document of a text; `name` stands for the file, `what` for its kind ("a calibration"). Refused with Error
/// are texts of more than a megabyte, nested deeper than 32 or with more than 200 000 values, and aliases, with which a
/// short text can stand for a huge one. An OpenCV file's first line, %YAML:1.0, is passed over.
[[nodiscard]] YAML::Node guarded_yaml(std::string_view text, const std::string& name, std::string_view what);

/// Throws Error for the parser's own exception: "CONTEXTline 3, column 7: no YAML or JSON: ...".
[[noreturn]] void fail_yaml(const std::string& context, const YAML::Exception& error);

/// On one line, fit for a message.
[[nodiscard]] std::string shortened_yaml(std::string text);

}  // namespace depthgrid::cell
