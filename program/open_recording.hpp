// A recording as a command line names it.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "program/output_check.hpp"

namespace depthgrid::program {

/// Says on standard error what was found in an MCAP file. Throws UsageError where the options do not fit the recording,
/// and Error where the recording is broken.
files::Recording open_recording(const std::string& path, const files::RecordingOptions& options);

/// The files of the recording, whichever of its frames are chosen: none of them may be lost.
std::vector<NamedFile> recording_inputs(const files::Recording& recording);

}  // namespace depthgrid::program
