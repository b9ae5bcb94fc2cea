// libFuzzer target: any bytes as a URDF file. Either they are refused with an Error of one line that prints, or they
// give a robot whose links stand at finite poses, with capsules where it has no meshes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/urdf.hpp"

namespace {

using namespace depthgrid::robot;

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

bool has_mesh(const LinkDescription& link) {
  return std::any_of(link.shapes.begin(), link.shapes.end(),
                     [](const LinkShape& item) { return std::holds_alternative<MeshShape>(item.shape); });
}

void check(const RobotModel& model) {
  std::vector<double> q;
  for (const Joint& joint : model.joints()) {
    require(joint.max_speed > 0 && joint.lower <= joint.upper);
    q.push_back(std::clamp(0.3, joint.lower, joint.upper));
  }
  std::vector<depthgrid::Pose> poses(model.links().size());
  require(model.link_poses(q, depthgrid::Pose::Identity(), poses));
  if (std::none_of(model.links().begin(), model.links().end(), has_mesh)) {
    for (const LinkCapsule& item : link_capsules(model)) {
      require(item.capsule.a.allFinite() && item.capsule.b.allFinite() && item.capsule.radius_m >= 0);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  UrdfOptions options;
  options.require_meshes = false;
  try {
    check(RobotModel(parse_urdf(std::string(reinterpret_cast<const char*>(data), size), "folder/fuzz.urdf", options)));
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
  }
  return 0;
}
