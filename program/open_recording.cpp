#include "program/open_recording.hpp"

#include <cstdio>

#include "depthgrid/core/printable_text.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

files::Recording open_recording(const std::string& path, const files::RecordingOptions& options) {
  try {
    files::Recording recording(path, options);
    for (const std::string& note : recording.notes()) {
      (void)std::fputs((printable(note) + '\n').c_str(), stderr);
    }
    return recording;
  } catch (const files::ChoiceError& error) {
    throw UsageError(error.what());
  }
}

std::vector<NamedFile> recording_inputs(const files::Recording& recording) {
  std::vector<NamedFile> inputs;
  if (!recording.mcap_file().empty()) {
    inputs.push_back({"the MCAP file", recording.mcap_file()});
  }
  if (recording.rig_file() != recording.mcap_file()) {
    inputs.push_back({"the rig file", recording.rig_file()});
  }
  if (!recording.mcap_file().empty() && !recording.moves()) {
    return inputs;  // the images are all in it
  }
  for (int index = 0; index < recording.frame_count(); ++index) {
    for (const auto& file : recording.files_of(index)) {
      inputs.push_back({file.extension() == ".png" ? "the depth image" : "the file of times or poses", file});
    }
  }
  return inputs;
}

}  // namespace depthgrid::program
