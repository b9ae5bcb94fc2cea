// How many of each camera's images a running cell used, and how old they were then: from its JSON lines.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "lab/measure/samples.hpp"

namespace depthgrid::lab {

struct ReceivedImages {
  std::string camera;
  std::size_t images = 0;
  Samples age_s;          ///< at the first question that stands on it
  Samples between_s;      ///< the exposures of two in a row
  double late_share = 0;  ///< of the answers
};

struct Received {
  double seconds = 0;  ///< between the first and the last answer that count
  std::size_t answers = 0;
  std::size_t stopped = 0;
  std::vector<ReceivedImages> cameras;
};

/// Answers of the first `leave_out_s` seconds are left out, for what has to find itself first. Throws Error that names
/// the line which is none.
[[nodiscard]] Received received_images(std::istream& answers, double leave_out_s);

}  // namespace depthgrid::lab
