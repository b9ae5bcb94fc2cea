// libFuzzer target: any bytes as a list of images, a trajectory, and a pose file; the first byte says which. Either
// they are refused with an Error of one line that prints, or times ascend, names stay in their folder and poses are
// rigid.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/image_list.hpp"
#include "depthgrid/files/trajectory.hpp"

namespace {

using namespace depthgrid::files;

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void check(const depthgrid::Pose& pose) {
  require(pose.matrix().allFinite() && pose.linear().isUnitary(1e-9) && pose.linear().determinant() > 0);
  require(pose.translation().cwiseAbs().maxCoeff() <= 1e5);
}

void check_list(std::string_view text) {
  double before_s = -std::numeric_limits<double>::infinity();
  for (const StampedImage& image : parse_image_list(text, "fuzz")) {
    require(std::isfinite(image.time_s) && image.time_s > before_s);
    before_s = image.time_s;
    const std::filesystem::path path(image.file);
    require(!path.is_absolute() && std::find(path.begin(), path.end(), "..") == path.end());
    require(depthgrid::is_printable(image.file));
  }
}

void check_trajectory(std::string_view text) {
  const auto poses = parse_trajectory(text, "fuzz");
  for (std::size_t k = 0; k < poses.size(); ++k) {
    check(poses[k].T_world_body);
    require(pose_at(poses, poses[k].time_s, {}).matrix().allFinite());
    if (k > 0) {
      try {
        check(pose_at(poses, (poses[k - 1].time_s + poses[k].time_s) / 2, 1.0));
      } catch (const depthgrid::Error& error) {
        require(depthgrid::is_printable(error.what()));
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    switch (data[0] % 3) {
      case 0:
        check_list(text);
        break;
      case 1:
        check_trajectory(text);
        break;
      default:
        check(parse_pose_matrix(text, "fuzz"));
    }
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
  }
  return 0;
}
