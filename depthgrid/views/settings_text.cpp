#include "depthgrid/core/cpp_text.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::views {
namespace {

std::string text_of(Policy policy) {
  switch (policy) {
    case Policy::undeclared:
      return "depthgrid::views::Policy::undeclared";
    case Policy::obstacle:
      return "depthgrid::views::Policy::obstacle";
    case Policy::ignored:
      return "depthgrid::views::Policy::ignored";
  }
  return "static_cast<depthgrid::views::Policy>(" + std::to_string(static_cast<int>(policy)) + ")";
}

std::string text_of(const BoxSpace& box) {
  const auto& [low_world, high_world] = box;
  return "depthgrid::views::BoxSpace{" + cpp_text(low_world) + ", " + cpp_text(high_world) + "}";
}

std::string text_of(const FrustumSpace& frustum) {
  const auto& [principal, d_min_m, d_max_m] = frustum;
  return "depthgrid::views::FrustumSpace{" + std::to_string(principal) + ", " + cpp_text(d_min_m) + ", " +
         cpp_text(d_max_m) + "}";
}

std::string text_of(std::monostate /*nothing*/) { return "std::monostate{}"; }

}  // namespace

/// The structured bindings do not compile once there is another member.
std::string to_string(const Settings& settings) {
  const auto& [space, policies, margins, rho_m, resolution_m, v_max_m_s, max_frame_age_s, blend, alpha] = settings;
  const auto& [unobserved, outside, robot_pockets, ignored_pocket_m] = policies;
  return "depthgrid::views::Settings{.space = " + std::visit([](const auto& s) { return text_of(s); }, space) +
         ",\n  .policies = {" + text_of(unobserved) + ", " + text_of(outside) + ", " + text_of(robot_pockets) + ", " +
         cpp_text(ignored_pocket_m) + "},\n  .margins = " + cpp_range(margins, ",\n    ") +
         ",\n  .rho_m = " + cpp_text(rho_m) + ",\n  .resolution_m = " + cpp_text(resolution_m) +
         ",\n  .v_max_m_s = " + cpp_text(v_max_m_s) + ",\n  .max_frame_age_s = " + cpp_text(max_frame_age_s) +
         ",\n  .direction_blend = " + cpp_text(blend) + ",\n  .repulsion_alpha = " + cpp_text(alpha) + "}";
}

}  // namespace depthgrid::views
