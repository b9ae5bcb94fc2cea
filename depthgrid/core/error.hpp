// Errors of construction and configuration. The query path never throws.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace depthgrid {

/// Thrown by constructors, loaders and configuration checks. The message is one line that names the
/// offending value, the rule it breaks and, where there is one, the file and a hint.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws Error with the parts streamed one after the other into one line.
template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream text;
  text.precision(10);
  (text << ... << parts);
  throw Error(text.str());
}

}  // namespace depthgrid
