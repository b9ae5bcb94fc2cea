// libFuzzer target: any bytes as a cell file. Either they are refused with an Error of one line that names the file, or
// they give a cell whose numbers are finite and whose every value is told.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace {

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const depthgrid::cell::Cell cell =
        depthgrid::cell::parse_cell({reinterpret_cast<const char*>(data), size}, "fuzz.yaml");
    require(!cell.cameras.empty() && !cell.name.empty() && !cell.shown.empty());
    require(cell.space.low_world.allFinite() && cell.space.high_world.allFinite());
    for (const depthgrid::cell::CameraEntry& camera : cell.cameras) {
      require(camera.smallest_obstacle_m >= 0 && camera.rate_hz > 0);
      require(!camera.T_world_camera || camera.T_world_camera->matrix().allFinite());
    }
    require(cell.ask.rate_hz > 0 && std::isfinite(cell.v_max_m_s));
  } catch (const depthgrid::Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz.yaml:") && message.find('\n') == std::string_view::npos);
  }
  return 0;
}
