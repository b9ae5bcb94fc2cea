// What the fuzz targets of meshes share: any bytes give an Error of one line that prints, or corners that are all
// finite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/robot/mesh_formats.hpp"

inline int try_mesh(const std::uint8_t* data, std::size_t size, std::string_view ending) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const depthgrid::robot::Corners corners = depthgrid::robot::mesh_corners(bytes, ending, "fuzz: ");
    bool good = !corners.empty() && corners.size() % 3 == 0;
    for (const Eigen::Vector3d& corner : corners) {
      good = good && corner.allFinite();
    }
    if (!good) {
      std::abort();
    }
  } catch (const depthgrid::Error& error) {
    if (!depthgrid::is_printable(error.what())) {
      std::abort();
    }
  }
  return 0;
}
