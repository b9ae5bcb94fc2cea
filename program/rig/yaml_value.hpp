// YAML and JSON texts of other programs, with errors that name the place. JSON is read as the YAML that it is, too.
#pragma once

#include <yaml-cpp/yaml.h>  // all of it: node/node.h alone leaves YAML::Node's inline functions undefined

#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::program {

/// A value and where it stands. Every function throws Error that names file, place and rule.
class YamlValue {
 public:
  /// The first document of a text; `name` stands for the file. Refused are texts of more than a megabyte, nested deeper
  /// than 32 or with more than 200 000 values, and aliases, with which a short text can stand for a huge one. An OpenCV
  /// file's first line, %YAML:1.0, is passed over.
  YamlValue(std::string_view text, const std::string& name);

  [[nodiscard]] bool has(const char* key) const;
  /// The value under `key`, which must be there.
  [[nodiscard]] YamlValue at(const char* key) const;
  /// One line.
  [[nodiscard]] std::string text() const;
  /// A finite number.
  [[nodiscard]] double number() const;
  /// A whole number from `least` to `most`.
  [[nodiscard]] int whole_number(int least, int most) const;
  /// A list of finite numbers, `count` of them unless that is 0. A list of lists counts as one, row after row.
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const;
  /// The elements of a list.
  [[nodiscard]] std::vector<YamlValue> elements() const;
  [[nodiscard]] bool is_map() const;
  /// "FILE: PLACE: ", for messages.
  [[nodiscard]] std::string context() const;

 private:
  YamlValue(const YAML::Node& node, std::string name, std::string place);

  YAML::Node node_;
  std::string name_;
  std::string place_;  ///< "camera_matrix/data"; empty at the top
};

}  // namespace depthgrid::program
