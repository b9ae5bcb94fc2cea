// A recording of librealsense2 (.bag), played by it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "depthgrid/sensors/device_clock.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

namespace rs2 {
class Library;
class Stream;
struct Frame;
}  // namespace rs2

struct RealSenseSpan {
  double first_s = 0;
  double last_s = 0;  ///< or later: the file says how long it is, not when its last image was taken
  /// Its stamps are of a clock that no other recording shares: the device's own.
  bool has_own_clock = false;
  SourceInfo info{};
};

/// What a file holds; reads its first image. Throws Error; also where its stamps are of the arrival, or of global time,
/// and `arrival` does not cover how far they may be off, as of a camera that is there. `library` null: the one that all
/// cameras share.
[[nodiscard]] RealSenseSpan realsense_span(const std::filesystem::path& file, const ArrivalTimes& arrival,
                                           std::shared_ptr<const rs2::Library> library = nullptr);

/// Its first stream of 16-bit depth, lossless. Times are as of a camera that is there: the middle of the exposure;
/// where the file does not say it a whole period is taken off, and off stamps of the arrival what is declared. Settings
/// are those that it was recorded with. The library reads ahead by a few images.
class RealSenseRecording final : public DepthSource {
 public:
  RealSenseRecording(std::filesystem::path file, std::shared_ptr<const Playback> playback, const ArrivalTimes& arrival,
                     std::shared_ptr<const rs2::Library> library = nullptr);
  ~RealSenseRecording() override;
  RealSenseRecording(const RealSenseRecording&) = delete;
  RealSenseRecording& operator=(const RealSenseRecording&) = delete;

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

 private:
  struct Frames;  ///< the one whose pixels were given, and the one that waits for its time
  void begin();
  [[nodiscard]] Reading wait_for_frame(double longest_s);
  [[nodiscard]] double due_s(const rs2::Frame* frame) const;

  std::filesystem::path file_;
  std::shared_ptr<const Playback> playback_;
  ArrivalTimes arrival_;
  std::shared_ptr<const rs2::Library> library_;
  std::unique_ptr<rs2::Stream> stream_;
  std::unique_ptr<Frames> frames_;
  std::int64_t round_ = 0;
  bool has_given_ = false;  ///< in this round
  SourceInfo info_;
  std::string reason_;
};

}  // namespace depthgrid::sensors
