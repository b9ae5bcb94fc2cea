#include "depthgrid/files/depth_file_pattern.hpp"

#include <algorithm>
#include <filesystem>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/rig_file.hpp"

namespace depthgrid::files {
namespace {

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Length of a conversion %d, %f or %0Nd (N = 1 ... 99) at `begin`; 0: none starts there.
std::size_t conversion_length(const std::string& pattern, std::size_t begin) noexcept {
  const char* c = pattern.c_str() + begin;  // ends with NUL, which stops every comparison below
  if (c[0] != '%') {
    return 0;
  }
  if (c[1] == 'd' || c[1] == 'f') {
    return 2;
  }
  if (c[1] != '0' || !is_digit(c[2]) || c[2] == '0') {
    return 0;
  }
  return c[3] == 'd' ? 4 : is_digit(c[3]) && c[4] == 'd' ? 5 : 0;
}

}  // namespace

void check_stays_inside(const std::string& path_text) {
  if (!is_printable(path_text)) {
    fail("'", printable_excerpt(path_text), "' holds a character that cannot be printed, names of files must not");
  }
  const std::filesystem::path path(path_text);
  if (path.is_absolute()) {
    fail("'", path_text, "' is an absolute path, must be relative to the rig file's folder");
  }
  if (std::any_of(path.begin(), path.end(), [](const std::filesystem::path& part) { return part == ".."; })) {
    fail("'", path_text, "' has a part '..', must stay in the rig file's folder");
  }
}

std::string checked_conversion(const std::string& pattern) {
  check_stays_inside(pattern);
  std::string conversion;
  for (std::size_t at = pattern.find('%'); at != std::string::npos; at = pattern.find('%', at + 1)) {
    const std::size_t length = conversion_length(pattern, at);
    if (length == 0) {
      fail("'", pattern, "' has a '%' that does not start %d, %0Nd or %f");
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
  if (conversion.empty() || conversion == kTimeConversion) {
    return pattern;
  }
  std::string number = std::to_string(frame);
  const std::size_t digits =
      parse_number<std::size_t>(std::string_view(conversion).substr(1, conversion.size() - 2)).value_or(0);
  if (number.size() < digits) {
    number.insert(0, digits - number.size(), '0');
  }
  std::string name = pattern;
  return name.replace(pattern.find('%'), conversion.size(), number);
}

}  // namespace depthgrid::files
