#include "depthgrid/files/depth_file_pattern.hpp"

#include <algorithm>
#include <filesystem>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/rig_file.hpp"

namespace depthgrid::files {
namespace {

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Length of a conversion %d or %0Nd (N = 1 ... 9) at `begin`; 0: none starts there.
std::size_t conversion_length(const std::string& pattern, std::size_t begin) noexcept {
  const char* c = pattern.c_str() + begin;  // ends with NUL, which stops every comparison below
  if (c[0] != '%') {
    return 0;
  }
  if (c[1] == 'd') {
    return 2;
  }
  return c[1] == '0' && is_digit(c[2]) && c[2] != '0' && c[3] == 'd' ? 4 : 0;
}

}  // namespace

std::string checked_conversion(const std::string& pattern) {
  const std::filesystem::path path(pattern);
  if (path.is_absolute()) {
    fail("'", pattern, "' is an absolute path, must be relative to the rig file's folder");
  }
  if (std::any_of(path.begin(), path.end(), [](const std::filesystem::path& part) { return part == ".."; })) {
    fail("'", pattern, "' has a part '..', must stay in the rig file's folder");
  }
  std::string conversion;
  for (std::size_t at = pattern.find('%'); at != std::string::npos; at = pattern.find('%', at + 1)) {
    const std::size_t length = conversion_length(pattern, at);
    if (length == 0) {
      fail("'", pattern, "' has a '%' that does not start %d or %0Nd, with one digit for N");
    }
    if (!conversion.empty()) {
      fail("'", pattern, "' has two conversions, only one frame number can be put in");
    }
    conversion = pattern.substr(at, length);
  }
  return conversion;
}

std::string depth_file_name(const std::string& pattern, int frame) {
  const std::string conversion = checked_conversion(pattern);
  if (conversion.empty()) {
    return pattern;
  }
  std::string number = std::to_string(frame);
  const std::size_t digits = conversion.size() == 4 ? static_cast<std::size_t>(conversion[2] - '0') : 0;
  if (number.size() < digits) {
    number.insert(0, digits - number.size(), '0');
  }
  std::string name = pattern;
  return name.replace(pattern.find('%'), conversion.size(), number);
}

}  // namespace depthgrid::files
