#include "depthgrid/cell/guarded_yaml.hpp"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <sstream>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/text_encoding.hpp"

namespace depthgrid::cell {
namespace {

constexpr std::size_t kLargestYaml = std::size_t{1} << 20;
constexpr int kDeepest = 32;
constexpr int kMostValues = 200'000;

/// Sees the text before anything is built of it.
class YamlGuard final : public YAML::EventHandler {
 public:
  YamlGuard(const std::string& name, std::string_view what) : name_(name), what_(what) {}

  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    fail(name_, ": line ", mark.line + 1, ": YAML aliases (*name) are not read, ", what_, " needs none");
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
      fail(name_, ": line ", mark.line + 1, ": has more than ", kMostValues, " values, more than ", what_, " needs");
    }
  }
  void descend(const YAML::Mark& mark) {
    count(mark);
    if (++depth_ > kDeepest) {
      fail(name_, ": line ", mark.line + 1, ": nested deeper than ", kDeepest, " levels");
    }
  }

  const std::string& name_;
  std::string_view what_;
  int depth_ = 0;
  int values_ = 0;
};

}  // namespace

std::string shortened_yaml(std::string text) {
  constexpr std::size_t kLongest = 60;
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7f; }, '?');
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

void fail_yaml(const std::string& context, const YAML::Exception& error) {
  fail(context, "line ", error.mark.line + 1, ", column ", error.mark.column + 1,
       ": no YAML or JSON: ", shortened_yaml(error.msg));
}

YAML::Node guarded_yaml(std::string_view text, const std::string& name, std::string_view what) {
  text = without_byte_order_mark(text, name + ": ");
  if (text.size() > kLargestYaml) {
    fail(name, ": has ", text.size(), " bytes, ", what, " must have at most ", kLargestYaml);
  }
  if (text.starts_with("%YAML")) {
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
  const std::string owned(text);
  try {
    std::istringstream stream(owned);
    YAML::Parser parser(stream);
    YamlGuard guard(name, what);
    parser.HandleNextDocument(guard);
    return YAML::Load(owned);
  } catch (const YAML::Exception& error) {
    fail_yaml(name + ": ", error);
  }
}

}  // namespace depthgrid::cell
