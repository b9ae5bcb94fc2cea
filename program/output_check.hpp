// Outputs that would overwrite what a command reads are refused before it begins.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace depthgrid::program {

struct NamedFile {
  std::string name;  ///< of an output: the option; of an input: what it is, "the rig file"
  std::filesystem::path file;
};

/// Throws UsageError where an output is an input: the same file, however it is spelled and whatever links lead to it;
/// and where two outputs would be the same file. Files that are not there are no inputs; "-" and empty names are left
/// out.
void refuse_overwriting(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// Throws Error unless a file can be made there: a folder that is missing, a folder or device of that name; UsageError
/// for "-".
void check_output_file(const std::string& file);

}  // namespace depthgrid::program
