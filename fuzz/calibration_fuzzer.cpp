// libFuzzer target: any bytes as a calibration of another program. Either they are refused with an Error of one line,
// or they give cameras that the library takes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/plausibility.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "program/rig/imported_camera.hpp"

namespace {

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void require_plausible(const depthgrid::program::ImportedCamera& camera) {
  try {
    depthgrid::check_plausible(camera.intrinsics, camera.distortion);
  } catch (const depthgrid::Error&) {
    require(false);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const bool rectified : {false, true}) {
    try {
      const auto cameras =
          depthgrid::program::import_cameras(text, "fuzz", {rectified, rectified ? "wfov_unbinned" : "nfov_unbinned"});
      for (const auto& camera : cameras) {
        depthgrid::validate(camera.intrinsics);
        require_plausible(camera);
      }
    } catch (const depthgrid::Error& error) {
      require(depthgrid::is_printable(error.what()));
    }
  }
  return 0;
}
