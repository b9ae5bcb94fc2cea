// What a user should know although the command goes on.
#pragma once

#include <string_view>

namespace depthgrid::program {

/// One line on standard error, whatever the text holds: "depthgrid: warning: ...".
void warn(std::string_view text);

}  // namespace depthgrid::program
