// The file of a cell's recording: its topics, and what stands in their messages. Internal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "depthgrid/files/mcap_writer.hpp"
#include "depthgrid/messages/camera_info.hpp"
#include "depthgrid/messages/image.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/monitor/cell_answer.hpp"
#include "depthgrid/monitor/event.hpp"
#include "depthgrid/monitor/recorded_format.hpp"
#include "depthgrid/monitor/recorder.hpp"

namespace depthgrid::monitor {

/// Images of a camera that may wait to be written.
inline constexpr std::size_t kRecordedImagesWait = 16;

/// - Times are of the cell's clock, seconds.
/// - Errors: Error that names the file, where the disk takes no more.
/// - Threads: one.
class RecordFile {
 public:
  /// Makes the file, and leaves none where that fails. Throws Error as Recorder's constructor does.
  explicit RecordFile(const RecorderSettings& settings);

  /// `joints_s`: the newest joint state that was known when the robot was taken out of it; NaN: none. `moved`: where a
  /// camera that moves stood.
  void image(std::size_t camera, const messages::Image& taken, double time_s, double joints_s,
             const std::optional<messages::Transform>& moved);
  void joints(double time_s, const std::vector<double>& q);
  void answer(const CellAnswer& answer);
  void event(const Event& event);
  void flush() { writer_.flush(); }
  /// The counts are what the file lacks.
  void finish(std::uint64_t lost_images, std::uint64_t lost_joint_states, std::uint64_t lost_answers);

 private:
  /// Of a camera's image: the newest joint state that was known.
  struct Known {
    double image_s = 0;
    double joints_s = 0;
  };

  struct CameraTopics {
    std::uint16_t image = 0;
    std::uint16_t info = 0;
    messages::CameraInfo calibration;
    std::deque<Known> known;
  };

  void begin();
  void write(std::uint16_t channel, const messages::Time& stamp, const auto& message) {
    messages::to_bytes(message, bytes_);
    const auto time_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, messages::nanoseconds(stamp)));
    writer_.write(channel, time_ns, time_ns, bytes_);
  }

  RecorderSettings settings_;
  RecordedClock clock_;
  files::McapWriter writer_;
  std::vector<CameraTopics> cameras_;
  std::uint16_t frames_ = 0;
  std::uint16_t joint_states_ = 0;
  std::uint16_t distances_ = 0;
  std::uint16_t happenings_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace depthgrid::monitor
