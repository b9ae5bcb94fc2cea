#include "program/warning.hpp"

#include <cstdio>
#include <string>

#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::program {

void warn(std::string_view text) {
  const std::string line = "depthgrid: warning: " + printable(text) + "\n";
  (void)std::fputs(line.c_str(), stderr);
}

}  // namespace depthgrid::program
