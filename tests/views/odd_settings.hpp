// Rigs and settings with every kind of number and choice, for what prints them.
#pragma once

#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::views {

[[nodiscard]] std::vector<Rig> odd_rigs();
[[nodiscard]] std::vector<Settings> odd_settings();

}  // namespace depthgrid::views
