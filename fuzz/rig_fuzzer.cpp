// libFuzzer target: any bytes as a rig file. Either they are refused with an Error of one line that prints, or they
// give a rig that can be written and read back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/rig_file.hpp"

namespace {

using depthgrid::files::RigFile;

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void check_round_trip(const RigFile& first) {
  const RigFile second = depthgrid::files::parse_rig(depthgrid::files::to_json(first), "written");
  require(first.rig.cameras.size() == second.rig.cameras.size() && first.depth_files == second.depth_files);
  require(first.first_frame == second.first_frame && first.frame_count == second.frame_count);
  for (std::size_t k = 0; k < first.rig.cameras.size(); ++k) {
    const depthgrid::RigCamera& a = first.rig.cameras[k];
    const depthgrid::RigCamera& b = second.rig.cameras[k];
    require(a.id == b.id && a.intrinsics.width_px == b.intrinsics.width_px && a.metres_per_unit == b.metres_per_unit);
    require(a.T_world_camera.isApprox(b.T_world_camera, 1e-9));
    require(!depthgrid::files::depth_file_name(first.depth_files[k], first.first_frame).empty() ||
            first.depth_files[k].empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  RigFile file;
  try {
    file = depthgrid::files::parse_rig(text, "fuzz");
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
    return 0;
  }
  check_round_trip(file);
  return 0;
}
