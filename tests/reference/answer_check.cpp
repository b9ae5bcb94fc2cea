#include "reference/answer_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace depthgrid::reference {
namespace {

using Eigen::Vector3d;

/// Double precision, and the oracle's own steps beside borders.
constexpr double kExactM = 1e-9;
/// What the search subtracts for its rounding, twice: a distance and the nearest point that belongs to it.
constexpr double kRoundingM = 2 * search::kRounding;
/// The search rounds a reading less its margin down, in single precision: by less than this share of the reading. Where
/// that decides whether the reading shows the robot, both are right: the answer may be nearer, never farther.
constexpr double kTieShare = 8 * 0x1p-24;
/// How far outside of a view that is W the nearest point may lie.
constexpr double kBorderM = 1e-3;

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(9);
  (out << ... << parts);
  return out.str();
}

/// A reading that stands in a pixel of the neighbourhood, or the lack of one.
struct Look {
  bool measured = false;    ///< a reading at this depth
  bool occluded = false;    ///< a reading before this depth
  bool unmeasured = false;  ///< no reading, or beside the image's edge
};

/// What a camera measured around the place where a ball projects, with its filter radius.
Look look(const CameraInput& input, const CameraSpace& camera, const Vector3d& p_world, double radius_m) {
  const Vector3d p = camera.to_camera(p_world);
  const PinholeCamera& c = input.camera;
  Look result;
  if (p.z() <= radius_m) {
    return {true, true, true};  // the ball reaches the camera: anything is plausible
  }
  result.unmeasured = p.z() - radius_m <= input.rule.near_m;
  const int w = input.sensor.lateral_px;
  const double near_z = p.z() - radius_m;
  const double spread_u = c.fx_px * (radius_m / near_z) * (1 + std::abs(p.x()) / p.z()) + 1;
  const double spread_v = c.fy_px * (radius_m / near_z) * (1 + std::abs(p.y()) / p.z()) + 1;
  const double x_px = c.cx_px + c.fx_px * p.x() / p.z();
  const double y_px = c.cy_px + c.fy_px * p.y() / p.z();
  if (!(std::abs(x_px) < 1e6 && std::abs(y_px) < 1e6)) {
    return result;
  }
  const int u_first = static_cast<int>(std::floor(x_px - spread_u)) - w;
  const int v_first = static_cast<int>(std::floor(y_px - spread_v)) - w;
  const int u_last = static_cast<int>(std::floor(x_px + spread_u)) + w;
  const int v_last = static_cast<int>(std::floor(y_px + spread_v)) + w;
  for (int v = v_first; v <= v_last; ++v) {
    for (int u = u_first; u <= u_last; ++u) {
      const std::optional<float> depth_m = c.contains(u, v) && input.frame.depth.data != nullptr
                                               ? measured_depth_m(input.frame.depth, input.rule, u, v)
                                               : std::nullopt;
      if (!depth_m) {
        result.unmeasured = true;
        continue;
      }
      const double reading_m = *depth_m;
      const double margin_m = depth_margin_m(input.sensor, reading_m);
      result.measured = result.measured || std::abs(p.z() - reading_m) <= margin_m + radius_m;
      result.occluded = result.occluded || p.z() + radius_m >= reading_m;
    }
  }
  return result;
}

/// Whether the camera's view from near_m on comes this near to the point, plane by plane.
bool view_within(const CameraSpace& camera, double near_m, const Vector3d& p_world, double radius_m) {
  const Vector3d p = camera.to_camera(p_world);
  const auto inside_m = camera.inside_m(p);
  return p.z() + radius_m >= near_m &&
         std::all_of(inside_m.begin(), inside_m.end(), [=](double inside) { return inside >= -radius_m; });
}

}  // namespace

