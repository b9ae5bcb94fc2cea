// Answers as Python gets them: kept as they are, arrays made when they are asked for.
#pragma once

#include <string>
#include <vector>

#include "depthgrid/core/answer.hpp"

namespace depthgrid::python {

struct Distances {
  std::vector<Answer> answers{};
  std::vector<std::string> reasons{};  ///< where they were asked for
  std::vector<std::string> cameras{};  ///< ids, in the rig's order
};

}  // namespace depthgrid::python
