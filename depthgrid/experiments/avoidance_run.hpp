// One run of the avoidance loop in simulated time: deterministic, and watched with true distances every period.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "depthgrid/experiments/avoidance_cell.hpp"
#include "depthgrid/experiments/avoidance_method.hpp"

namespace depthgrid::experiments {

/// Who ran into whom, at the moment when the distance to the person became 0. Speeds are along the line between the
/// nearest points one period before.
enum class ContactCause : std::uint8_t {
  robot_stood,             ///< the touched point of the robot came nearer at no more than kStanding
  faster_than_v_max,       ///< so did not, but the person came at more than v_max
  hidden,                  ///< so did not, and the method held the link for farther away than it was
  robot_came,              ///< none of these: the robot knew, and drove into the person
  touched_from_the_start,  ///< the run began so: nobody ran into anybody, and no speed is known
};
[[nodiscard]] std::string_view to_string(ContactCause cause) noexcept;
inline constexpr std::array kContactCauses{ContactCause::robot_stood, ContactCause::faster_than_v_max,
                                           ContactCause::hidden, ContactCause::robot_came,
                                           ContactCause::touched_from_the_start};
inline constexpr double kStanding_m_s = 0.05;
inline constexpr double kFrameRate = 30;  ///< of every camera, a second

struct Contact {
  double time_s = 0;
  std::size_t link = 0;
  double robot_m_s = 0;            ///< towards the person; negative: evading
  double person_m_s = 0;           ///< towards the robot
  std::optional<double> told_m{};  ///< what the loop took the link's distance for, one period before
  double really_m = 0;             ///< what it was then
  /// The greatest speed towards the person while the contact lasts, of the point that was nearest when last there was a
  /// distance and along the line of then; at least 0. Nothing while there was none.
  std::optional<double> fastest_during_m_s{};
  ContactCause cause = ContactCause::robot_stood;
};

/// One instant of a run.
struct RunSample {
  double time_s = 0;
  control::JointVector q_rad;
  Eigen::Vector3d end_effector_world;
  double true_person_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d repulsion_m_s = Eigen::Vector3d::Zero();  ///< of the end effector, world frame
  /// Unit vector from the end effector's part to the nearest obstacle as evaluated; zero where there is none.
  Eigen::Vector3d to_nearest = Eigen::Vector3d::Zero();
  std::vector<double> told_m;  ///< one a part, the end effector first; rho where nothing is near
};

struct RunResult {
  double duration_s = 0;
  std::int64_t vertices = 0;  ///< reached
  double task_share = 0;      ///< vertices reached, with the way to the next one, as a share of an edge each
  double smallest_person_m = std::numeric_limits<double>::infinity();
  int object_contacts = 0;        ///< with plates, table, workpiece
  std::vector<Contact> contacts;  ///< with the person: each from touching until 2 cm apart again
  double in_contact_s = 0;
  /// The end effector slower than a tenth of the task's speed while nothing (person, table, plate) was really within
  /// rho of the moving links.
  double false_stop_s = 0;
  double stopped_s = 0;  ///< as slow for any reason
  /// Periods in which the search was asked about the link that was nearest to the person, who was within rho; and those
  /// of them in which it held that link for farther away than it was, by more than 1 cm.
  std::int64_t compared = 0;
  std::int64_t over_estimates = 0;
  double largest_over_estimate_m = 0;
  std::vector<RunSample> samples;  ///< every sample_every periods, when asked for
};

struct RunSettings {
  AvoidanceSettings common;
  double duration_s = 8;
  int sample_every = 0;    ///< periods; 0: no samples
  std::uint64_t seed = 1;  ///< of the sensors
  /// Called with the measured images of each frame; may be empty.
  std::function<void(double time_s, std::span<const DepthImage> measured_m)> on_frame{};
};

/// Throws Error as its parts do, and when start, cycle or images are refused.
[[nodiscard]] RunResult run_avoidance(Method method, const robot::RobotModel& model, const AvoidanceMotion& motion,
                                      const RunSettings& settings);

}  // namespace depthgrid::experiments
