#include "depthgrid/robot/xml.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/words.hpp"

namespace depthgrid::robot {

namespace {

constexpr int kMaxDepth = 100;

struct WithinDepth final : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node& /*node*/) override { return depth() < kMaxDepth; }
};

}  // namespace

pugi::xml_node parse_xml(std::string_view text, const char* root, const std::string& context,
                         pugi::xml_document& document) {
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result) {
    const std::string_view before =
        text.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)));
    fail(context, "is no XML: ", lower_case(result.description()), ", line ",
         1 + std::count(before.begin(), before.end(), '\n'));
  }
  WithinDepth within;
  if (!document.traverse(within)) {
    fail(context, "its elements are nested more than ", kMaxDepth, " deep");
  }
  pugi::xml_node found;
  for (const pugi::xml_node& node : document.children()) {
    if (node.type() != pugi::node_element) {
      continue;
    }
    if (!found.empty() || std::string_view(node.name()) != root) {
      fail(context, "its root is <", shown(node.name()), ">", !found.empty() ? ", a second one" : "", ", must be one <",
           root, ">");
    }
    found = node;
  }
  if (found.empty()) {
    fail(context, "has no element, must be one <", root, ">");
  }
  return found;
}

std::string text_of(const pugi::xml_node& element) {
  std::string text;
  for (const pugi::xml_node& child : element.children()) {
    text += child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata ? child.value() : "";
  }
  return text;
}

}  // namespace depthgrid::robot
