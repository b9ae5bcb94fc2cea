#include "program/output_check.hpp"

#include <sys/stat.h>

#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_replacement.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace fs = std::filesystem;

namespace {

using FileId = std::pair<dev_t, ino_t>;

/// Of what the path leads to through all its links; none where there is nothing.
std::optional<FileId> id_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    return std::nullopt;
  }
  return FileId{status.st_dev, status.st_ino};
}

bool names_a_file(const NamedFile& output) { return !output.file.empty() && output.file != "-"; }

void refuse_twice(const std::vector<NamedFile>& outputs) {
  std::map<fs::path, const NamedFile*> seen;
  for (const NamedFile& output : outputs) {
    if (names_a_file(output)) {
      std::error_code ignored;
      fs::path place = fs::weakly_canonical(output.file, ignored);
      const auto [other, is_new] = seen.emplace(place.empty() ? output.file : place, &output);
      if (!is_new) {
        fail_usage(output.name, " ", output.file.string(), " and ", other->second->name, " ",
                   other->second->file.string(), " are the same file; name two");
      }
    }
  }
}

}  // namespace

void refuse_overwriting(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  refuse_twice(outputs);
  std::map<FileId, const NamedFile*> there;  // the outputs that exist already
  for (const NamedFile& output : outputs) {
    if (const auto id = names_a_file(output) ? id_of(output.file) : std::nullopt) {
      there.emplace(*id, &output);
    }
  }
  if (there.empty()) {
    return;
  }
  for (const NamedFile& input : inputs) {
    if (const auto id = id_of(input.file)) {
      if (const auto found = there.find(*id); found != there.end()) {
        fail_usage(found->second->name, " ", found->second->file.string(), " is ", input.name, " ", input.file.string(),
                   ", an input that would be overwritten; name another file");
      }
    }
  }
}

void check_output_file(const std::string& file) {
  if (file == "-") {
    fail_usage("-: this output does not go to standard output; name a file");
  }
  const fs::path folder = fs::path(file).parent_path();
  if (!folder.empty() && !fs::is_directory(folder)) {
    fail("cannot write ", file, ": there is no folder ", folder.string(), "; create it first");
  }
  if (fs::is_directory(file)) {
    fail("cannot write ", file, ": it is a folder; name a file");
  }
  (void)replaceable_file(file);
}

}  // namespace depthgrid::program
