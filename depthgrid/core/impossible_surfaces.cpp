#include "depthgrid/core/impossible_surfaces.hpp"

#include "depthgrid/core/short_text.hpp"

namespace depthgrid {

std::string_view describe(const ImpossibleSurfaces& found, std::span<char> buffer,
                          std::string_view camera_name) noexcept {
  ShortText text(buffer);
  if (found.images == 0) {
    return text.text();
  }
  text.add_count(found.images).add(found.images == 1 ? " image shows" : " images show");
  text.add(" a surface where nothing could be, last at ");
  text.add(found.at_world.x(), ", ").add(found.at_world.y(), ", ").add(found.at_world.z(), " m (camera ");
  if (camera_name.empty()) {
    text.add_count(found.camera);
  } else {
    text.add(camera_name);
  }
  text.add("): v_max is too low, a calibration or a clock is wrong, or something fell");
  return text.text();
}

}  // namespace depthgrid
