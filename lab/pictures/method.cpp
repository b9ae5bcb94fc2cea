// docs/method.md: what one camera leaves gray, what another one makes of it, and what a cell of the grid is.
#include <array>
#include <cmath>

#include "lab/pictures/flat_world.hpp"
#include "lab/pictures/pictures.hpp"

namespace depthgrid::lab {
namespace {

using Eigen::Vector2d;
using report::Align;
using report::Colour;

constexpr double kScale = 172;  // of the sheet a metre
const OnSheet kCorner(20, 40);
const OnSheet kSize(760, 408);
constexpr double kError = 0.06;  // e of the secondary camera
constexpr double kCellDepth = 0.16;

OnSheet place(const Vector2d& p_world) { return kCorner + kScale * p_world; }
Vector2d world(const OnSheet& p) { return (p - kCorner) / kScale; }

struct Scene {
  std::array<FlatSolid, 1> person{FlatSolid{{1.42, 0.92}, {1.46, 1.06}, 0.12}};
  FlatView principal{{{0.16, 1.12}, {1, 0}, 0.29, 22, 0.55, 3.75}, person};
  FlatView secondary{{{2.98, 2.16}, Vector2d(-0.66, -1).normalized(), 0.56, 90, 0.3, 3}, person};
};

bool in_grid(const Scene& scene, const Vector2d& p) {
  return scene.principal.looks_at(p) && scene.principal.project(p).y() < scene.principal.camera().far_m;
}

/// Whether the file's pixel around p lies on a border between two cells.
bool on_cell_border(const FlatView& view, const Vector2d& p) {
  constexpr double kHalfLine = 0.25 / kScale;
  const Vector2d seen = view.project(p);
  const double pixel_m = (view.deproject(1, seen.y()) - view.deproject(0, seen.y())).norm();
  const double step = (seen.y() - view.camera().near_m) / kCellDepth;
  return std::abs(seen.x() - std::round(seen.x())) * pixel_m < kHalfLine ||
         std::abs(step - std::round(step)) * kCellDepth < kHalfLine;
}

Colour colour_of(const Scene& scene, const Vector2d& p) {
  if (!in_grid(scene, p)) {
    return report::kOutsideView;
  }
  Colour colour = scene.principal.frees(p)           ? report::kWhite
                  : scene.secondary.frees(p, kError) ? report::kFreeByOther
                                                     : report::kGrayArea;
  if (on_cell_border(scene.principal, p)) {
    for (double* part : {&colour.red, &colour.green, &colour.blue}) {
      *part -= 0.1;
    }
  }
  return colour;
}

/// The nearest place of the grid that no camera frees.
Vector2d nearest(const Scene& scene, const Vector2d& from) {
  Vector2d best(1e9, 1e9);
  for (double y = 0; y < kSize.y() / kScale; y += 0.002) {
    for (double x = 0; x < kSize.x() / kScale; x += 0.002) {
      const Vector2d p(x, y);
      if ((p - from).norm() < (best - from).norm() && in_grid(scene, p) && !scene.principal.frees(p) &&
          !scene.secondary.frees(p, kError)) {
        best = p;
      }
    }
  }
  return best;
}

std::array<OnSheet, 4> cell(const FlatView& view, int pixel, double depth) {
  return {place(view.deproject(pixel, depth)), place(view.deproject(pixel + 1, depth)),
          place(view.deproject(pixel + 1, depth + kCellDepth)), place(view.deproject(pixel, depth + kCellDepth))};
}

}  // namespace

Sheet draw_method() {
  Sheet sheet(484);
  const Scene scene;
  const FlatView& view = scene.principal;
  const FlatCamera& principal = view.camera();
  const FlatCamera& secondary = scene.secondary.camera();
  sheet.title({20, 25}, "Seen from above: what is known free, what stays gray, and how far away that is");
  sheet.shade(kCorner, kSize, [&](const OnSheet& p) { return colour_of(scene, world(p)); });
  for (const FlatSolid& solid : scene.person) {
    for (double s = 0; s <= 1; s += 0.02) {
      sheet.disc(place(solid.from + s * (solid.to - solid.from)), kScale * solid.radius_m, report::kPerson);
    }
  }
  sheet.clip(kCorner, kSize);
  for (const int border : {0, secondary.pixels}) {
    sheet.line(place(secondary.place), place(scene.secondary.deproject(border, 3)), kSoftInk, 1, 5);
  }
  sheet.unclip();
  sheet.outline(kCorner, kSize, kInk, 0.8);
  sheet.camera(place(principal.place), principal.axis, principal.half_angle_rad);
  sheet.camera(place(secondary.place), secondary.axis, secondary.half_angle_rad);

  // One cell, and the control point with its answer.
  const std::array<OnSheet, 4> corners = cell(view, 12, principal.near_m + 10 * kCellDepth);
  sheet.polygon(corners, report::kNothingNear);
  sheet.pointer({318, 352}, 0.5 * (corners[0] + corners[2]));
  sheet.text({172, 366},
             "a cell of the grid: a pixel of the\nprincipal camera times a step of depth;\n"
             "a secondary camera frees it where\nit sees past all of it");
  const Vector2d control(2.62, 1.62);
  const Vector2d obstacle = nearest(scene, control);
  sheet.line(place(control), place(obstacle), report::kWhite, 4);
  sheet.line(place(control), place(obstacle), report::kUnseenAnswer, 2);
  sheet.point(place(obstacle), report::kUnseenAnswer, 3);
  sheet.point(place(control), report::kUnseenAnswer);
  sheet.text(place(control) + OnSheet(-10, 5), "control point P", kInk, Align::right);
  sheet.text(place(0.5 * (control + obstacle)) + OnSheet(-8, -2), "D", report::kUnseenAnswer, Align::right, kTitleSize);

  sheet.text(place({1.32, 1.3}), "person");

  // near, far, and e at the border of the secondary camera's view.
  for (const auto& [depth, what] : {std::pair{principal.near_m, "near"}, {principal.far_m, "far"}}) {
    const double x = place(view.deproject(0, depth)).x();
    sheet.line({x, kCorner.y()}, {x, kCorner.y() + kSize.y()}, kSoftInk, 1, 2.5);
    sheet.text({x + 5, kCorner.y() + 17}, what);
  }
  sheet.text({28, kCorner.y() + 17}, "blind zone:\nnothing is\nmeasured");
  const Vector2d border = scene.secondary.deproject(secondary.pixels, 1.36);
  const Vector2d inward = (scene.secondary.deproject(0, 1.36) - border).normalized();
  const Vector2d across =
      (inward - inward.dot((border - secondary.place).normalized()) * (border - secondary.place).normalized())
          .normalized();
  const Vector2d freed = border + kError * across;
  sheet.arrow(place(freed + 0.16 * across), place(freed), kInk);
  sheet.arrow(place(border - 0.16 * across), place(border), kInk);
  sheet.text(place(border - 0.2 * across) + OnSheet(0, 5), "e: so much may\ncalibration and\nclocks be off");
  sheet.text(place(principal.place) + OnSheet(-14, 34), "principal\ncamera");
  sheet.text(place(secondary.place) + OnSheet(14, 20), "secondary camera");
  const std::array<std::pair<std::string, Colour>, 4> key{{{"known free to the principal camera", report::kWhite},
                                                           {"to the secondary one", report::kFreeByOther},
                                                           {"gray area: to neither", report::kGrayArea},
                                                           {"outside the grid", report::kOutsideView}}};
  sheet.key({20, 471}, key);
  return sheet;
}

}  // namespace depthgrid::lab
