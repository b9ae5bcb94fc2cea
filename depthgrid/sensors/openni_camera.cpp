#include "depthgrid/sensors/openni_camera.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/openni_stream.hpp"

namespace depthgrid::sensors {
namespace {

constexpr int kRate_hz = 30;

const std::shared_ptr<const OpenniLibrary>& or_shared(std::shared_ptr<const OpenniLibrary>& library) {
  if (library == nullptr) {
    library = OpenniLibrary::shared();
  }
  return library;
}

std::unique_ptr<oni::DepthStream> recorded_openni(const std::filesystem::path& file, bool mirrored,
                                                  std::shared_ptr<const OpenniLibrary>& library) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    fail(file.string(), ": is no file");
  }
  oni::StreamRequest request;
  request.file = std::filesystem::absolute(file, ignored).string();
  request.mirrored = mirrored;
  try {
    return std::make_unique<oni::DepthStream>(or_shared(library), request);
  } catch (const Error& error) {
    fail(file.string(), ": ", error.what());
  }
}

SourceInfo recorded_info(const oni::DepthStream& stream, const std::filesystem::path& file) {
  return {.name = "OpenNI2 recording " + file.string(),
          .serial = {},
          .clock = "the recording's",
          .intrinsics = std::nullopt,
          .metres_per_unit = stream.metres_per_unit(),
          .settings = {}};
}

}  // namespace

OpenniCamera::OpenniCamera(OpenniSettings settings, std::shared_ptr<const OpenniLibrary> library)
    : settings_(std::move(settings)), library_(std::move(library)) {}

OpenniCamera::~OpenniCamera() { close(); }

void OpenniCamera::close() noexcept { stream_.reset(); }

void OpenniCamera::open() {
  close();
  clock_.emplace(lag_or_refuse(settings_.arrival, "the device's clock is known here by the images' arrival alone"));
  oni::StreamRequest request;
  request.device = settings_.device;
  request.width_px = settings_.width_px;
  request.height_px = settings_.height_px;
  request.rate_hz = kRate_hz;
  auto stream = std::make_unique<oni::DepthStream>(or_shared(library_), request);
  info_ = {.name = stream->name(),
           .serial = stream->serial(),
           .clock = "the device, by the images' arrival",
           .intrinsics = std::nullopt,
           .metres_per_unit = stream->metres_per_unit(),
           .settings = stream->settings(),
           .nominal = stream->nominal()};
  stream->start();
  stream_ = std::move(stream);
  last_index_ = -1;
  unsettled_ = 0;
  last_image_s_ = clock_now_s();
  reason_.clear();
}

Reading OpenniCamera::next(DepthReading& reading, double longest_s) noexcept try {
  if (stream_ == nullptr) {
    reason_ = "is not open";
    return Reading::failed;
  }
  const bool has_image = !stream_->is_gone() && stream_->take(longest_s);
  const double now_s = clock_now_s();
  if (stream_->is_gone()) {
    fail("was unplugged");
  }
  if (!has_image) {
    if (now_s - last_image_s_ > kLongestSilence_s) {
      fail("sends no image within ", kLongestSilence_s, " s");
    }
    return Reading::nothing;
  }
  last_image_s_ = now_s;
  const int index = stream_->index();
  const std::int64_t skipped = last_index_ >= 0 ? std::max(index - last_index_ - 1, 0) : 0;
  last_index_ = index;
  const double time_s = clock_->clock_s(stream_->stamp_s(), now_s);
  if (!clock_->is_settled()) {
    unsettled_ += 1 + skipped;
    return Reading::nothing;
  }
  reading.depth = stream_->depth();
  reading.time_s = time_s;
  reading.skipped = skipped + std::exchange(unsettled_, 0);
  reading.T_world_camera.reset();
  return Reading::got;
} catch (const std::exception& error) {
  reason_ = error.what();
  return Reading::failed;
}

OpenniSpan openni_span(const std::filesystem::path& file, std::shared_ptr<const OpenniLibrary> library) {
  constexpr double kPatience_s = 5;
  const auto stream = recorded_openni(file, false, library);
  stream->start();
  if (!stream->take(kPatience_s)) {
    fail(file.string(), ": holds no depth image");
  }
  OpenniSpan span;
  span.first_s = stream->stamp_s();
  span.last_s =
      span.first_s + std::max(stream->frames() - 1, 0) / static_cast<double>(std::max(stream->mode().rate_hz, 1));
  span.info = recorded_info(*stream, file);
  return span;
}

OpenniRecording::OpenniRecording(std::filesystem::path file, bool mirrored, std::shared_ptr<const Playback> playback,
                                 std::shared_ptr<const OpenniLibrary> library)
    : file_(std::move(file)), mirrored_(mirrored), playback_(std::move(playback)), library_(std::move(library)) {}

OpenniRecording::~OpenniRecording() { close(); }

void OpenniRecording::close() noexcept { stream_.reset(); }

void OpenniRecording::begin() {
  close();
  stream_ = recorded_openni(file_, mirrored_, library_);
  stream_->start();
  waits_ = false;
  has_ended_ = false;
  has_given_ = false;
  silent_since_s_ = clock_now_s();
}

void OpenniRecording::open() {
  begin();
  info_ = recorded_info(*stream_, file_);
  info_.settings = stream_->settings();
  reason_.clear();
  round_ = playback_->round_at(clock_now_s());
}

Reading OpenniRecording::read_ahead(double longest_s) {
  if (waits_) {
    return Reading::got;
  }
  if (has_ended_) {
    return Reading::ended;
  }
  waits_ = stream_->take(longest_s);
  const double now_s = clock_now_s();
  if (waits_) {
    silent_since_s_ = now_s;
    return Reading::got;
  }
  if (now_s - silent_since_s_ < kEnd_s) {
    return Reading::nothing;
  }
  if (!playback_->repeats() || !has_given_) {
    has_ended_ = true;
    stream_->stop();
    return Reading::ended;
  }
  begin();
  ++round_;
  return Reading::nothing;
}

Reading OpenniRecording::next(DepthReading& reading, double longest_s) noexcept try {
  if (stream_ == nullptr) {
    reason_ = "is not open";
    return Reading::failed;
  }
  const double end_s = clock_now_s() + longest_s;
  const Reading found = read_ahead(longest_s);
  if (found != Reading::got) {
    return found;
  }
  const double due_s = playback_->clock_s(stream_->stamp_s(), round_);
  if (playback_->pace() == Pace::as_recorded && !wait_until(due_s, end_s - clock_now_s())) {
    silent_since_s_ = clock_now_s();
    return Reading::nothing;
  }
  waits_ = false;
  has_given_ = true;
  silent_since_s_ = clock_now_s();
  reading.depth = stream_->depth();
  reading.time_s = due_s;
  reading.skipped = 0;
  reading.T_world_camera.reset();
  return Reading::got;
} catch (const std::exception& error) {
  reason_ = error.what();
  return Reading::failed;
}

std::vector<OpenniFound> connected_openni(std::shared_ptr<const OpenniLibrary> library) {
  std::vector<OpenniFound> found;
  for (const oni::FoundDevice& device : oni::connected(or_shared(library))) {
    found.push_back({device.name, device.uri, device.serial});
  }
  return found;
}

}  // namespace depthgrid::sensors
