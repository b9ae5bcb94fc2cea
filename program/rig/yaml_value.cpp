#include "program/rig/yaml_value.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <optional>
#include <utility>

#include "depthgrid/cell/guarded_yaml.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::program {

namespace {

/// Runs what may throw the parser's own exceptions.
template <class Call>
auto guarded(const std::string& context, const Call& call) {
  try {
    return call();
  } catch (const YAML::Exception& error) {
    cell::fail_yaml(context, error);
  }
}

}  // namespace

YamlValue::YamlValue(const YAML::Node& node, std::string name, std::string place)
    : node_(node), name_(std::move(name)), place_(std::move(place)) {}

YamlValue::YamlValue(std::string_view text, const std::string& name) : name_(name) {
  node_.reset(cell::guarded_yaml(text, name, "a calibration"));
}

std::string YamlValue::context() const { return name_ + ": " + (place_.empty() ? "" : place_ + ": "); }

bool YamlValue::has(const char* key) const {
  const YAML::Node& node = node_;  // of a constant node, asking for a key adds none
  return node.IsMap() && guarded(context(), [&] { return node[key].IsDefined(); });
}

YamlValue YamlValue::at(const char* key) const {
  if (!has(key)) {
    fail(context(), "'", key, "' is missing");
  }
  const YAML::Node& node = node_;
  return {node[key], name_, place_.empty() ? key : place_ + "/" + key};
}

std::string YamlValue::text() const {
  if (!node_.IsScalar()) {
    fail(context(), "must be a text or a number");
  }
  const std::string& text = node_.Scalar();
  if (!is_printable(text)) {
    fail(context(), "'", cell::shortened_yaml(text),
         "' holds a control character or a byte that is no UTF-8, must be one line");
  }
  return text;
}

double YamlValue::number() const {
  const std::string word = text();
  const std::optional<double> value = parse_number<double>(word);
  if (!value || !std::isfinite(*value)) {
    fail(context(), "'", cell::shortened_yaml(word), "' must be a finite number");
  }
  return *value;
}

int YamlValue::whole_number(int least, int most) const {
  const double value = number();
  if (!(value >= least && value <= most) || value != std::floor(value)) {
    fail(context(), value, " must be a whole number from ", least, " to ", most);
  }
  return static_cast<int>(value);
}

std::vector<YamlValue> YamlValue::elements() const {
  if (!node_.IsSequence()) {
    fail(context(), "must be a list");
  }
  std::vector<YamlValue> result;
  for (const YAML::Node& element : node_) {
    result.push_back({element, name_, place_ + "/" + std::to_string(result.size())});
  }
  return result;
}

std::vector<double> YamlValue::numbers(std::size_t count) const {
  std::vector<double> result;
  for (const YamlValue& element : elements()) {
    if (element.node_.IsSequence()) {
      for (const YamlValue& inner : element.elements()) {
        result.push_back(inner.number());
      }
    } else {
      result.push_back(element.number());
    }
  }
  if (count != 0 && result.size() != count) {
    fail(context(), "has ", result.size(), " numbers, must have ", count);
  }
  return result;
}

bool YamlValue::is_map() const { return node_.IsMap(); }

}  // namespace depthgrid::program
