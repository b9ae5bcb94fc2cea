#include "depthgrid/monitor/cell_answer.hpp"

#include <array>
#include <cmath>

#include "depthgrid/core/reason_text.hpp"
#include "depthgrid/core/short_text.hpp"

namespace depthgrid::monitor {
namespace {

using avoidance::MotionLimit;

std::string_view name_of(const std::vector<std::string>& names, std::size_t index) noexcept {
  return index < names.size() ? std::string_view(names[index]) : std::string_view("?");
}

std::string_view words_of(CameraState state) noexcept {
  switch (state) {
    case CameraState::opening:
      return "is being opened";
    case CameraState::waiting:
      return "has sent no image yet";
    case CameraState::live:
      return "is live";
    case CameraState::no_reading:
      return "sees nothing: no pixel has a reading";
    case CameraState::unusable:
      return "sends images that cannot be used";
    case CameraState::wrong_clock:
      return "sends images of another time";
    case CameraState::frozen:
      return "repeats the same image";
    case CameraState::failed:
      return "is lost";
    case CameraState::ended:
      return "is at the end of its recording";
    case CameraState::silent:
      return "is silent";
  }
  return "?";
}

void add_nearest(ShortText& line, const Reason& reason, const Names& names) noexcept {
  std::array<char, 240> words{};
  line.add(reason_text(reason.nearest, {}, 0, words));
  if (reason.nearest.camera) {
    line.add(" seen by ").add(name_of(names.cameras, *reason.nearest.camera));
  }
}

void add_limit(ShortText& line, const Reason& reason, const Names& names) noexcept {
  const std::string_view part = reason.part ? name_of(names.parts, *reason.part) : "a part";
  switch (reason.limit) {
    case MotionLimit::none:
      line.add("nothing is near");
      break;
    case MotionLimit::obstacle:
    case MotionLimit::budget:
      line.add(part).add(" is ").add(reason.distance_m, " m from ");
      add_nearest(line, reason, names);
      break;
    case MotionLimit::blind_layer:
      line.add(part).add(" is ").add(reason.distance_m, " m from ");
      add_nearest(line, reason, names);
      line.add(", nearer than its blind layer is thick");
      break;
    case MotionLimit::unknown_distance:
      line.add(part).add(" has no distance");
      break;
    case MotionLimit::no_images:
      line.add("no camera has a new image");
      break;
    case MotionLimit::no_joint_state:
      std::isfinite(reason.joints_age_s) ? line.add("no joint state for ").add(reason.joints_age_s, " s")
                                         : line.add("no joint state yet");
      break;
    case MotionLimit::clock:
      line.add("the clock went back or stands still");
      break;
  }
}

}  // namespace

std::string_view to_string(CameraState state) noexcept {
  switch (state) {
    case CameraState::opening:
      return "opening";
    case CameraState::waiting:
      return "waiting";
    case CameraState::live:
      return "live";
    case CameraState::no_reading:
      return "no reading";
    case CameraState::unusable:
      return "unusable";
    case CameraState::wrong_clock:
      return "wrong clock";
    case CameraState::frozen:
      return "frozen";
    case CameraState::failed:
      return "failed";
    case CameraState::ended:
      return "ended";
    case CameraState::silent:
      return "silent";
  }
  return "invalid";
}

std::string_view sentence(const Reason& reason, const Names& names, std::span<char> buffer) noexcept {
  ShortText line(buffer);
  add_limit(line, reason, names);
  const bool of_distance = reason.limit == MotionLimit::obstacle || reason.limit == MotionLimit::budget ||
                           reason.limit == MotionLimit::blind_layer;
  if (of_distance) {
    line.add("; blind layer ").add(reason.blind_m, " m");
    line.add(", what moves at ").add(reason.v_max_m_s, " m/s for ").add(reason.reaction_s, " s is taken off");
    if (reason.stop_m > 0) {
      line.add(", limit ").add(reason.stop_m, " m beyond the layer: stops at ");
      line.add(reason.blind_m + reason.stop_m, " m");
    }
  }
  if (reason.clear_s > 0) {
    line.add("; clear for ").add(reason.clear_s, " s, the stop is held");
  }
  if (reason.camera) {
    line.add("; camera ").add(name_of(names.cameras, *reason.camera)).add(" ").add(words_of(reason.camera_state));
    if (std::isfinite(reason.camera_age_s)) {
      line.add(", its image is ").add(reason.camera_age_s, " s old");
    } else if (reason.camera_state == CameraState::live || reason.camera_state == CameraState::failed) {
      line.add(", it has no image");
    }
  }
  return line.text();
}

}  // namespace depthgrid::monitor
