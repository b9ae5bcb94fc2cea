#include "program/robot/robot_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "depthgrid/core/error.hpp"
#include "report/canvas.hpp"
#include "report/number_text.hpp"

namespace depthgrid::program {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using report::CanvasPoint;

constexpr int kPanel_px = 620;
constexpr int kTitle_px = 40;
constexpr int kLegend_px = 46;
constexpr int kBetween_px = 16;
constexpr std::size_t kMaxTriangles = 40'000;  // in a panel; of larger robots every n-th is drawn
/// Less is the rounding of a capsule that just contains its corners.
constexpr double kOutside_m = 1e-6;
constexpr report::Colour kRed{0.85, 0.05, 0.05};

/// A view along one axis of the root's frame: which coordinates go right and up, and how far they are stretched.
struct View {
  std::string title;
  Vector3d right, up;
  Vector2d low;  ///< metres, at the panel's lower left corner
  double px_per_m = 1;
  double x0_px = 0;
  double y0_px = 0;

  [[nodiscard]] Vector2d flat(const Vector3d& p) const { return {p.dot(right), p.dot(up)}; }
  [[nodiscard]] CanvasPoint at(const Vector2d& p) const {
    return {x0_px + (p.x() - low.x()) * px_per_m, y0_px - (p.y() - low.y()) * px_per_m};
  }
  [[nodiscard]] CanvasPoint at(const Vector3d& p) const { return at(flat(p)); }
};

/// Everything in the root's frame.
struct Drawing {
  struct Link {
    std::vector<Vector3d> triangles;
    std::vector<Vector3d> other_triangles;
    std::vector<Capsule> capsules;
  };
  std::vector<Link> links;
  std::size_t triangle_count = 0;
};

std::vector<Vector3d> moved(const std::vector<Vector3d>& points, const Pose& T) {
  std::vector<Vector3d> result(points.size());
  std::transform(points.begin(), points.end(), result.begin(), [&T](const Vector3d& p) { return Vector3d(T * p); });
  return result;
}

Drawing drawing_of(const RobotSurvey& survey, const std::vector<double>& q) {
  std::vector<Pose> T_root_link(survey.model.links().size(), Pose::Identity());
  (void)survey.model.link_poses(q, Pose::Identity(), T_root_link);
  Drawing result;
  for (const LinkSurvey& link : survey.links) {
    const Pose& T = T_root_link[link.link];
    Drawing::Link& drawn = result.links.emplace_back();
    drawn.triangles = moved(link.triangles, T);
    drawn.other_triangles = moved(link.other_triangles, T);
    for (const Capsule& capsule : link.capsules) {
      drawn.capsules.push_back({T * capsule.a, T * capsule.b, capsule.radius_m});
    }
    result.triangle_count += (drawn.triangles.size() + drawn.other_triangles.size()) / 3;
  }
  return result;
}

/// Where the drawing ends, seen so.
Eigen::AlignedBox2d extent(const Drawing& drawing, const View& view) {
  Eigen::AlignedBox2d box;
  for (const Drawing::Link& link : drawing.links) {
    for (const auto* points : {&link.triangles, &link.other_triangles}) {
      for (const Vector3d& p : *points) {
        box.extend(view.flat(p));
      }
    }
    for (const Capsule& capsule : link.capsules) {
      const Vector2d radius = Vector2d::Constant(capsule.radius_m);
      for (const Vector3d& end : {capsule.a, capsule.b}) {
        box.extend(Vector2d(view.flat(end) - radius)).extend(Vector2d(view.flat(end) + radius));
      }
    }
  }
  return box;
}

/// The outline of a capsule seen from far away: two half circles and what joins them.
std::vector<CanvasPoint> outline(const Capsule& capsule, const View& view) {
  constexpr int kSteps = 24;
  const Vector2d a = view.flat(capsule.a);
  const Vector2d b = view.flat(capsule.b);
  const double towards = (b - a).norm() > 1e-9 ? std::atan2(b.y() - a.y(), b.x() - a.x()) : 0.0;
  std::vector<CanvasPoint> result;
  for (int i = 0; i <= 2 * kSteps + 1; ++i) {
    const bool at_b = i <= kSteps;
    const double angle = towards + std::numbers::pi * ((at_b ? i : i - 1) / static_cast<double>(kSteps) - 0.5);
    const Vector2d rim = capsule.radius_m * Vector2d(std::cos(angle), std::sin(angle));
    result.push_back(view.at(Vector2d((at_b ? b : a) + rim)));
  }
  result.push_back(result.front());
  return result;
}

void draw_edges(report::Canvas& canvas, const View& view, std::span<const Vector3d> triangles, std::size_t every,
                const report::Stroke& stroke) {
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3 * every) {
    const std::array<CanvasPoint, 4> edges{view.at(triangles[i]), view.at(triangles[i + 1]), view.at(triangles[i + 2]),
                                           view.at(triangles[i])};
    canvas.polyline(edges, stroke);
  }
}