AnswerCheck::Soundness AnswerCheck::soundness(const Capsule& asked, const Answer& answer) const {
  Soundness result;
  const double answer_m = answer.nearest.distance_m;
  if (!(answer_m > 0)) {
    return result;  // none is nearer than nothing; what has no distance is a matter of form
  }
  SearchSettings settings;
  settings.gap_m = kProvenM;
  settings.smallest_box_m = 0.5 * kProvenM;
  settings.enough_m = answer_m;
  settings.box_limit = box_limit_;
  const Interval interval = oracle_->distance(to_reference(asked), settings);
  result.boxes = interval.boxes;
  result.proven_m = interval.lo_m;
  if (interval.hi_m && *interval.hi_m < answer_m - kExactM) {
    result.finding =
        Finding{Fault::over_estimate, text("answer ", answer_m, " m, but (", interval.witness_world->transpose(),
                                           ") is an obstacle at ", *interval.hi_m, " m")};
  } else if (interval.lo_m < answer_m - kProvenM - kExactM) {
    result.finding = Finding{Fault::undecided, text("answer ", answer_m, " m, proven only ", interval.lo_m, " m")};
  }
  return result;
}

std::optional<Finding> AnswerCheck::form(const Capsule& asked, const Answer& answer) const {
  const Primitive primitive = to_reference(asked);
  if (const auto what = implausible(primitive, answer)) {
    return Finding{Fault::implausible, *what};
  }
  const bool has_nearest = answer.nearest.nearest_world.allFinite();
  if (has_nearest && !answer.nearest.budget) {
    if (const auto what = not_tight(primitive, answer)) {
      return Finding{Fault::not_tight, *what};
    }
    if (const auto what = implausible_state(answer.nearest.nearest_world, answer)) {
      return Finding{Fault::implausible, *what};
    }
  }
  return std::nullopt;
}

std::optional<std::string> AnswerCheck::implausible(const Primitive& primitive, const Answer& answer) const {
  const Proximity& nearest = answer.nearest;
  const bool outside_ignored = problem_->problem.outside == Policy::ignored;
  const bool missing = std::any_of(problem_->frames.begin(), problem_->frames.end(),
                                   [](const Frame& frame) { return frame.depth.data == nullptr; });
  if (nearest.stale != missing) {
    return text("stale is ", nearest.stale, ", frames missing: ", missing);
  }
  if (!oracle_->in_space(primitive)) {
    if (nearest.state != ProximityState::outside) {
      return text("the axis leaves W, the state is ", to_string(nearest.state));
    }
    if (outside_ignored ? !std::isnan(nearest.distance_m) : nearest.distance_m != 0) {
      return text("the axis leaves W, the distance is ", nearest.distance_m, " m");
    }
    return std::nullopt;
  }
  const double border_m = oracle_->distance_to_border_m(primitive);
  if (outside_ignored ? !(std::abs(nearest.known_to_m - border_m) < 1e-7) : !std::isnan(nearest.known_to_m)) {
    return text("known_to_m is ", nearest.known_to_m, ", W's border is ", border_m, " m away");
  }
  if (!(nearest.distance_m >= 0 && nearest.distance_m <= problem_->settings.rho_m)) {
    return text("distance is ", nearest.distance_m, " m, rho ", problem_->settings.rho_m, " m");
  }
  const bool nothing = nearest.state == ProximityState::beyond_rho;
  if (nearest.state == ProximityState::not_evaluated || (nearest.state == ProximityState::outside && outside_ignored)) {
    return text("the state is ", to_string(nearest.state));
  }
  if (nearest.budget) {
    return std::nullopt;
  }
  if (nothing != !nearest.nearest_world.allFinite() || nothing != !answer.on_axis_world.allFinite() ||
      nothing != !nearest.direction_world.allFinite()) {
    return text("state ", to_string(nearest.state), " and nearest point ", nearest.nearest_world.transpose());
  }
  if (nothing && nearest.distance_m != problem_->settings.rho_m) {
    return text("nothing within rho, the distance is ", nearest.distance_m, " m");
  }
  if ((nearest.state == ProximityState::measured) != nearest.camera.has_value()) {
    return text("state ", to_string(nearest.state), " and camera named: ", nearest.camera.has_value());
  }
  return std::nullopt;
}

