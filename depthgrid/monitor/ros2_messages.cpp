#include "depthgrid/monitor/ros2_messages.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "depthgrid/core/short_text.hpp"

namespace depthgrid::monitor {
namespace {

constexpr double kLine_m = 0.006;
constexpr double kDot_m = 0.03;
constexpr double kLetters_m = 0.05;
constexpr std::size_t kSentence = 960;

std::string words(const CellAnswer& answer, const Names& names) {
  std::array<char, kSentence> buffer{};
  return std::string(sentence(answer.reason, names, buffer));
}

messages::Point point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// Surfaces blue, unseen space red, nothing near green; told apart by the colour-blind, too.
messages::Color colour(ProximityState state) {
  switch (state) {
    case ProximityState::measured:
      return {.r = 0.0F, .g = 0.45F, .b = 0.72F, .a = 1.0F};
    case ProximityState::beyond_rho:
      return {.r = 0.10F, .g = 0.55F, .b = 0.22F, .a = 1.0F};
    default:
      return {.r = 0.84F, .g = 0.08F, .b = 0.30F, .a = 1.0F};
  }
}

messages::Marker marker(const messages::Header& header, std::string_view kind, std::int32_t id, std::int32_t type) {
  messages::Marker result;
  result.header = header;
  result.ns = kind;
  result.id = id;
  result.type = type;
  result.color = {.r = 0.35F, .g = 0.33F, .b = 0.62F, .a = 0.35F};
  return result;
}

/// Balls of the capsule's ends, and a cylinder between them.
void add_capsule(const Capsule& capsule, const messages::Header& header, std::int32_t id, messages::Markers& markers) {
  const double wide_m = 2 * capsule.radius_m;
  messages::Marker ends = marker(header, "ends", id, messages::Marker::sphere_list);
  ends.scale = {wide_m, wide_m, wide_m};
  ends.points = {point(capsule.a), point(capsule.b)};
  markers.markers.push_back(std::move(ends));
  const Eigen::Vector3d along = capsule.b - capsule.a;
  if (!(along.norm() > 0) || !along.allFinite()) {
    return;
  }
  messages::Marker side = marker(header, "sides", id, messages::Marker::cylinder);
  side.scale = {wide_m, wide_m, along.norm()};
  side.pose.position = point(0.5 * (capsule.a + capsule.b));
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along);
  side.pose.orientation = {turn.x(), turn.y(), turn.z(), turn.w()};
  markers.markers.push_back(std::move(side));
}

std::string number(double value) {
  std::array<char, 32> buffer{};
  ShortText text(buffer);
  return std::string(text.add(value, "").text());
}

messages::DiagnosticStatus of_camera(const CameraBasis& camera, const std::string& name, const std::string& cell) {
  messages::DiagnosticStatus status;
  const bool works =
      camera.state == CameraState::live || camera.state == CameraState::waiting || camera.state == CameraState::opening;
  status.level = !works        ? messages::DiagnosticStatus::error
                 : camera.late ? messages::DiagnosticStatus::warn
                               : messages::DiagnosticStatus::ok;
  status.name = cell + ": camera " + name;
  status.hardware_id = name;
  status.message = std::string(to_string(camera.state)) + (camera.late ? ", its image is late" : "");
  status.values = {{"image age, s", number(camera.age_s)}, {"without reading", number(camera.without_reading)}};
  return status;
}

}  // namespace

messages::Distances distances_message(const CellAnswer& answer, const Names& names, const messages::Header& header) {
  messages::Distances message;
  message.header = header;
  const std::string why = words(answer, names);
  for (std::size_t i = 0; i < answer.parts.size(); ++i) {
    const auto& camera = answer.parts[i].nearest.camera;
    const bool has_camera = camera && *camera < names.cameras.size();
    message.distances.push_back(messages::distance_of(
        answer.parts[i], i < names.parts.size() ? names.parts[i] : std::string(),
        has_camera ? names.cameras[*camera] : std::string(), answer.reason.part == i ? why : std::string()));
  }
  message.cameras = names.cameras;
  for (std::size_t k = 0; k < names.cameras.size(); ++k) {
    message.image_ages.push_back(k < answer.camera_count ? answer.cameras[k].age_s : Proximity::kNaN);
  }
  return message;
}

