#include "depthgrid/experiments/avoidance_run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "depthgrid/avoidance/frame_intake.hpp"
#include "depthgrid/control/simulated_arm.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kApart = 0.02;           // a contact ends when robot and person are this far apart
constexpr double kCoveredByPoint = 0.12;  // a control point stands for a link's surface at most this far away
constexpr double kTolerance = 0.01;       // an over-estimate smaller than this is not counted
constexpr double kSlowShare = 0.1;        // of the task's speed

/// The images of one exposure on their way to the loop.
struct Exposure {
  double time_s = 0;
  std::vector<DepthImage> measured_m;
  std::vector<DepthView> views;
};

/// In simulated time nothing may fail: what follows a failure would be measured as if it were the method's.
void need(bool done, const char* what, double time_s) {
  if (!done) {
    fail("simulated run: ", what, " failed at ", time_s, " s");
  }
}

/// One run while it goes on.
class Run {
 public:
  Run(Method method, const robot::RobotModel& model, const AvoidanceMotion& motion, const RunSettings& settings)
      : model_(model),
        settings_(settings),
        common_(settings.common),
        method_(method),
        rig_(avoidance_rig(std::max(1, cameras_of(method)), common_.width_px, common_.sensor)),
        loop_settings_(loop_settings(method, model, common_, motion.hexagon_radius_m)),
        history_(model.joints().size(), 256, 0.02, 0.0),
        source_(make_source(method, rig_, common_, loop_settings_.parts.size())),
        loop_(model, history_, *source_, loop_settings_),
        arm_(loop_settings_.controller.limits, common_.period_s, start_rad()),
        intake_(rig_, model, history_, exposure_settings(common_)),
        cell_(model, motion),
        sensors_(rig_, {.seed = settings.seed}) {}

  RunResult result() {
    need(loop_.start(arm_), "the loop's start", 0);
    const auto periods = static_cast<std::int64_t>(std::llround(settings_.duration_s / common_.period_s));
    // The first images are there before the arm moves.
    place_at_rest();
    for (std::int64_t k = 0; k < periods; ++k) {
      const double time_s = static_cast<double>(k) * common_.period_s;
      need(loop_.cycle(arm_, time_s), "the loop's cycle", time_s);
      cell_.update(time_s, loop_.T_world_link());
      watch(k, time_s);
      expose(k, time_s);
      deliver(time_s);
      arm_.advance();
    }
    result_.duration_s = settings_.duration_s;
    finish_task();
    return std::move(result_);
  }

 private:
  void place_at_rest() {
    if (cameras_of(method_) == 0) {
      return;
    }
    const control::JointVector q = start_rad();
    const std::span<const double> joints(q.data(), static_cast<std::size_t>(q.size()));
    std::vector<Pose> T_world_link(model_.links().size(), Pose::Identity());
    need(model_.link_poses(joints, Pose::Identity(), T_world_link), "the arm's pose", 0);
    need(history_.add(-common_.period_s, joints), "the first entry of the joint history", 0);
    cell_.update(0, T_world_link);
    shoot(-common_.period_s);
    deliver(std::numeric_limits<double>::infinity());
  }

  void expose(std::int64_t k, double time_s) {
    const auto frame_at = [this](std::int64_t period) {
      return static_cast<std::int64_t>(std::floor(static_cast<double>(period) * common_.period_s * kFrameRate + 1e-9));
    };
    if (cameras_of(method_) > 0 && (k == 0 || frame_at(k) != frame_at(k - 1))) {
      shoot(time_s);
    }
  }

  void shoot(double time_s) {
    cell_.render(rig_, ideal_m_);
    Exposure exposure{time_s, {}, {}};
    if (common_.sensor == "ideal") {
      exposure.measured_m = ideal_m_;
    } else {
      exposure.measured_m.resize(ideal_m_.size());
      sensors_.measure(ideal_m_, frame_number_, exposure.measured_m);
    }
    ++frame_number_;
    if (settings_.on_frame) {
      settings_.on_frame(time_s, exposure.measured_m);
    }
    on_the_way_.push_back(std::move(exposure));
  }

  void deliver(double time_s) {
    while (!on_the_way_.empty() && on_the_way_.front().time_s + common_.frame_latency_s <= time_s + 1e-9) {
      Exposure& exposure = on_the_way_.front();
      for (const DepthImage& image : exposure.measured_m) {
        exposure.views.push_back(depth_view(std::span(image.data(), image.index(0, image.height_px())),
                                            image.width_px(), image.height_px()));
      }
      need(source_->take(intake_.frames(exposure.views, exposure.time_s)), "taking the images", exposure.time_s);
      on_the_way_.pop_front();
    }
  }

