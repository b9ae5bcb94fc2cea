#include "depthgrid/monitor/camera_line.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/usable_frame.hpp"
#include "depthgrid/monitor/device_says.hpp"
#include "depthgrid/monitor/source_loop.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {
namespace {

void count(std::atomic<std::int64_t>& counter, std::int64_t by = 1) noexcept {
  counter.fetch_add(by, std::memory_order_relaxed);
}

}  // namespace

SourceCounts SourceCounters::now() const noexcept {
  return {taken.load(std::memory_order_relaxed),   skipped.load(std::memory_order_relaxed),
          refused.load(std::memory_order_relaxed), dropped.load(std::memory_order_relaxed),
          opened.load(std::memory_order_relaxed),  failures.load(std::memory_order_relaxed)};
}

CameraLine::CameraLine(std::unique_ptr<sensors::DepthSource> source, const RigCamera& camera,
                       const CameraLineSettings& settings, search::SearchEvaluator& evaluator,
                       robot::FrameIntake* intake)
    : source_(std::move(source)),
      camera_(camera),
      settings_(settings),
      evaluator_(evaluator),
      intake_(intake),
      check_(settings.max_image_age_s, settings.equal_images),
      measured_m_(camera.intrinsics.width_px, camera.intrinsics.height_px) {}

void CameraLine::tell(EventKind kind, std::string_view words) noexcept {
  Event event;
  event.time_s = sensors::clock_now_s();
  event.kind = kind;
  event.camera = settings_.camera;
  event.state = state();
  event.say(words);
  events_.push(event);
}

void CameraLine::set_state(CameraState state, std::string_view why) noexcept {
  const CameraState before = state_.exchange(state, std::memory_order_relaxed);
  const bool silent = before == CameraState::opening || before == CameraState::waiting ||
                      state == CameraState::opening || state == CameraState::waiting;
  if (before != state && !(silent && state == CameraState::live) && state != CameraState::opening &&
      state != CameraState::waiting) {
    tell(EventKind::camera_state, why);
  }
}

bool CameraLine::open() noexcept {
  set_state(CameraState::opening, "");
  try {
    source_->open();
    const sensors::SourceInfo& info = source_->info();
    try {
      refuse_other_images(info, camera_.intrinsics);
    } catch (...) {
      source_->close();
      throw;
    }
    count(counters_.opened);
    check_.begin_anew();
    heard_s_ = sensors::clock_now_s();
    set_state(CameraState::waiting, "");
    tell(EventKind::source_open, info.settings.empty() ? info.name : info.name + "; " + info.settings);
    return true;
  } catch (const std::exception& error) {
    count(counters_.failures);
    state_.store(CameraState::failed, std::memory_order_relaxed);
    tell(EventKind::source_failed, error.what());
  } catch (...) {
    count(counters_.failures);
    state_.store(CameraState::failed, std::memory_order_relaxed);
    tell(EventKind::source_failed, "unknown error");
  }
  return false;
}

// Whoever looks at its state has to see that it is gone, not only that its image grows old.
void CameraLine::has_nothing() noexcept {
  if ((state() == CameraState::live || state() == CameraState::no_reading) &&
      sensors::clock_now_s() - heard_s_ > settings_.max_image_age_s) {
    set_state(CameraState::silent, "no image for longer than images count");
  }
}

void CameraLine::has_ended() noexcept {
  if (state() != CameraState::ended) {
    state_.store(CameraState::ended, std::memory_order_relaxed);
    tell(EventKind::source_ended, "at its end");
  }
}

void CameraLine::has_failed() noexcept {
  count(counters_.failures);
  state_.store(CameraState::failed, std::memory_order_relaxed);
  tell(EventKind::source_failed, source_->reason());
}

void CameraLine::run(const std::stop_token& stop) noexcept { follow(*source_, sensors::DepthReading{}, *this, stop); }

double CameraLine::share_without_reading(const DepthView& depth) noexcept {
  normalise(with_stride(depth), camera_.rule, measured_m_);
  const std::size_t pixels =
      static_cast<std::size_t>(measured_m_.width_px()) * static_cast<std::size_t>(measured_m_.height_px());
  const auto none = std::count(measured_m_.data(), measured_m_.data() + pixels, 0.0F);
  return static_cast<double>(none) / static_cast<double>(pixels);
}

bool CameraLine::is_refused(const sensors::DepthReading& reading, bool is_empty) noexcept {
  switch (check_.look(reading.depth, is_empty, reading.time_s, sensors::clock_now_s())) {
    case ImageVerdict::new_image:
      return false;
    case ImageVerdict::from_the_future:
      set_state(CameraState::wrong_clock, "image refused: its time lies in the future, the camera's clock is another");
      break;
    case ImageVerdict::too_old:
      set_state(CameraState::wrong_clock, "image refused: it is older than images count, delayed or of another clock");
      break;
    case ImageVerdict::equal_pixels:
      set_state(CameraState::frozen,
                "image refused: the same pixels as before with a new time (equal_images: true allows it)");
      break;
    case ImageVerdict::not_newer:  // one image late or twice says nothing of the camera
      break;
  }
  count(counters_.refused);
  return true;
}

void CameraLine::take(const sensors::DepthReading& given) noexcept {
  heard_s_ = sensors::clock_now_s();
  sensors::DepthReading reading = given;
  reading.time_s = sensors::seconds_of(sensors::nanoseconds_of(given.time_s));  // as a recording holds it
  count(counters_.skipped, reading.skipped);
  // What cannot be an image is told by the evaluator, which then takes the camera for blind; its pixels are not read.
  const bool readable = why_unusable(reading.depth, camera_.intrinsics) == nullptr;
  const double share = readable ? share_without_reading(reading.depth) : 1;
  if (readable && is_refused(reading, !(share < 1))) {
    return;
  }
  const double begin_s = sensors::clock_now_s();
  receipt_.add(begin_s - reading.time_s);
  const Pose T_world_camera = reading.T_world_camera ? recordable(*reading.T_world_camera) : camera_.T_world_camera;
  robot::JointMoment known;
  Frame frame{reading.depth, {}, reading.time_s};
  if (intake_ != nullptr && readable) {
    frame = intake_->frame(settings_.camera, frame, T_world_camera);
    known = intake_->report()[settings_.camera].known;
  }
  if (recorder_ != nullptr && readable) {  // before anybody can ask it
    recorder_->image(settings_.camera, reading.depth, reading.time_s, reading.T_world_camera,
                     known.samples > 0 ? known.newest_s : Proximity::kNaN);
  }
  const FrameUpdate update = evaluator_.update(settings_.camera, frame, T_world_camera);
  const double end_s = sensors::clock_now_s();
  preparation_.add(end_s - begin_s);
  switch (update.result) {
    case UpdateResult::taken:
      count(counters_.taken);
      prepared_s_.store(end_s, std::memory_order_relaxed);
      without_reading_.store(share, std::memory_order_relaxed);
      share < 1 ? set_state(CameraState::live, "its images are used again")
                : set_state(CameraState::no_reading, "its image shows nothing: no pixel has a reading");
      break;
    case UpdateResult::unusable:
      count(counters_.refused);
      without_reading_.store(1, std::memory_order_relaxed);
      set_state(CameraState::unusable, update.reason);
      break;
    case UpdateResult::dropped:
      count(counters_.dropped);
      break;
  }
}

}  // namespace depthgrid::monitor