/// The number of corners outside.
std::size_t draw_corners_outside(report::Canvas& canvas, const View& view, const Drawing::Link& link,
                                 std::span<const Vector3d> points) {
  std::size_t count = 0;
  for (const Vector3d& p : points) {
    const bool inside = std::any_of(link.capsules.begin(), link.capsules.end(), [&p](const Capsule& capsule) {
      return distance_to_axis(capsule, p) <= capsule.radius_m + kOutside_m;
    });
    if (!inside && !link.capsules.empty()) {
      canvas.disc(view.at(p), 1.6, kRed);
      ++count;
    }
  }
  return count;
}

/// A bar of a round length, a tenth to a third of the panel.
void draw_scale(report::Canvas& canvas, const View& view) {
  double length_m = 1e-3;
  for (int step = 0; length_m * view.px_per_m < 0.1 * kPanel_px && step < 24; ++step) {
    length_m *= step % 3 == 1 ? 2.5 : 2;
  }
  const CanvasPoint from{view.x0_px + 10, view.y0_px - 10};
  const CanvasPoint to{from.x_px + length_m * view.px_per_m, from.y_px};
  canvas.line(from, to, {report::kBlack, 3});
  canvas.text({from.x_px, from.y_px - 6}, report::three_digits(length_m) + " m", 13);
}

}  // namespace

void save_robot_picture(const std::filesystem::path& file, const RobotSurvey& survey, const std::vector<double>& q) {
  const Drawing drawing = drawing_of(survey, q);
  if (std::all_of(drawing.links.begin(), drawing.links.end(),
                  [](const auto& link) { return link.capsules.empty() && link.triangles.empty(); })) {
    fail(survey.model.source(), ": no link has a shape, so there is nothing to draw");
  }
  report::Canvas canvas(2 * kPanel_px + 3 * kBetween_px, kTitle_px + kPanel_px + kLegend_px);
  canvas.text({kBetween_px, 26}, survey.model.name() + ": capsules of the links over the edges of their shapes", 17);
  std::array<View, 2> views{View{"x to the right, z up", Vector3d::UnitX(), Vector3d::UnitZ(), {}},
                            View{"y to the right, z up", Vector3d::UnitY(), Vector3d::UnitZ(), {}}};
  double size_m = 0;
  for (const View& view : views) {
    size_m = std::max(size_m, extent(drawing, view).sizes().maxCoeff());
  }
  const std::size_t every = drawing.triangle_count / kMaxTriangles + 1;
  const double ink = drawing.triangle_count > 5000 ? 0.22 : 0.5;  // of one edge; many darken each other
  std::size_t outside = 0;
  for (std::size_t k = 0; k < views.size(); ++k) {
    View& view = views[k];
    const double panel_x_px = kBetween_px + static_cast<double>(k) * (kPanel_px + kBetween_px);
    view.px_per_m = (kPanel_px - 50) / std::max(size_m, 1e-3);
    view.x0_px = panel_x_px;
    view.y0_px = kTitle_px + kPanel_px;
    const Vector2d centre = extent(drawing, view).center();
    view.low = centre - Vector2d::Constant(0.5 * kPanel_px / view.px_per_m);
    canvas.outline({panel_x_px, kTitle_px, kPanel_px, kPanel_px}, {{0.75, 0.75, 0.75}, 1});
    outside = 0;
    for (const Drawing::Link& link : drawing.links) {
      draw_edges(canvas, view, link.other_triangles, every, {{0.62, 0.62, 0.66, ink}, 0.6});
      draw_edges(canvas, view, link.triangles, every, {{0.25, 0.25, 0.28, ink}, 0.6});
    }
    for (std::size_t i = 0; i < drawing.links.size(); ++i) {
      report::Colour colour = report::series_colour(static_cast<unsigned>(i));
      for (const Capsule& capsule : drawing.links[i].capsules) {
        const auto line = outline(capsule, view);
        colour.alpha = 0.13;
        canvas.polygon(line, colour);
        colour.alpha = 1;
        canvas.polyline(line, {colour, 1.6});
      }
      outside += draw_corners_outside(canvas, view, drawing.links[i], drawing.links[i].triangles) +
                 draw_corners_outside(canvas, view, drawing.links[i], drawing.links[i].other_triangles);
    }
    draw_scale(canvas, view);
    canvas.text({panel_x_px + kPanel_px - 8, kTitle_px + 18}, view.title, 13, report::kBlack, report::Align::right);
  }
  const double foot_px = kTitle_px + kPanel_px + 28;
  canvas.disc({kBetween_px + 6, foot_px - 4}, 4, kRed);
  canvas.text({kBetween_px + 16, foot_px},
              outside == 0
                  ? "corners outside of their link's capsules: none"
                  : "corners outside of their link's capsules: " + report::grouped(static_cast<std::int64_t>(outside)) +
                        " (a corner counts once a triangle)",
              14);
  canvas.save_png(file);
}

}  // namespace depthgrid::program