void tell_basis(const CellAnswer& answer, const std::function<messages::Time(double)>& stamp,
                messages::Distances& message) {
  for (std::size_t k = 0; k < message.cameras.size(); ++k) {
    message.image_stamps.push_back(k < answer.camera_count ? stamp(answer.cameras[k].image_s) : messages::Time{});
  }
  message.joint_stamp = stamp(answer.joints_s);
  message.sequence = answer.sequence;
  message.stop = answer.stop;
}

messages::Markers markers_message(const CellAnswer& answer, const Names& names, const messages::Header& header) {
  messages::Markers message;
  messages::Marker lines = marker(header, "nearest", 0, messages::Marker::line_list);
  lines.scale = {kLine_m, 0, 0};
  messages::Marker dots = marker(header, "nearest", 1, messages::Marker::sphere_list);
  dots.scale = {kDot_m, kDot_m, kDot_m};
  lines.color.a = dots.color.a = 1.0F;
  for (const Answer& part : answer.parts) {
    if (!part.on_axis_world.allFinite() || !part.nearest.nearest_world.allFinite() ||
        part.nearest.state == ProximityState::beyond_rho) {
      continue;
    }
    const messages::Color colour_of_part = colour(part.nearest.state);
    lines.points.push_back(point(part.on_axis_world));
    lines.points.push_back(point(part.nearest.nearest_world));
    lines.colors.insert(lines.colors.end(), 2, colour_of_part);
    dots.points.push_back(point(part.nearest.nearest_world));
    dots.colors.push_back(colour_of_part);
  }
  // Viewers warn of lists that are empty.
  for (messages::Marker* list : {&lines, &dots}) {
    list->action = list->points.empty() ? messages::Marker::remove : messages::Marker::add;
    message.markers.push_back(*list);
  }
  for (std::size_t i = 0; i < answer.parts_world.size(); ++i) {
    add_capsule(answer.parts_world[i], header, static_cast<std::int32_t>(i), message);
  }
  messages::Marker text = marker(header, "why", 0, messages::Marker::text_view_facing);
  text.scale = {0, 0, kLetters_m};
  text.color = {.r = 1.0F, .g = 1.0F, .b = 1.0F, .a = 1.0F};
  text.text = words(answer, names);
  if (!answer.parts_world.empty() && answer.parts_world.back().b.allFinite()) {
    text.pose.position = point(answer.parts_world.back().b + Eigen::Vector3d(0, 0, 0.3));
  }
  message.markers.push_back(std::move(text));
  return message;
}

messages::Diagnostics diagnostics_message(const CellAnswer& answer, const Names& names,
                                          const messages::Header& header) {
  messages::Diagnostics message;
  message.header = header;
  messages::DiagnosticStatus cell;
  cell.level = answer.stop ? messages::DiagnosticStatus::error : messages::DiagnosticStatus::ok;
  cell.name = names.cell;
  cell.hardware_id = names.cell;
  cell.message = words(answer, names);
  cell.values = {{"distance, m", number(answer.distance_m)},
                 {"clear of the blind layer, m", number(answer.clear_m)},
                 {"skew of the images, s", number(answer.skew_s)},
                 {"age of the joint state, s", number(answer.joints_age_s)}};
  message.status.push_back(std::move(cell));
  for (std::size_t k = 0; k < std::min(answer.camera_count, names.cameras.size()); ++k) {
    message.status.push_back(of_camera(answer.cameras[k], names.cameras[k], names.cell));
  }
  return message;
}

messages::Transforms camera_frames(const Rig& rig, const messages::Header& header) {
  messages::Transforms message;
  for (const RigCamera& camera : rig.cameras) {
    messages::TransformStamped frame;
    frame.header = header;
    frame.child_frame_id = camera.id;
    const Eigen::Vector3d t = camera.T_world_camera.translation();
    const Eigen::Quaterniond turn(camera.T_world_camera.linear());
    frame.transform = {.translation = {t.x(), t.y(), t.z()}, .rotation = {turn.x(), turn.y(), turn.z(), turn.w()}};
    message.transforms.push_back(std::move(frame));
  }
  return message;
}

}  // namespace depthgrid::monitor
