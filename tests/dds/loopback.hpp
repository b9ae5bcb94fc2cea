// A DDS domain that no other test and no other machine is in.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "depthgrid/dds/node.hpp"
#include "depthgrid/messages/serialization.hpp"

namespace depthgrid::dds {

/// Over the loopback interface alone.
[[nodiscard]] NodeSettings loopback(const std::string& name, int domain);

/// An image whose pixels differ from each other and from those of other numbers.
[[nodiscard]] std::vector<std::byte> numbered_image(int number, int width_px = 640, int height_px = 480);

}  // namespace depthgrid::dds
