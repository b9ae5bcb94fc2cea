#include "depthgrid/sensors/recorded_joints.hpp"

#include <numbers>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/mcap_joints.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::sensors {

RecordedJoints::RecordedJoints(std::filesystem::path file, std::vector<std::string> joints,
                               std::shared_ptr<const Playback> playback, std::string topic)
    : file_(std::move(file)),
      topic_(std::move(topic)),
      joints_(std::move(joints)),
      playback_(std::move(playback)),
      q_(joints_.size()) {}

void RecordedJoints::open() {
  const bool is_mcap = file_.extension() == ".mcap";
  files::JointTable table =
      is_mcap ? files::load_mcap_joints(file_, topic_, joints_) : files::load_joint_table(file_, joints_);
  if (table.time_s.empty()) {
    fail(file_.string(), ": has no times, so it cannot be played: a column time");
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (table.joints[i].column.empty()) {
      fail(file_.string(), ": has no column for joint ", joints_[i]);
    }
    if (table.joints[i].unit == files::JointUnit::degrees) {
      for (double& value : table.joints[i].values) {
        value *= std::numbers::pi / 180;
      }
    }
  }
  table_ = std::move(table);
  info_ = {(is_mcap ? "recording " : "table ") + file_.string(), "", "the recording's", std::nullopt, 0.001};
  row_ = 0;
  round_ = playback_->round_at(clock_now_s());
}

Reading RecordedJoints::next(JointReading& reading, double longest_s) noexcept {
  if (row_ >= table_.time_s.size()) {
    if (!playback_->repeats() || table_.time_s.empty()) {
      return Reading::ended;
    }
    row_ = 0;
    ++round_;
  }
  const double time_s = playback_->clock_s(table_.time_s[row_], round_);
  if (playback_->pace() == Pace::as_recorded && !wait_until(time_s, longest_s)) {
    return Reading::nothing;
  }
  for (std::size_t i = 0; i < q_.size(); ++i) {
    q_[i] = table_.joints[i].values[row_];
  }
  ++row_;
  reading = {q_, time_s};
  return Reading::got;
}

}  // namespace depthgrid::sensors
