#include "depthgrid/files/mcap_joints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/mcap_reader.hpp"
#include "depthgrid/messages/serialization.hpp"

namespace depthgrid::files {
namespace {

struct StampedJoints {
  std::int64_t stamp_ns = 0;
  std::vector<double> q;
};

const McapChannel& joint_channel(const McapReader& reader, std::string_view topic, const std::string& name) {
  const std::string_view type = messages::type_of<messages::JointState>().name;
  std::vector<const McapChannel*> found;
  std::string topics;
  for (const McapChannel& channel : reader.channels()) {
    if (channel.type == type && channel.encoding == "cdr") {
      const auto is_known = [&](const McapChannel* other) { return other->topic == channel.topic; };
      if (std::any_of(found.begin(), found.end(), is_known)) {
        continue;  // a recorder that began anew
      }
      topics += (topics.empty() ? "" : ", ") + printable_excerpt(channel.topic);
      if (topic.empty() || channel.topic == topic) {
        found.push_back(&channel);
      }
    }
  }
  if (found.empty()) {
    fail(name, ": has no joint states", topic.empty() ? "" : " on topic '" + printable_excerpt(topic) + "'",
         "; topics of sensor_msgs/JointState: ", topics.empty() ? "none" : topics);
  }
  if (topic.empty() && found.size() > 1) {
    fail(name, ": has joint states on several topics, say which: ", topics);
  }
  return *found.front();
}

/// Nothing where a joint is missing, which `missing` names then.
std::optional<std::vector<double>> positions(const messages::JointState& state, std::span<const std::string> joints,
                                             std::string& missing) {
  std::vector<double> q;
  for (const std::string& joint : joints) {
    const auto at = std::find(state.name.begin(), state.name.end(), joint) - state.name.begin();
    const auto index = static_cast<std::size_t>(at);
    if (index >= state.name.size() || index >= state.position.size() || !std::isfinite(state.position[index])) {
      missing = joint;
      return std::nullopt;
    }
    q.push_back(state.position[index]);
  }
  return q;
}

}  // namespace

JointTable load_mcap_joints(const std::filesystem::path& file, std::string_view topic,
                            std::span<const std::string> joints) {
  McapReader reader(file);
  const McapChannel channel = joint_channel(reader, topic, file.string());
  const std::string where = file.string() + ": topic '" + printable_excerpt(channel.topic) + "'";
  std::vector<StampedJoints> states;
  std::string missing;
  try {
    for (const McapEntry& entry : reader.entries(reader.same_as(channel))) {
      const auto state = messages::from_bytes<messages::JointState>(reader.read(entry).data);
      if (auto q = positions(state, joints, missing)) {
        states.push_back({.stamp_ns = messages::nanoseconds(state.header.stamp), .q = std::move(*q)});
      }
    }
  } catch (const Error& error) {
    fail(where, ": ", error.what());
  }
  if (states.empty()) {
    fail(where, missing.empty() ? " has no messages" : ": no state has all joints, for instance '" + missing + "'");
  }
  const auto before = [](const StampedJoints& a, const StampedJoints& b) { return a.stamp_ns < b.stamp_ns; };
  std::stable_sort(states.begin(), states.end(), before);
  JointTable table;
  table.time_column = "the stamps of " + channel.topic;
  for (const std::string& joint : joints) {
    table.joints.push_back({.column = joint, .values = {}, .unit = JointUnit::radians});
  }
  std::int64_t last_ns = 0;
  for (const StampedJoints& state : states) {
    if (!table.time_s.empty() && state.stamp_ns == last_ns) {
      continue;
    }
    last_ns = state.stamp_ns;
    const auto whole = state.stamp_ns / 1'000'000'000;
    table.time_s.push_back(static_cast<double>(whole) + static_cast<double>(state.stamp_ns % 1'000'000'000) * 1e-9);
    table.lines.push_back(table.time_s.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
      table.joints[j].values.push_back(state.q[j]);
    }
  }
  return table;
}

}  // namespace depthgrid::files
