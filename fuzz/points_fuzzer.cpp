// libFuzzer target: any bytes as a file of control points. Either they are refused with an Error of one line that
// prints, or they give points with distinct names that print, at finite places.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/control_points.hpp"

namespace {

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

void check(std::span<const depthgrid::files::ControlPoint> points) {
  std::set<std::string_view> ids;
  for (const auto& point : points) {
    require(!point.id.empty() && depthgrid::is_printable(point.id) && ids.insert(point.id).second);
    require(point.capsule.a.cwiseAbs().maxCoeff() <= 1e5 && point.capsule.b.cwiseAbs().maxCoeff() <= 1e5);
    require(point.capsule.radius_m >= 0 && point.capsule.radius_m <= 1e5);
    require(point.has_end || point.capsule.a == point.capsule.b);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto points = depthgrid::files::parse_control_points(text, "fuzz");
    require(points.fixed.empty() != points.of_frame.empty());
    check(points.fixed);
    for (const auto& [frame, of_frame] : points.of_frame) {
      require(frame >= 0);
      check(of_frame);
    }
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
  }
  return 0;
}
