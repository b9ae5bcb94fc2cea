// XML files of robots: parsed within limits, so that no file can take the process along. Internal.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace depthgrid::robot {

/// The root element of a text, named `root`. Throws Error beginning with `context` when the text is no XML, has another
/// root or more than one, or its elements are nested more than 100 deep.
[[nodiscard]] pugi::xml_node parse_xml(std::string_view text, const char* root, const std::string& context,
                                       pugi::xml_document& document);

/// All text right inside an element.
[[nodiscard]] std::string text_of(const pugi::xml_node& element);

}  // namespace depthgrid::robot
