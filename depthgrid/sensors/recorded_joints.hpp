// Joint positions of a table of text (docs/command.md), or of a topic in an MCAP file, as a source.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/files/joint_table.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/recorded_camera.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

/// Radians or metres, as in a URDF; a column in degrees says so.
class RecordedJoints final : public JointSource {
 public:
  /// `topic`: of an MCAP file (its name ends so); empty: its only one.
  RecordedJoints(std::filesystem::path file, std::vector<std::string> joints, std::shared_ptr<const Playback> playback,
                 std::string topic = {});

  /// Throws Error as load_joint_table() and load_mcap_joints() do, where a joint has no column, or rows have no times.
  void open() override;
  void close() noexcept override { table_ = {}; }
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return ""; }
  [[nodiscard]] Reading next(JointReading& reading, double longest_s) noexcept override;

 private:
  std::filesystem::path file_;
  std::string topic_;
  std::vector<std::string> joints_;
  std::shared_ptr<const Playback> playback_;
  files::JointTable table_;
  std::vector<double> q_;
  std::size_t row_ = 0;
  std::int64_t round_ = 0;
  SourceInfo info_;
};

}  // namespace depthgrid::sensors
