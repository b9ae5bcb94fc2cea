#include "program/rig/yaml_value.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/text_encoding.hpp"

namespace depthgrid::program {

namespace {

constexpr std::size_t kLargestText = std::size_t{1} << 20;
constexpr int kDeepest = 32;
constexpr int kMostValues = 200'000;

/// Sees the text before anything is built of it.
class Guard final : public YAML::EventHandler {
 public:
  explicit Guard(const std::string& name) : name_(name) {}

  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    fail(name_, ": line ", mark.line + 1, ": YAML aliases (*name) are not read, no calibration needs them");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                       YAML::EmitterStyle::value /*style*/) override {
    descend(mark);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {
    descend(mark);
  }
  void OnMapEnd() override { --depth_; }

 private:
  void count(const YAML::Mark& mark) {
    if (++values_ > kMostValues) {
      fail(name_, ": line ", mark.line + 1, ": has more than ", kMostValues, " values, as no calibration has");
    }
  }
  void descend(const YAML::Mark& mark) {
    count(mark);
    if (++depth_ > kDeepest) {
      fail(name_, ": line ", mark.line + 1, ": nested deeper than ", kDeepest, " levels");
    }
  }

  const std::string& name_;
  int depth_ = 0;
  int values_ = 0;
};

/// On one line, fit for a message.
std::string shortened(std::string text) {
  constexpr std::size_t kLongest = 60;
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7f; }, '?');
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

/// Runs what may throw the parser's own exceptions.
template <class Call>
auto guarded(const std::string& context, const Call& call) {
  try {
    return call();
  } catch (const YAML::Exception& error) {
    fail(context, "line ", error.mark.line + 1, ", column ", error.mark.column + 1,
         ": no YAML or JSON: ", shortened(error.msg));
  }
}

}  // namespace

YamlValue::YamlValue(const YAML::Node& node, std::string name, std::string place)
    : node_(node), name_(std::move(name)), place_(std::move(place)) {}

YamlValue::YamlValue(std::string_view text, const std::string& name) : name_(name) {
  text = without_byte_order_mark(text, name + ": ");
  if (text.size() > kLargestText) {
    fail(name, ": has ", text.size(), " bytes, a calibration must have at most ", kLargestText);
  }
  if (text.starts_with("%YAML")) {
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
  const std::string owned(text);
  node_.reset(guarded(name + ": ", [&] {
    std::istringstream stream(owned);
    YAML::Parser parser(stream);
    Guard guard(name);
    parser.HandleNextDocument(guard);
    return YAML::Load(owned);
  }));
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
    fail(context(), "'", shortened(text), "' holds a control character or a byte that is no UTF-8, must be one line");
  }
  return text;
}

double YamlValue::number() const {
  const std::string word = text();
  const std::optional<double> value = parse_number<double>(word);
  if (!value || !std::isfinite(*value)) {
    fail(context(), "'", shortened(word), "' must be a finite number");
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
