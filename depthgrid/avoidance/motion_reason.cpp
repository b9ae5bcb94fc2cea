#include "depthgrid/avoidance/motion_reason.hpp"

#include <array>
#include <cmath>

#include "depthgrid/core/reason_text.hpp"
#include "depthgrid/core/short_text.hpp"

namespace depthgrid::avoidance {
namespace {

/// Rounded up, for people: an arm that all but stands is not told in powers of ten.
double whole_tenths_of_mm(double length_m) noexcept { return std::fmax(0.0, std::ceil(length_m * 1e4 - 1e-6) / 1e4); }

/// What is nearest, and what is remembered of it.
void add_nearest(ShortText& line, const MotionReason& reason) noexcept {
  Proximity nearest;
  nearest.state = reason.state;
  nearest.unmeasured = reason.unmeasured;
  std::array<char, 240> words{};
  line.add("from ").add(reason_text(nearest, reason.past, reason.time_s, words));
}

void add_part(ShortText& line, const MotionReason& reason) noexcept {
  if (reason.part) {
    line.add("part ").add_count(*reason.part).add(" (").add(reason.link).add(") ");
  }
}

void add_what_limits(ShortText& line, const MotionReason& reason) noexcept {
  switch (reason.limit) {
    case MotionLimit::none:
      line.add("nothing is within the laws' range");
      break;
    case MotionLimit::obstacle:
      add_part(line, reason);
      line.add("is ").add(reason.clear_m, " m ");
      add_nearest(line, reason);
      break;
    case MotionLimit::budget:
      add_part(line, reason);
      line.add("is at least ").add(reason.clear_m, " m away, the budget ended the search");
      break;
    case MotionLimit::blind_layer:
      add_part(line, reason);
      line.add("is nearer to something than its blind layer is thick");
      break;
    case MotionLimit::unknown_distance:
      add_part(line, reason);
      line.add("has no distance");
      break;
    case MotionLimit::no_images:
      line.add("braking: no camera has a new image");
      break;
    case MotionLimit::no_joint_state:
      line.add("braking: no joint state for ").add(reason.late_s, " s");
      break;
    case MotionLimit::clock:
      line.add("braking: the clock went back, stands still or is not a number");
      break;
  }
}

}  // namespace

std::string_view to_string(MotionLimit limit) noexcept {
  switch (limit) {
    case MotionLimit::none:
      return "none";
    case MotionLimit::obstacle:
      return "obstacle";
    case MotionLimit::budget:
      return "budget";
    case MotionLimit::blind_layer:
      return "blind layer";
    case MotionLimit::unknown_distance:
      return "unknown distance";
    case MotionLimit::no_images:
      return "no images";
    case MotionLimit::no_joint_state:
      return "no joint state";
    case MotionLimit::clock:
      return "clock";
  }
  return "invalid";
}

std::string_view describe(const MotionReason& reason, std::span<char> buffer) noexcept {
  ShortText line(buffer);
  add_what_limits(line, reason);
  if (reason.limit != MotionLimit::none && std::isfinite(reason.braking_m)) {
    line.add(", stands within ").add(whole_tenths_of_mm(reason.braking_m), " m");
  }
  if (reason.late_camera && reason.limit != MotionLimit::no_joint_state) {
    line.add("; camera ").add_count(*reason.late_camera);
    if (std::isfinite(reason.late_s)) {
      line.add(": last image ").add(reason.late_s, " s ago");
    } else {
      line.add(" has no image");
    }
  }
  if (reason.impossible_images > 0) {
    line.add("; ").add_count(reason.impossible_images);
    line.add(reason.impossible_images == 1 ? " image shows" : " images show");
    line.add(" a surface where nothing could be, last ")
        .add(reason.impossible_s, " s ago: v_max, calibration or clock");
  }
  return line.text();
}

}  // namespace depthgrid::avoidance
