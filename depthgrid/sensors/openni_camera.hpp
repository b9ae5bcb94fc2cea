// A depth camera by OpenNI2 (PrimeSense, Asus Xtion, Orbbec Astra, ...), and what OpenNI2 recorded; it is loaded when
// one is opened.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/sensors/device_clock.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

class OpenniLibrary;
namespace oni {
class DepthStream;
}

struct OpenniSettings {
  std::string device{};  ///< serial number, or URI; empty: the only one that is connected
  int width_px = 640;
  int height_px = 480;
  ArrivalTimes arrival{};
};

/// Depth in millimetres at 30 Hz, not registered to colour, not mirrored, without filters that its driver knows of. The
/// device states no intrinsics, only a field of view: info().nominal. Its stamps are of a clock of its own:
/// DeviceClock, with ArrivalTimes. Ends as failed when it is unplugged, and when no image comes within two seconds.
class OpenniCamera final : public DepthSource {
 public:
  /// `library` null: the one that all cameras share.
  explicit OpenniCamera(OpenniSettings settings, std::shared_ptr<const OpenniLibrary> library = nullptr);
  ~OpenniCamera() override;
  OpenniCamera(const OpenniCamera&) = delete;
  OpenniCamera& operator=(const OpenniCamera&) = delete;

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

  static constexpr double kLongestSilence_s = 2;

 private:
  OpenniSettings settings_;
  std::shared_ptr<const OpenniLibrary> library_;
  std::unique_ptr<oni::DepthStream> stream_;
  std::optional<DeviceClock> clock_;
  double last_image_s_ = 0;
  int last_index_ = -1;
  std::int64_t unsettled_ = 0;
  SourceInfo info_;
  std::string reason_;
};

struct OpenniSpan {
  double first_s = 0;
  double last_s = 0;  ///< by the number of images and their rate
  SourceInfo info{};
};

/// What a recording (.oni) holds; reads its first image. Its times are of the camera's own clock. Throws Error.
[[nodiscard]] OpenniSpan openni_span(const std::filesystem::path& file,
                                     std::shared_ptr<const OpenniLibrary> library = nullptr);

/// The depth images of a recording, lossless, each when it is asked for: none is passed over. OpenNI2 plays a file once
/// at a time: two of the same file share one place in it.
class OpenniRecording final : public DepthSource {
 public:
  /// `mirrored`: OpenNI2 mirrors images unless it is told not to, and a recording does not say whether it was.
  OpenniRecording(std::filesystem::path file, bool mirrored, std::shared_ptr<const Playback> playback,
                  std::shared_ptr<const OpenniLibrary> library = nullptr);
  ~OpenniRecording() override;
  OpenniRecording(const OpenniRecording&) = delete;
  OpenniRecording& operator=(const OpenniRecording&) = delete;

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return reason_; }
  [[nodiscard]] Reading next(DepthReading& reading, double longest_s) noexcept override;

  /// Without an image for so long it is at its end.
  static constexpr double kEnd_s = 0.5;

 private:
  void begin();
  /// got: an image is in the stream, and waits for its time.
  [[nodiscard]] Reading read_ahead(double longest_s);

  std::filesystem::path file_;
  bool mirrored_;
  std::shared_ptr<const Playback> playback_;
  std::shared_ptr<const OpenniLibrary> library_;
  std::unique_ptr<oni::DepthStream> stream_;
  bool waits_ = false;
  bool has_ended_ = false;
  bool has_given_ = false;  ///< in this round
  double silent_since_s_ = 0;
  std::int64_t round_ = 0;
  SourceInfo info_;
  std::string reason_;
};

struct OpenniFound {
  std::string name;
  std::string uri;
  std::string serial;
};

/// The devices that are connected. Throws Error, where OpenNI2 is not found as well.
[[nodiscard]] std::vector<OpenniFound> connected_openni(std::shared_ptr<const OpenniLibrary> library = nullptr);

}  // namespace depthgrid::sensors
