#include "depthgrid/monitor/asked_cell.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <sstream>

#include "depthgrid/core/error.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/monitor/joint_line.hpp"

namespace depthgrid::monitor {
namespace {

bool same(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

template <class Vector>
bool same_vector(const Vector& a, const Vector& b) noexcept {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

/// But for the words.
bool same(const messages::Distance& a, const messages::Distance& b) noexcept {
  return a.id == b.id && same(a.distance, b.distance) && same(a.distance_now, b.distance_now) && a.state == b.state &&
         same_vector(a.nearest, b.nearest) && same_vector(a.direction, b.direction) &&
         same_vector(a.on_axis, b.on_axis) && a.camera == b.camera && same(a.known_to, b.known_to) &&
         same(a.blind, b.blind) && a.stale == b.stale && a.budget == b.budget;
}

}  // namespace

std::string difference(const messages::Distances& recorded, const messages::Distances& now) {
  for (std::size_t i = 0; i < recorded.distances.size(); ++i) {
    const messages::Distance& before = recorded.distances[i];
    const messages::Distance& after = now.distances[i];
    if (!same(before, after)) {
      std::ostringstream text;
      text.precision(std::numeric_limits<double>::max_digits10);
      text << "answer " << recorded.sequence << ": " << before.id << ": " << after.distance_now << " m, recorded "
           << before.distance_now << " m";
      return text.str();
    }
  }
  return {};
}

RecordedStates::RecordedStates(std::size_t joints, double longest_s)
    : joints_(joints), history_(joints, kJointSamples, longest_s, longest_s) {}

void RecordedStates::add(const messages::JointState& state) {
  if (state.position.size() != joints_) {
    fail("a recorded joint state has ", state.position.size(), " positions, the robot has ", joints_, " joints");
  }
  stamps_ns_.push_back(messages::nanoseconds(state.header.stamp));
  positions_.insert(positions_.end(), state.position.begin(), state.position.end());
}

std::optional<robot::JointMoment> RecordedStates::moment(std::int64_t stamp_ns, const RecordedClock& clock) {
  if (stamp_ns == 0) {
    return robot::JointMoment{};
  }
  const auto at = std::lower_bound(stamps_ns_.begin(), stamps_ns_.end(), stamp_ns);
  if (at == stamps_ns_.end() || *at != stamp_ns) {
    return std::nullopt;
  }
  const auto samples = static_cast<std::size_t>(at - stamps_ns_.begin()) + 1;
  for (; added_ < samples; ++added_) {
    const std::span<const double> q = std::span<const double>(positions_).subspan(added_ * joints_, joints_);
    if (!history_.add(clock.time_s(stamps_ns_[added_]), q)) {
      fail("the recorded joint states are not in the order of time");
    }
  }
  return robot::JointMoment{.samples = samples, .newest_s = clock.time_s(stamp_ns)};
}

AskedCell::AskedCell(const cell::CellSetup& setup, double longest_s, files::McapReader& reader,
                     const RecordedClock& clock)
    : setup_(setup),
      reader_(reader),
      clock_(clock),
      evaluator_(setup.rig, setup.settings, setup.options),
      places_(setup),
      parts_world_(setup.parts.size()),
      parts_(setup.parts.size()) {
  if (setup.robot) {
    states_.emplace(setup.robot->model.joints().size(), longest_s);
    intake_.emplace(setup.rig, *setup.robot, states_->history(), setup.exposure);
    for (const files::McapEntry& entry : entries(kRecordedJoints)) {
      states_->add(messages::from_bytes<messages::JointState>(reader_.read(entry).data));
    }
  }
  for (const RigCamera& camera : setup.rig.cameras) {
    Images& images = images_.emplace_back();
    for (const files::McapEntry& entry : entries(recorded_images(camera.id))) {
      images.by_stamp.emplace(static_cast<std::int64_t>(entry.log_time_ns), entry);
    }
  }
  for (const files::McapEntry& entry : entries(kRecordedFrames)) {
    for (const auto& place : messages::from_bytes<messages::Transforms>(reader_.read(entry).data).transforms) {
      images_.at(camera_index(setup.rig, place.child_frame_id))
          .places.emplace(messages::nanoseconds(place.header.stamp), place.transform);
    }
  }
}

std::optional<messages::Distances> AskedCell::ask(const messages::Distances& recorded, AskedAgain& counts) {
  check(recorded);
  const auto known = moment(recorded.joint_stamp);
  bool has_joints = known.has_value();
  bool has_images = true;
  for (std::size_t k = 0; k < images_.size(); ++k) {
    const auto known_then = moment(recorded.image_joint_stamps[k]);
    has_joints = has_joints && known_then;
    has_images = show(k, messages::nanoseconds(recorded.image_stamps[k]), known_then.value_or(robot::JointMoment{})) &&
                 has_images;
    if (!known_then) {
      images_[k].asked_ns.reset();
    }
  }
  if (!has_images || !has_joints) {
    ++(has_images ? counts.without_joints : counts.without_images);
    return std::nullopt;
  }
  const double now_s = clock_.time_s(messages::nanoseconds(recorded.header.stamp));
  (void)places_.find(now_s, states_ ? &states_->history() : nullptr, *known, parts_world_);
  evaluator_.evaluate(parts_world_, now_s, parts_);
  messages::Distances now = recorded;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const auto& camera = parts_[i].nearest.camera;
    now.distances[i] =
        messages::distance_of(parts_[i], setup_.parts[i].name,
                              camera ? setup_.rig.cameras.at(*camera).id : std::string(), recorded.distances[i].reason);
  }
  return now;
}

std::vector<files::McapEntry> AskedCell::entries(std::string_view topic) {
  const files::McapChannel* const channel = reader_.channel(topic);
  return channel == nullptr ? std::vector<files::McapEntry>() : reader_.entries(channel->id);
}

std::optional<robot::JointMoment> AskedCell::moment(const messages::Time& stamp) {
  return states_ ? states_->moment(messages::nanoseconds(stamp), clock_) : std::optional(robot::JointMoment{});
}

void AskedCell::check(const messages::Distances& recorded) const {
  const std::size_t cameras = images_.size();
  if (recorded.cameras.size() != cameras || recorded.image_stamps.size() != cameras ||
      recorded.image_joint_stamps.size() != cameras || recorded.distances.size() != parts_.size()) {
    fail("a recorded answer is of ", recorded.cameras.size(), " cameras and ", recorded.distances.size(),
         " parts, the cell has ", cameras, " and ", parts_.size(), ": it is not the one that was recorded");
  }
}

bool AskedCell::show(std::size_t camera, std::int64_t stamp_ns, const robot::JointMoment& known) {
  Images& images = images_[camera];
  if (images.asked_ns == stamp_ns) {
    return true;
  }
  images.asked_ns.reset();
  const auto found = images.by_stamp.find(stamp_ns);
  if (stamp_ns != 0 && found == images.by_stamp.end()) {
    return false;
  }
  Frame frame;
  Pose T_world_camera = setup_.rig.cameras[camera].T_world_camera;
  if (stamp_ns != 0) {
    const auto message = messages::from_bytes<messages::Image>(reader_.read(found->second).data);
    frame.depth = messages::depth_view(message, images.pixels, setup_.rig.cameras[camera].metres_per_unit);
    frame.time_s = clock_.time_s(stamp_ns);
    if (const auto place = images.places.find(stamp_ns); place != images.places.end()) {
      T_world_camera = recorded_pose(place->second);
    }
    if (intake_) {
      frame = intake_->frame(camera, frame, T_world_camera, known);
    }
  }
  const bool taken = evaluator_.update(camera, frame, T_world_camera).taken();
  if (taken == (stamp_ns != 0)) {  // what is no image makes the camera blind
    images.asked_ns = stamp_ns;
  }
  return images.asked_ns.has_value();
}

}  // namespace depthgrid::monitor
