#include "depthgrid/sensors/realsense_recording.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/realsense_frame.hpp"
#include "depthgrid/sensors/realsense_stream.hpp"

namespace depthgrid::sensors {
namespace {

std::unique_ptr<rs2::Stream> recorded_stream(const std::filesystem::path& file,
                                             std::shared_ptr<const rs2::Library>& library) {
  if (library == nullptr) {
    library = rs2::Library::shared();
  }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    fail(file.string(), ": is no file");
  }
  rs2::StreamRequest request;
  request.file = file.string();
  request.any_size = true;
  try {
    return std::make_unique<rs2::Stream>(library, request);
  } catch (const Error& error) {
    fail(file.string(), ": ", error.what());
  }
}

SourceInfo info_of(const rs2::Stream& stream, const std::filesystem::path& file) {
  return {.name = stream.name() + ", recording " + file.string(),
          .serial = stream.serial(),
          .clock = "the recording's",
          .intrinsics = stream.intrinsics(),
          .metres_per_unit = stream.metres_per_unit(),
          .settings = {}};
}

}  // namespace

RealSenseSpan realsense_span(const std::filesystem::path& file, const ArrivalTimes& arrival,
                             std::shared_ptr<const rs2::Library> library) {
  constexpr double kPatience_s = 5;
  const auto stream = recorded_stream(file, library);
  stream->start();
  const rs2::Owned<rs2::Frame> first = stream->take(kPatience_s);
  if (first == nullptr) {
    fail(file.string(), ": holds no depth image");
  }
  const int domain =
      library->call(library->functions().get_frame_timestamp_domain, static_cast<const rs2::Frame*>(first.get()));
  RealSenseSpan span;
  try {
    span.first_s = rs2::middle_s(*library, first.get(), rs2::lag_of_stamps(domain, arrival), stream->period_s());
  } catch (const Error& error) {
    fail(file.string(), ": ", error.what());
  }
  span.last_s = span.first_s + stream->duration_s();
  span.has_own_clock = domain == rs2::kHardwareClock;
  span.info = info_of(*stream, file);
  return span;
}

struct RealSenseRecording::Frames {
  rs2::Owned<rs2::Frame> given;
  rs2::Owned<rs2::Frame> waits;
};

RealSenseRecording::RealSenseRecording(std::filesystem::path file, std::shared_ptr<const Playback> playback,
                                       const ArrivalTimes& arrival, std::shared_ptr<const rs2::Library> library)
    : file_(std::move(file)), playback_(std::move(playback)), arrival_(arrival), library_(std::move(library)) {}

RealSenseRecording::~RealSenseRecording() { close(); }

void RealSenseRecording::begin() {
  close();
  stream_ = recorded_stream(file_, library_);
  const auto release = library_->functions().release_frame;
  frames_ = std::make_unique<Frames>(Frames{.given = {nullptr, release}, .waits = {nullptr, release}});
  has_given_ = false;
  stream_->start();
}

void RealSenseRecording::open() {
  begin();
  info_ = info_of(*stream_, file_);
  reason_.clear();
  round_ = playback_->round_at(clock_now_s());
}

void RealSenseRecording::close() noexcept {
  frames_.reset();
  stream_.reset();
}

double RealSenseRecording::due_s(const rs2::Frame* frame) const {
  const int domain = library_->call(library_->functions().get_frame_timestamp_domain, frame);
  const double lag_s = rs2::lag_of_stamps(domain, arrival_);
  return playback_->clock_s(rs2::middle_s(*library_, frame, lag_s, stream_->period_s()), round_);
}

Reading RealSenseRecording::wait_for_frame(double longest_s) {
  if (frames_->waits != nullptr) {
    return Reading::got;
  }
  frames_->waits = stream_->take(longest_s);
  if (frames_->waits != nullptr) {
    return Reading::got;
  }
  if (!stream_->has_ended()) {
    return Reading::nothing;
  }
  frames_->waits = stream_->take(0);  // it may have come since
  if (frames_->waits != nullptr) {
    return Reading::got;
  }
  if (!playback_->repeats() || !has_given_) {
    return Reading::ended;
  }
  begin();
  ++round_;
  return Reading::nothing;
}

Reading RealSenseRecording::next(DepthReading& reading, double longest_s) noexcept try {
  if (stream_ == nullptr) {
    reason_ = "is not open";
    return Reading::failed;
  }
  const double end_s = clock_now_s() + longest_s;
  reading.skipped = 0;
  const Reading found = wait_for_frame(longest_s);
  if (found != Reading::got) {
    return found;
  }
  if (playback_->pace() == Pace::as_recorded) {
    if (!wait_until(due_s(frames_->waits.get()), end_s - clock_now_s())) {
      return Reading::nothing;
    }
  }
  frames_->given = std::move(frames_->waits);
  while (playback_->pace() == Pace::as_recorded) {  // what is late is passed over
    frames_->waits = stream_->take(0);
    if (frames_->waits == nullptr || due_s(frames_->waits.get()) > clock_now_s()) {
      break;
    }
    frames_->given = std::move(frames_->waits);
    ++reading.skipped;
  }
  const rs2::Frame* const frame = frames_->given.get();
  has_given_ = true;
  reading.depth =
      rs2::depth_of(*library_, frame, info_.intrinsics->width_px, info_.intrinsics->height_px, info_.metres_per_unit);
  reading.time_s = due_s(frame);
  reading.T_world_camera.reset();
  return Reading::got;
} catch (const std::exception& error) {
  reason_ = error.what();
  return Reading::failed;
}

}  // namespace depthgrid::sensors