  /// What the loop took the distance of a link's nearest part for; nothing when the link is not asked about. Parts that
  /// are points stand for the link's surface, which may be nearer than they by as much as its capsule is wide: only the
  /// search's answers are compared.
  [[nodiscard]] std::optional<double> told_of_link_m(std::size_t link) const {
    std::optional<double> nearest_m;
    for (std::size_t i = 0; i < loop_settings_.parts.size(); ++i) {
      if (loop_settings_.parts[i].link == link) {
        const double told_m = loop_.answers()[i].obstacle.distance_m.value_or(0);
        nearest_m = std::min({common_.rho_m, told_m, nearest_m.value_or(told_m)});
      }
    }
    return nearest_m;
  }

  void watch(std::int64_t k, double time_s) {
    const Eigen::Vector3d tip = loop_.report().end_effector_world;
    const double speed_m_s = k > 0 ? (tip - tip_before_).norm() / common_.period_s : loop_settings_.task.speed_m_s;
    tip_before_ = tip;
    const auto person = cell_.to_person();
    const auto object = cell_.to_objects();
    const double person_m = person ? person->distance_m : std::numeric_limits<double>::infinity();
    const double object_m = object ? object->distance_m : std::numeric_limits<double>::infinity();
    result_.smallest_person_m = std::min(result_.smallest_person_m, person_m);
    result_.object_contacts += object_m <= 0 && object_before_m_ > 0 ? 1 : 0;
    object_before_m_ = object_m;
    if (k > 0 && speed_m_s < kSlowShare * loop_settings_.task.speed_m_s) {
      result_.stopped_s += common_.period_s;
      result_.false_stop_s += std::min(person_m, object_m) > common_.rho_m ? common_.period_s : 0.0;
    }
    if (person) {
      watch_person(time_s, *person);
    }
    if (settings_.sample_every > 0 && k % settings_.sample_every == 0) {
      const Eigen::Vector3d to_nearest = loop_.answers()[0].obstacle.direction_world.value_or(Eigen::Vector3d::Zero());
      RunSample sample{time_s, joints_now(), tip, person_m, loop_.report().output.repulsion_m_s, to_nearest, {}};
      for (const avoidance::PartAnswer& answer : loop_.answers()) {
        sample.told_m.push_back(std::min(common_.rho_m, answer.obstacle.distance_m.value_or(0)));
      }
      result_.samples.push_back(std::move(sample));
    }
  }

  void watch_person(double time_s, const TrueDistance& person) {
    const std::optional<double> told_m = told_of_link_m(person.link);
    if (person.distance_m < common_.rho_m && is_search(method_) && told_m) {
      ++result_.compared;
      const double over_m = *told_m - person.distance_m;
      result_.over_estimates += over_m > kTolerance ? 1 : 0;
      result_.largest_over_estimate_m = std::max(result_.largest_over_estimate_m, over_m);
    }
    if (person.distance_m <= 0) {
      result_.in_contact_s += common_.period_s;
      if (!touching_) {
        result_.contacts.push_back(contact(time_s));
      }
      touching_ = true;
      note_speed_in_contact();
    } else {
      touching_ = touching_ && person.distance_m < kApart;
      before_ = person;
      before_told_m_ = told_m;
      on_link_before_ = loop_.T_world_link()[person.link].inverse(Eigen::Isometry) * person.on_robot_world;
      direction_before_ = (person.on_obstacle_world - person.on_robot_world).normalized();
      speed_before_m_s_ = robot_speed_m_s();
      if (touching_) {
        note_speed_in_contact();
      }
      closing_before_m_s_ = closing_m_s(person.distance_m);
      distance_before_m_ = person.distance_m;
    }
  }

  /// Where the joints were in the cycle that has just been done.
  [[nodiscard]] control::JointVector joints_now() const {
    const control::JointCommand& command = loop_.report().output.command;
    return command.position_rad - common_.period_s * command.velocity_rad_s;
  }

