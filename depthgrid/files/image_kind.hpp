// Images that are not PNG, for messages. Internal.
#pragma once

#include <string>
#include <string_view>

namespace depthgrid::files {

/// "JPEG", say, by a file's first bytes; empty where they are none of an image that is known here.
[[nodiscard]] std::string_view image_kind_of_bytes(std::string_view first_bytes) noexcept;

/// The same by the ending of a file's name.
[[nodiscard]] std::string_view image_kind_of_name(std::string_view name) noexcept;

/// "depth images need to be ...; ...": how such a file becomes one that is read here.
[[nodiscard]] std::string way_to_png(std::string_view kind);

}  // namespace depthgrid::files
