// Contacts between robot and person: who ran into whom, and how fast.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace depthgrid::experiments {

/// Who ran into whom, at the moment when the distance to the person became 0. Speeds are along the line between the
/// nearest points one period before.
enum class ContactCause : std::uint8_t {
  robot_stood,             ///< the touched point of the robot came nearer at no more than kStanding_m_s
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

/// Whether the touched point came nearer at more than kStanding_m_s although the person was no faster than v_max.
[[nodiscard]] constexpr bool caused_by_the_robot(ContactCause cause) noexcept {
  return cause == ContactCause::hidden || cause == ContactCause::robot_came;
}

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

}  // namespace depthgrid::experiments
