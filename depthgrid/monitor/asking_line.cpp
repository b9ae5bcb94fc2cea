#include "depthgrid/monitor/asking_line.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {
namespace {

using avoidance::MotionLimit;

/// Below everything where nothing is known.
double room_m(const Answer& answer) noexcept {
  const double clear_m = clear_of_layer_m(answer);
  return std::isnan(clear_m) ? -1 : clear_m;
}

MotionLimit limit_of(const Answer& answer) noexcept {
  if (std::isnan(clear_of_layer_m(answer))) {
    return MotionLimit::unknown_distance;
  }
  if (answer.blind_m > 0 && answer.distance_now_m <= answer.blind_m) {
    return MotionLimit::blind_layer;
  }
  if (answer.nearest.budget) {
    return MotionLimit::budget;
  }
  return answer.nearest.state == ProximityState::beyond_rho ? MotionLimit::none : MotionLimit::obstacle;
}

}  // namespace

AskingLine::AskingLine(const cell::CellSetup& setup, const StopRule& rule, search::SearchEvaluator& evaluator,
                       const robot::JointHistory* history, const std::vector<std::unique_ptr<CameraLine>>& cameras)
    : places_(setup),
      has_robot_(setup.robot.has_value()),
      hold_(rule.hold_s),
      max_image_age_s_(setup.options.max_image_age_s),
      evaluator_(evaluator),
      history_(history),
      cameras_(cameras) {
  answer_.parts.resize(setup.parts.size());
  answer_.parts_world.resize(setup.parts.size());
  newer_.parts_world.resize(setup.parts.size());
  older_.parts_world.resize(setup.parts.size());
  answer_.camera_count = cameras_.size();
  answer_.reason.stop_m = rule.stop_m;
  answer_.reason.v_max_m_s = setup.settings.v_max_m_s;
}

bool AskingLine::place_parts(double now_s) noexcept {
  robot::JointMoment known;
  answer_.joints_age_s = 0;
  if (has_robot_ && history_ != nullptr) {
    known = history_->now();
    answer_.joints_s = known.samples > 0 ? known.newest_s : Proximity::kNaN;
    answer_.joints_age_s = now_s - answer_.joints_s;
  }
  return places_.find(now_s, history_, known, answer_.parts_world);
}

void AskingLine::remember_parts(bool placed) noexcept {
  constexpr double kApart_s = 0.1;
  if (answer_.time_s - newer_.time_s < kApart_s) {
    return;
  }
  std::swap(newer_, older_);
  newer_.time_s = placed ? answer_.time_s : Proximity::kNaN;
  std::copy(answer_.parts_world.begin(), answer_.parts_world.end(), newer_.parts_world.begin());
}

double AskingLine::speed_m_s(std::size_t part) const noexcept {
  constexpr double kLongest_s = 0.5;
  const double apart_s = answer_.time_s - older_.time_s;
  if (!(apart_s > 0 && apart_s <= kLongest_s)) {
    return Proximity::kNaN;
  }
  const Capsule& now = answer_.parts_world[part];
  const Capsule& before = older_.parts_world[part];
  return std::max((now.a - before.a).norm(), (now.b - before.b).norm()) / apart_s;
}

void AskingLine::look_at_cameras() noexcept {
  double newest_s = -std::numeric_limits<double>::infinity();
  double oldest_s = std::numeric_limits<double>::infinity();
  Reason& reason = answer_.reason;
  reason.camera.reset();
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    const double image_s = evaluator_.image_time_s(k);
    CameraBasis& basis = answer_.cameras[k];
    basis.state = cameras_[k]->state();
    basis.without_reading = cameras_[k]->without_reading();
    const bool is_new_image = image_s > basis.image_s;
    basis.image_s = image_s;
    // What is not yet told of this image is older than it.
    if (const double prepared_s = cameras_[k]->prepared_s(); is_new_image && prepared_s > image_s) {
      histograms_.hand_over.add(std::max(0.0, answer_.time_s - prepared_s));
    }
    basis.age_s = answer_.time_s - image_s;
    basis.late = !(basis.age_s <= max_image_age_s_);
    if (!basis.late) {
      newest_s = std::max(newest_s, image_s);
      oldest_s = std::min(oldest_s, image_s);
    }
    histograms_.image_age[k].add(basis.age_s);
    if (!reason.camera && (basis.late || basis.state != CameraState::live)) {
      reason.camera = k;
      reason.camera_state = basis.state;
      reason.camera_age_s = basis.age_s;
    }
  }
  const double exposure_s = newest_s >= oldest_s ? newest_s : Proximity::kNaN;
  const bool is_new = exposure_s != answer_.exposure_s && std::isfinite(exposure_s);
  answer_.exposure_s = exposure_s;
  answer_.skew_s = newest_s >= oldest_s ? newest_s - oldest_s : Proximity::kNaN;
  reason.reaction_s = answer_.done_s - exposure_s;
  histograms_.skew.add(answer_.skew_s);
  if (is_new) {
    histograms_.exposure_to_answer.add(reason.reaction_s);
  }
}