  /// How fast the point of the robot that was nearest when last there was a distance moves along the line of then.
  [[nodiscard]] double robot_speed_m_s() const {
    const control::JointCommand& command = loop_.report().output.command;
    const control::JointVector q = joints_now();
    robot::Jacobian jacobian = robot::Jacobian::Zero(6, q.size());
    const Eigen::Vector3d p_world = loop_.T_world_link()[before_->link] * on_link_before_;
    (void)model_.jacobian({q.data(), static_cast<std::size_t>(q.size())}, loop_.T_world_link(), before_->link, p_world,
                          jacobian);
    const Eigen::Vector3d velocity_m_s = jacobian.topRows<3>() * command.velocity_rad_s;
    return velocity_m_s.dot(direction_before_);
  }

  void note_speed_in_contact() {
    if (before_) {
      std::optional<double>& fastest_m_s = result_.contacts.back().fastest_during_m_s;
      fastest_m_s = std::max(fastest_m_s.value_or(0), robot_speed_m_s());
    }
  }

  [[nodiscard]] double closing_m_s(double distance_m) const {
    return std::isfinite(distance_before_m_) ? (distance_before_m_ - distance_m) / common_.period_s : 0.0;
  }

  [[nodiscard]] Contact contact(double time_s) const {
    Contact contact;
    contact.time_s = time_s;
    if (!before_) {
      contact.cause = ContactCause::touched_from_the_start;
      return contact;
    }
    contact.link = before_->link;
    contact.robot_m_s = speed_before_m_s_;
    contact.person_m_s = closing_before_m_s_ - speed_before_m_s_;
    contact.told_m = before_told_m_;
    contact.really_m = before_->distance_m;
    const double tolerance_m = is_search(method_) ? kTolerance : kCoveredByPoint;
    if (contact.robot_m_s <= kStanding_m_s) {
      contact.cause = ContactCause::robot_stood;
    } else if (contact.person_m_s > common_.v_max_m_s) {
      contact.cause = ContactCause::faster_than_v_max;
    } else if (method_ != Method::none && contact.told_m && *contact.told_m > contact.really_m + tolerance_m) {
      contact.cause = ContactCause::hidden;
    } else {
      contact.cause = ContactCause::robot_came;
    }
    return contact;
  }

  void finish_task() {
    const auto& vertices = loop_settings_.task.vertices_world;
    const auto reached = static_cast<std::size_t>(loop_.task().vertices_reached());
    result_.vertices = loop_.task().vertices_reached();
    const double edge_m = (vertices[1] - vertices[0]).norm();
    const double left_m = (loop_.task().next_vertex_world() - tip_before_).norm();
    result_.task_share = static_cast<double>(reached) + std::clamp(1 - left_m / edge_m, 0.0, 1.0);
  }

  const robot::RobotModel& model_;
  const RunSettings& settings_;
  const AvoidanceSettings& common_;
  Method method_;
  Rig rig_;
  avoidance::LoopSettings loop_settings_;
  robot::JointHistory history_;
  std::unique_ptr<avoidance::DistanceSource> source_;
  avoidance::AvoidanceLoop loop_;
  control::SimulatedArm arm_;
  avoidance::FrameIntake intake_;
  AvoidanceCell cell_;
  simulation::SimulatedSensors sensors_;
  std::vector<DepthImage> ideal_m_;
  std::deque<Exposure> on_the_way_;
  std::uint64_t frame_number_ = 0;
  RunResult result_;
  Eigen::Vector3d tip_before_ = Eigen::Vector3d::Zero();
  double object_before_m_ = std::numeric_limits<double>::infinity();
  bool touching_ = false;
  std::optional<TrueDistance> before_;
  std::optional<double> before_told_m_;
  Eigen::Vector3d on_link_before_ = Eigen::Vector3d::Zero();    // the nearest point, in its link's frame
  Eigen::Vector3d direction_before_ = Eigen::Vector3d::Zero();  // from it to the person, world frame
  double speed_before_m_s_ = 0;
  double closing_before_m_s_ = 0;
  double distance_before_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::string_view to_string(ContactCause cause) noexcept {
  switch (cause) {
    case ContactCause::robot_stood:
      return "robot_stood";
    case ContactCause::faster_than_v_max:
      return "faster_than_v_max";
    case ContactCause::hidden:
      return "hidden";
    case ContactCause::robot_came:
      return "robot_came";
    case ContactCause::touched_from_the_start:
      return "touched_from_the_start";
  }
  return "unknown";
}

RunResult run_avoidance(Method method, const robot::RobotModel& model, const AvoidanceMotion& motion,
                        const RunSettings& settings) {
  return Run(method, model, motion, settings).result();
}

}  // namespace depthgrid::experiments
