// libFuzzer target: any bytes as a recorded motion: the skeleton (ASF), a form feed, the frames (AMC). Either they are
// refused with an Error of one line that prints, or every bone of every frame ends somewhere within reach.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/simulation/mocap_clip.hpp"

namespace {

using namespace depthgrid::simulation;

constexpr double kReach_m = 1e5;  // a kilometre from the origin at most, and a few thousand bones of 2 m

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void check(const MocapClip& clip) {
  require(clip.frames() > 0 && clip.duration_s() >= 0 && clip.v_max_m_s() >= 0);
  for (const double time_s : {0.0, clip.duration_s() / 3, clip.duration_s()}) {
    for (const depthgrid::Capsule& bone : clip.at(time_s)) {
      require(bone.a.cwiseAbs().maxCoeff() <= kReach_m && bone.b.cwiseAbs().maxCoeff() <= kReach_m);
      require(bone.radius_m > 0);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\f'), size);
  try {
    const MocapSkeleton skeleton = parse_asf(text.substr(0, end), "asf");
    check(MocapClip(skeleton, parse_amc(text.substr(std::min(end + 1, size)), skeleton, "amc")));
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
  }
  return 0;
}
