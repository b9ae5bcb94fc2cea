// docs/robot.md: what the padded model takes out of an image, what that hides, and the pocket behind the robot.
#include <array>
#include <cmath>

#include "lab/pictures/flat_world.hpp"
#include "lab/pictures/pictures.hpp"

namespace depthgrid::lab {
namespace {

using Eigen::Vector2d;
using report::Align;
using report::Colour;

constexpr double kScale = 470;  // of the sheet a metre
const OnSheet kCorner(20, 40);
const OnSheet kSize(760, 372);
constexpr Colour kPaddingColour{0.80, 0.79, 0.92};
constexpr Colour kTakenForRobot{0.93, 0.72, 0.56};
constexpr Colour kIgnoredPocket{0.80, 0.74, 0.80};
constexpr double kPadding = 0.08;
constexpr double kIgnored = 0.10;
constexpr int kRay = 118;  // the pixel whose ray is drawn

struct Scene {
  std::array<FlatSolid, 1> link{FlatSolid{{0.72, 0.37}, {0.73, 0.45}, 0.06}};
  std::array<FlatSolid, 1> padded{FlatSolid{link[0].from, link[0].to, link[0].radius_m + kPadding}};
  std::array<FlatSolid, 2> hands{FlatSolid{{0.40, 0.505}, {0.37, 0.85}, 0.03},      // before the layer
                                 FlatSolid{{0.637, 0.325}, {0.55, -0.05}, 0.022}};  // its tip in the layer
  std::array<FlatSolid, 3> all{link[0], hands[0], hands[1]};
  FlatView view{{{0.04, 0.40}, {1, 0}, 0.42, 240, 0.08, 1.9}, all, 0, 0, padded};
};

OnSheet place(const Vector2d& p_world) { return kCorner + kScale * p_world; }

/// In the shadow of the robot, by no more than the policy may leave out.
bool in_ignored_pocket(const FlatView& view, const Vector2d& p) {
  const Vector2d seen = view.project(p);
  const int pixel = static_cast<int>(seen.x());
  const double exit_m = view.free_m(pixel);
  return exit_m > view.reading_m(pixel) && seen.y() >= exit_m && seen.y() < exit_m + kIgnored;
}

Colour colour_of(const Scene& scene, const Vector2d& p) {
  const bool in_layer = distance_m(scene.padded, p) <= 0;
  if (distance_m(scene.link, p) <= 0) {
    return report::kRobot;
  }
  if (distance_m(scene.hands, p) <= 0) {
    return in_layer ? kTakenForRobot : report::kPerson;
  }
  if (in_layer) {
    return kPaddingColour;
  }
  if (!scene.view.looks_at(p)) {
    return report::kOutsideView;
  }
  return scene.view.frees(p) ? report::kWhite : in_ignored_pocket(scene.view, p) ? kIgnoredPocket : report::kGrayArea;
}

}  // namespace

Sheet draw_robot() {
  Sheet sheet(446);
  const Scene scene;
  const FlatView& view = scene.view;
  sheet.title({20, 25}, "One camera, a link in cross-section, and what its padding hides");
  sheet.shade(kCorner, kSize, [&](const OnSheet& p) { return colour_of(scene, (p - kCorner) / kScale); });
  sheet.outline(kCorner, kSize, kInk, 0.8);
  sheet.camera(place(view.camera().place), view.camera().axis, view.camera().half_angle_rad);
  sheet.text(place(view.camera().place) + OnSheet(-12, 34), "camera");

  // A pixel's ray, what it reads, and its robot interval.
  double enter_m = view.reading_m(kRay);
  while (distance_m(scene.padded, view.deproject(kRay + 0.5, enter_m)) <= 0) {
    enter_m -= 0.001;
  }
  const OnSheet begin = place(view.deproject(kRay + 0.5, enter_m));
  const OnSheet end = place(view.deproject(kRay + 0.5, view.free_m(kRay)));
  sheet.line(place(view.camera().place) + OnSheet(22, 0), end, kInk, 0.9, 3);
  for (const OnSheet& tick : {begin, end}) {
    sheet.line(tick - OnSheet(0, 7), tick + OnSheet(0, 7), kInk, 1.4);
  }
  sheet.point(place(view.deproject(kRay + 0.5, view.reading_m(kRay))), report::kSeenAnswer);
  sheet.text(begin + OnSheet(-6, -9), "near", kInk, Align::right);
  sheet.text(end + OnSheet(7, 5), "far");

  // The padding's thickness, and one more hand.
  const Vector2d low = scene.link[0].to + Vector2d(0, scene.link[0].radius_m);
  sheet.arrow(place(low), place(low + Vector2d(0, kPadding)), kInk, 1.2, true);
  sheet.text(place(low + Vector2d(0.02, 0.6 * kPadding)), "padding");
  const Vector2d hidden(1.06, 0.40);
  sheet.circle(place(hidden), 0.035 * kScale, report::kPerson, 1.6, 4);
  sheet.text(place({1.13, 0.37}),
             "a hand may hide here:\nthis space is an obstacle\nuntil another camera\nlooks into it");

  sheet.text({30, 60},
             "a hand with its tip in the layer:\nthe tip is taken for the robot,\nno distance to it is answered");
  sheet.pointer({252, 80}, place({0.63, 0.31}));
  sheet.text({30, 372}, "a hand before the layer\nhas its own reading:\nit stays an obstacle");
  sheet.text({470, 66}, "A reading between near and far has seen\nthe robot: that pixel is free up to far.");
  using Key = std::pair<std::string, Colour>;
  const std::array<Key, 4> key{Key{"link", report::kRobot},
                               {"padding: blind layer", kPaddingColour},
                               {"unseen: obstacle", report::kGrayArea},
                               {"pocket that the policy may ignore", kIgnoredPocket}};
  sheet.key({20, 433}, key);
  return sheet;
}

}  // namespace depthgrid::lab
