// Watches one run of the loop for contacts with the person and for answers that are too far, with true distances.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>

#include "lab/experiments/loop/avoidance_cell.hpp"
#include "lab/experiments/loop/avoidance_method.hpp"
#include "lab/experiments/loop/run_summary.hpp"

namespace depthgrid::experiments {

/// Where the joints were in the cycle that has just been done, rad.
[[nodiscard]] control::JointVector joints_of_cycle(const avoidance::AvoidanceLoop& loop, double period_s);

/// One thread.
class ContactWatch {
 public:
  /// `parts` are those that the loop asks about. Everything must outlive it.
  ContactWatch(Method method, const robot::RobotModel& model, const avoidance::AvoidanceLoop& loop,
               std::span<const robot::LinkCapsule> parts, const AvoidanceSettings& settings)
      : method_(method), model_(model), loop_(loop), parts_(parts), settings_(settings) {}

  /// Every period, after the loop's cycle, with the true distance of then. Adds to contacts, to the time in contact,
  /// and to the periods in which answers were compared.
  void take(double time_s, const TrueDistance& person, RunSummary& summary);

 private:
  [[nodiscard]] std::optional<double> told_of_link_m(std::size_t link) const;
  [[nodiscard]] double robot_speed_m_s() const;
  void note_speed_in_contact(RunSummary& summary) const;
  [[nodiscard]] double closing_m_s(double distance_m) const;
  [[nodiscard]] Contact contact(double time_s) const;
  [[nodiscard]] ContactCause cause_of(const Contact& contact) const;

  Method method_;
  const robot::RobotModel& model_;
  const avoidance::AvoidanceLoop& loop_;
  std::span<const robot::LinkCapsule> parts_;
  const AvoidanceSettings& settings_;
  bool touching_ = false;
  // When last there was a distance:
  std::optional<TrueDistance> before_;
  std::optional<double> before_told_m_;
  Eigen::Vector3d on_link_before_ = Eigen::Vector3d::Zero();    ///< the nearest point, in its link's frame
  Eigen::Vector3d direction_before_ = Eigen::Vector3d::Zero();  ///< from it to the person, world frame
  double speed_before_m_s_ = 0;
  double closing_before_m_s_ = 0;
  double distance_before_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace depthgrid::experiments
