#include "lab/experiments/loop/contact_watch.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::experiments {

namespace {

constexpr double kApart = 0.02;           // a contact ends when robot and person are this far apart
constexpr double kCoveredByPoint = 0.12;  // a control point stands for a link's surface at most this far away
constexpr double kTolerance = 0.01;       // an over-estimate smaller than this is not counted

}  // namespace

control::JointVector joints_of_cycle(const avoidance::AvoidanceLoop& loop, double period_s) {
  const control::JointCommand& command = loop.report().output.command;
  return command.position_rad - period_s * command.velocity_rad_s;
}

void ContactWatch::take(double time_s, const TrueDistance& person, RunSummary& summary) {
  const std::optional<double> told_m = told_of_link_m(person.link);
  if (person.distance_m < settings_.rho_m && is_search(method_) && told_m) {
    ++summary.compared;
    const double over_m = *told_m - person.distance_m;
    summary.over_estimates += over_m > kTolerance ? 1 : 0;
    summary.largest_over_estimate_m = std::max(summary.largest_over_estimate_m, over_m);
  }
  if (person.distance_m <= 0) {
    summary.in_contact_s += settings_.period_s;
    if (!touching_) {
      summary.contacts.push_back(contact(time_s));
    }
    touching_ = true;
    note_speed_in_contact(summary);
  } else {
    touching_ = touching_ && person.distance_m < kApart;
    before_ = person;
    before_told_m_ = told_m;
    on_link_before_ = loop_.T_world_link()[person.link].inverse(Eigen::Isometry) * person.on_robot_world;
    direction_before_ = (person.on_obstacle_world - person.on_robot_world).normalized();
    speed_before_m_s_ = robot_speed_m_s();
    if (touching_) {
      note_speed_in_contact(summary);
    }
    closing_before_m_s_ = closing_m_s(person.distance_m);
    distance_before_m_ = person.distance_m;
  }
}

/// What the loop took the distance of a link's nearest part for; nothing when the link is not asked about. Parts that
/// are points stand for the link's surface, which may be nearer than they by as much as its capsule is wide: only the
/// search's answers are compared.
std::optional<double> ContactWatch::told_of_link_m(std::size_t link) const {
  std::optional<double> nearest_m;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].link == link) {
      const double told_m =
          control::obstacle_of(loop_.answers()[i], control::BlindLayer::ignored).distance_m.value_or(0);
      nearest_m = std::min({settings_.rho_m, told_m, nearest_m.value_or(told_m)});
    }
  }
  return nearest_m;
}

/// How fast the point of the robot that was nearest when last there was a distance moves along the line of then.
double ContactWatch::robot_speed_m_s() const {
  const control::JointVector q = joints_of_cycle(loop_, settings_.period_s);
  robot::Jacobian jacobian = robot::Jacobian::Zero(6, q.size());
  const Eigen::Vector3d p_world = loop_.T_world_link()[before_->link] * on_link_before_;
  (void)model_.jacobian({q.data(), static_cast<std::size_t>(q.size())}, loop_.T_world_link(), before_->link, p_world,
                        jacobian);
  const Eigen::Vector3d velocity_m_s = jacobian.topRows<3>() * loop_.report().output.command.velocity_rad_s;
  return velocity_m_s.dot(direction_before_);
}

void ContactWatch::note_speed_in_contact(RunSummary& summary) const {
  if (before_) {
    std::optional<double>& fastest_m_s = summary.contacts.back().fastest_during_m_s;
    fastest_m_s = std::max(fastest_m_s.value_or(0), robot_speed_m_s());
  }
}

double ContactWatch::closing_m_s(double distance_m) const {
  return std::isfinite(distance_before_m_) ? (distance_before_m_ - distance_m) / settings_.period_s : 0.0;
}

Contact ContactWatch::contact(double time_s) const {
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
  contact.cause = cause_of(contact);
  return contact;
}

ContactCause ContactWatch::cause_of(const Contact& contact) const {
  const double tolerance_m = is_search(method_) ? kTolerance : kCoveredByPoint;
  if (contact.robot_m_s <= kStanding_m_s) {
    return ContactCause::robot_stood;
  }
  if (contact.person_m_s > settings_.v_max_m_s) {
    return ContactCause::faster_than_v_max;
  }
  if (method_ != Method::none && contact.told_m && *contact.told_m > contact.really_m + tolerance_m) {
    return ContactCause::hidden;
  }
  return ContactCause::robot_came;
}

}  // namespace depthgrid::experiments
