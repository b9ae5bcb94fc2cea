#include "report/marked_page.hpp"

#include <string>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::report {

void write_between(const std::filesystem::path& page, std::string_view begin, std::string_view end,
                   std::string_view text) {
  std::string all = files::read_text_file(page);
  const std::size_t from = all.find(begin);
  const std::size_t to = all.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    fail(page.string(), ": lacks the line '", begin, "' and behind it '", end, "'");
  }
  const std::size_t at = from + begin.size();
  all.replace(at, to - at, "\n" + std::string(text));
  files::write_text_file(page, all);
}

}  // namespace depthgrid::report
