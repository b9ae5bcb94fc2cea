#include "program/open_recording.hpp"

#include "program/usage_error.hpp"

namespace depthgrid::program {

files::Recording open_recording(const std::string& path, const files::RecordingOptions& options) {
  try {
    return files::Recording(path, options);
  } catch (const files::ChoiceError& error) {
    throw UsageError(error.what());
  }
}

std::vector<NamedFile> recording_inputs(const files::Recording& recording) {
  std::vector<NamedFile> inputs{{"the rig file", recording.rig_file()}};
  for (int index = 0; index < recording.frame_count(); ++index) {
    for (const auto& file : recording.files_of(index)) {
      inputs.push_back({file.extension() == ".png" ? "the depth image" : "the file of times or poses", file});
    }
  }
  return inputs;
}

}  // namespace depthgrid::program
