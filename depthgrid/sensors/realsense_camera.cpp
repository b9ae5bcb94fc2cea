#include "depthgrid/sensors/realsense_camera.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/realsense_frame.hpp"
#include "depthgrid/sensors/realsense_stream.hpp"
#include "depthgrid/sensors/system_clock.hpp"

namespace depthgrid::sensors {

struct RealSenseCamera::Held {
  rs2::Owned<rs2::Frame> frame;
};

RealSenseCamera::RealSenseCamera(RealSenseSettings settings) : RealSenseCamera(std::move(settings), nullptr) {}

RealSenseCamera::RealSenseCamera(RealSenseSettings settings, std::shared_ptr<const rs2::Library> library)
    : settings_(std::move(settings)), library_(std::move(library)) {}

RealSenseCamera::~RealSenseCamera() { close(); }

void RealSenseCamera::open() {
  close();
  if (library_ == nullptr) {
    library_ = rs2::Library::shared();
  }
  rs2::StreamRequest request;
  request.serial = settings_.serial;
  request.width_px = settings_.width_px;
  request.height_px = settings_.height_px;
  request.rate_hz = settings_.rate_hz;
  auto stream = std::make_unique<rs2::Stream>(library_, request);
  info_ = {.name = stream->name(),
           .serial = stream->serial(),
           .clock = "not known before the first image",
           .intrinsics = stream->intrinsics(),
           .metres_per_unit = stream->metres_per_unit(),
           .settings = stream->settings()};
  stream->start();
  stream_ = std::move(stream);
  domain_.reset();
  device_clock_.reset();
  opened_s_ = clock_now_s();
  last_number_ = -1;
  unsettled_ = 0;
  last_image_s_ = clock_now_s();
  reason_.clear();
}

void RealSenseCamera::close() noexcept {
  held_.reset();
  stream_.reset();
}

void RealSenseCamera::begin_clock(int domain) {
  arrival_lag_s_ = rs2::lag_of_stamps(domain, settings_.arrival);
  if (domain == rs2::kSystemTime) {
    info_.clock = "this computer, when images arrive";
  } else if (domain == rs2::kHardwareClock) {
    device_clock_.emplace(
        lag_or_refuse(settings_.arrival, "the device's clock is known here by the images' arrival alone"));
    info_.clock = "the device, by the images' arrival";
  } else if (domain == rs2::kGlobalTime) {
    device_clock_.emplace(0);
    info_.clock = "the device, as librealsense2 converts it to this computer's";
  } else {
    fail("stamps images by a clock that is not known here (domain ", domain, ")");
  }
}

std::optional<double> RealSenseCamera::exposed_s(const rs2::Frame* frame, double arrival_s) {
  const int domain = library_->call(library_->functions().get_frame_timestamp_domain, frame);
  if (domain_ && *domain_ != domain) {
    fail("its stamps change to another clock in mid-run (domain ", *domain_, ", then ", domain, ")");
  }
  // Until the library has asked for the device's time once, it hands on the device's own stamps.
  if (!domain_ && domain == rs2::kHardwareClock && stream_->has_global_time() && arrival_s - opened_s_ < kComparing_s) {
    return std::nullopt;
  }
  if (!domain_) {
    begin_clock(domain);
    domain_ = domain;
    domain_since_s_ = arrival_s;
  }
  const double middle_s = rs2::middle_s(*library_, frame, arrival_lag_s_, 1.0 / settings_.rate_hz);
  if (domain == rs2::kSystemTime) {
    return clock_of_system_s(middle_s);
  }
  if (domain == rs2::kHardwareClock) {
    const double time_s = device_clock_->clock_s(middle_s, arrival_s);
    return device_clock_->is_settled() ? std::optional(time_s) : std::nullopt;
  }
  if (arrival_s - domain_since_s_ < kFitting_s) {
    return std::nullopt;
  }
  // No image comes before its exposure has ended: stamps that say so are off by that at least, and so are their like.
  const double time_s = clock_of_system_s(middle_s);
  const double latest_s = arrival_s - rs2::exposure_s(*library_, frame).value_or(0) / 2;
  return std::min(time_s, device_clock_->clock_s(time_s, latest_s));
}

Reading RealSenseCamera::silence(double now_s) {
  if (stream_->is_gone()) {
    fail("was unplugged");
  }
  if (now_s - last_image_s_ > kLongestSilence_s) {
    fail("sends no image within ", kLongestSilence_s, " s");
  }
  return Reading::nothing;
}

Reading RealSenseCamera::read(DepthReading& reading) {
  const rs2::Frame* const frame = held_->frame.get();
  const double arrival_s = clock_now_s();
  last_image_s_ = arrival_s;
  const std::optional<double> exposure_s = rs2::exposure_s(*library_, frame);
  constexpr double kRounding_s = 1e-4;
  if (settings_.longest_exposure_s && exposure_s && *exposure_s > *settings_.longest_exposure_s + kRounding_s) {
    fail("exposes for ", *exposure_s, " s, the cell says at most twice half_exposure_s, ",
         *settings_.longest_exposure_s, " s");
  }
  reading.depth = rs2::depth_of(*library_, frame, settings_.width_px, settings_.height_px, info_.metres_per_unit);
  const auto number = static_cast<std::int64_t>(library_->call(library_->functions().get_frame_number, frame));
  reading.skipped = last_number_ >= 0 ? std::max<std::int64_t>(number - last_number_ - 1, 0) : 0;
  last_number_ = number;
  const std::optional<double> time_s = exposed_s(frame, arrival_s);
  if (!time_s) {
    unsettled_ += 1 + reading.skipped;
    return Reading::nothing;
  }
  reading.time_s = *time_s;
  reading.skipped += std::exchange(unsettled_, 0);
  reading.T_world_camera.reset();
  return Reading::got;
}

Reading RealSenseCamera::next(DepthReading& reading, double longest_s) noexcept try {
  if (stream_ == nullptr) {
    reason_ = "is not open";
    return Reading::failed;
  }
  if (stream_->is_gone()) {
    return silence(clock_now_s());
  }
  held_.reset();
  rs2::Owned<rs2::Frame> frame = stream_->take(longest_s);
  if (frame == nullptr) {
    return silence(clock_now_s());
  }
  held_ = std::make_unique<Held>(Held{std::move(frame)});
  return read(reading);
} catch (const std::exception& error) {
  reason_ = error.what();
  return Reading::failed;
}

std::vector<RealSenseFound> connected_realsense() {
  std::vector<RealSenseFound> found;
  for (const rs2::FoundDevice& device : rs2::connected(*rs2::Library::shared())) {
    found.push_back({device.name, device.serial});
  }
  return found;
}

}  // namespace depthgrid::sensors