std::optional<std::string> AnswerCheck::not_tight(const Primitive& primitive, const Answer& answer) const {
  const Vector3d& w = answer.nearest.nearest_world;
  const double axis_m = axis_distance_m(primitive, w);
  const double distance_m = std::max(0.0, axis_m - primitive.radius_m);
  if (!(std::abs(distance_m - answer.nearest.distance_m) <= kRoundingM)) {
    return text("answer ", answer.nearest.distance_m, " m, the nearest point is ", distance_m, " m away");
  }
  const Vector3d& on_axis = answer.on_axis_world;
  if (!(axis_distance_m(primitive, on_axis) <= 1e-6 && std::abs((w - on_axis).norm() - axis_m) <= kRoundingM)) {
    return text("(", on_axis.transpose(), ") is not the axis' point nearest to (", w.transpose(), ")");
  }
  const Vector3d& direction = answer.nearest.direction_world;
  const bool touches = answer.nearest.distance_m == 0;
  if (!(touches && direction.isZero(0)) &&
      !((direction * (w - on_axis).norm() - (w - on_axis)).norm() <= 1e-6 && std::abs(direction.norm() - 1) < 1e-6)) {
    return text("direction (", direction.transpose(), ") does not lead to the nearest point");
  }
  if (answer.nearest.state == ProximityState::outside) {
    const double border_m = oracle_->outside_by_m(w);
    const bool starts_outside = !oracle_->in_space(primitive) && border_m >= -kExactM;
    return starts_outside || std::abs(border_m) <= 1e-6
               ? std::nullopt
               : std::optional(text("the nearest point is ", border_m, " m outside W's border"));
  }
  const double outside_m = oracle_->outside_by_m(w);
  if (outside_m > (std::holds_alternative<WorldBox>(problem_->problem.space) ? kExactM : kBorderM)) {
    return text("the nearest point is ", outside_m, " m outside W");
  }
  const double resolution_m = problem_->settings.resolution_m;
  for (std::size_t k = 0; k < oracle_->camera_count(); ++k) {
    const CameraSpace& camera = oracle_->camera(k);
    const double radius_m = camera.pose_error_m(w) + resolution_m + search::kRounding;
    if (!camera.ball_meets_not_free(w, radius_m) && !frees_by_a_tie(k, w, radius_m)) {
      return text("camera ", k, " frees ", radius_m, " m around the nearest point");
    }
  }
  bool counts = problem_->problem.uncovered == Policy::obstacle;
  for (std::size_t k = 0; k < oracle_->camera_count() && !counts; ++k) {
    counts =
        view_within(oracle_->camera(k), problem_->problem.cameras[k].rule.near_m, w, resolution_m + search::kRounding);
  }
  return counts ? std::nullopt : std::optional<std::string>("no camera covers the nearest point");
}

bool AnswerCheck::frees_by_a_tie(std::size_t k, const Vector3d& w, double radius_m) const {
  CameraInput input = problem_->problem.cameras[k];
  input.tie_share = kTieShare;
  return CameraSpace(input).ball_meets_not_free(w, radius_m);
}

std::optional<std::string> AnswerCheck::implausible_state(const Vector3d& w, const Answer& answer) const {
  bool measured = false;
  bool occluded = false;
  bool unmeasured = false;
  bool named_measured = false;
  bool covered = false;
  for (std::size_t k = 0; k < oracle_->camera_count(); ++k) {
    const CameraSpace& camera = oracle_->camera(k);
    const CameraInput& input = problem_->problem.cameras[k];
    const double radius_m = camera.pose_error_m(w) + problem_->settings.resolution_m + search::kRounding;
    covered = covered || (camera.covers(w) && problem_->present(k));
    if (!view_within(camera, 0.0, w, radius_m)) {
      continue;
    }
    const Look seen = look(input, camera, w, radius_m);
    measured = measured || seen.measured;
    occluded = occluded || seen.occluded;
    unmeasured = unmeasured || seen.unmeasured;
    named_measured = named_measured || (seen.measured && answer.nearest.camera == k);
  }
  const ProximityState state = answer.nearest.state;
  const bool plausible = (state == ProximityState::measured && named_measured) ||
                         (state == ProximityState::occluded && occluded) ||
                         (state == ProximityState::unmeasured && unmeasured) ||
                         (state == ProximityState::unobserved && !covered) || state == ProximityState::outside;
  if (plausible) {
    return std::nullopt;
  }
  return text("state ", to_string(state), " at (", w.transpose(), "): measured ", measured, ", by the named camera ",
              named_measured, ", occluded ", occluded, ", unmeasured ", unmeasured, ", covered ", covered);
}

}  // namespace depthgrid::reference