void AskingLine::find_reason(bool placed) noexcept {
  Reason& reason = answer_.reason;
  reason.part.reset();
  reason.joints_age_s = answer_.joints_age_s;
  answer_.blind_m = 0;
  double least_room_m = std::numeric_limits<double>::infinity();
  double least_m = std::numeric_limits<double>::infinity();
  bool has_unknown = false;
  for (std::size_t i = 0; i < answer_.parts.size(); ++i) {
    const Answer& part = answer_.parts[i];
    answer_.blind_m = thicker(answer_.blind_m, part.blind_m);
    has_unknown = has_unknown || std::isnan(room_m(part)) || room_m(part) < 0;
    least_m = std::min(least_m, part.distance_now_m);
    const double room = room_m(part);
    // Of parts with equal room, 0 for one, the one that is nearer.
    const bool nearer = !reason.part || room < least_room_m ||
                        (room == least_room_m && part.distance_now_m < answer_.parts[*reason.part].distance_now_m);
    if (nearer) {
      least_room_m = room;
      reason.part = i;
    }
  }
  const std::size_t part = reason.part.value_or(0);
  const Answer& worst = answer_.parts[part];
  reason.part_motion_m = places_.motion_m(part);
  reason.part_speed_m_s = placed ? speed_m_s(part) : Proximity::kNaN;
  answer_.distance_m = has_unknown ? Proximity::kNaN : least_m;
  answer_.clear_m = has_unknown ? Proximity::kNaN : least_room_m;
  reason.nearest = worst.nearest;
  reason.distance_m = worst.distance_now_m;
  reason.clear_m = clear_of_layer_m(worst);
  reason.blind_m = worst.blind_m;
  reason.limit = limit_of(worst);
  const bool any_image = std::isfinite(answer_.exposure_s);
  if (!any_image) {
    reason.limit = MotionLimit::no_images;
  }
  if (!placed) {
    reason.limit = MotionLimit::no_joint_state;
  }
  answer_.stop = !(answer_.clear_m > reason.stop_m) || !any_image || !placed;
}

void AskingLine::hold_stop() noexcept {
  answer_.stop = hold_.look(answer_.stop, answer_.time_s);
  answer_.reason.clear_s = answer_.stop ? hold_.clear_s() : 0;
}

void AskingLine::note(bool was_stopped) noexcept {
  answers_.fetch_add(1, std::memory_order_relaxed);
  by_state_[static_cast<std::size_t>(answer_.reason.limit)].fetch_add(1, std::memory_order_relaxed);
  stopped_.fetch_add(answer_.stop ? 1 : 0, std::memory_order_relaxed);
  if (answer_.stop != was_stopped || !has_asked_) {
    Event event;
    event.time_s = answer_.time_s;
    event.kind = answer_.stop ? EventKind::stop : EventKind::go;
    event.reason = answer_.reason;
    events_.push(event);
    stops_.fetch_add(answer_.stop ? 1 : 0, std::memory_order_relaxed);
  }
}

const CellAnswer& AskingLine::ask(double now_s) noexcept {
  const bool was_stopped = answer_.stop;
  const bool on_time = !has_asked_ || now_s > answer_.time_s;
  if (has_asked_) {
    histograms_.period.add(now_s - answer_.time_s);
  }
  ++answer_.sequence;
  answer_.time_s = now_s;
  const bool placed = place_parts(now_s);
  evaluator_.evaluate(answer_.parts_world, now_s, answer_.parts);
  answer_.done_s = sensors::clock_now_s();
  histograms_.asking.add(answer_.done_s - now_s);
  look_at_cameras();
  remember_parts(placed);
  find_reason(placed);
  if (!on_time) {
    answer_.reason.limit = MotionLimit::clock;
    answer_.stop = true;
  }
  hold_stop();
  note(was_stopped);
  has_asked_ = true;
  return answer_;
}

}  // namespace depthgrid::monitor
