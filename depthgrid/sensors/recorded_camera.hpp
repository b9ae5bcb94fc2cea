// A camera of a recording: a folder with a rig.json and 16-bit PNG images, or an MCAP file.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "depthgrid/files/recording.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

/// First and last time of a camera's images, seconds, on the recording's clock.
struct RecordedSpan {
  double first_s = 0;
  double last_s = 0;
};

/// `options` choose one camera. Throws Error as files::Recording does, and where the recording says no times: neither
/// rate_hz nor time stamps.
[[nodiscard]] RecordedSpan recorded_span(const std::filesystem::path& recording,
                                         const files::RecordingOptions& options);
[[nodiscard]] RecordedSpan recorded_span(const std::filesystem::path& recording, const std::string& camera);

class RecordedCamera final : public DepthSource {
 public:
  /// `options` choose one camera.
  RecordedCamera(std::filesystem::path recording, files::RecordingOptions options,
                 std::shared_ptr<const Playback> playback);
  RecordedCamera(std::filesystem::path recording, const std::string& camera, std::shared_ptr<const Playback> playback);

  void open() override;
  void close() noexcept override { recording_.reset(); }
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

 private:
  [[nodiscard]] double due_s(int index) const;
  [[nodiscard]] Reading read(int index, DepthReading& reading);
  /// The first frame that has an image from `index` on, beginning anew where the recording repeats; none: the end.
  [[nodiscard]] bool go_to(int index);

  std::filesystem::path path_;
  files::RecordingOptions options_;
  std::shared_ptr<const Playback> playback_;
  std::optional<files::Recording> recording_;
  int index_ = 0;  ///< the next one
  std::int64_t round_ = 0;
  SourceInfo info_;
  std::string reason_;
};

}  // namespace depthgrid::sensors
