// docs/control.md: how fast the end effector evades, and what distances leave of a joint's velocities. The curves are
// the library's.
#include <array>
#include <functional>
#include <tuple>
#include <vector>

#include "depthgrid/control/repulsion.hpp"
#include "lab/pictures/pictures.hpp"

namespace depthgrid::lab {
namespace {

using report::Align;
using report::Colour;

constexpr double kTop = 62;
constexpr double kHeight = 250;
constexpr double kFarthest = 0.5;  // metres, the end of both axes

/// Left: the two kinds of control points on an arm.
void draw_arm(Sheet& sheet) {
  const std::array<OnSheet, 4> joints{OnSheet(70, 296), {84, 190}, {150, 128}, {214, 146}};
  sheet.line(joints, report::kRobot, 17);
  for (const OnSheet& joint : {joints[1], joints[2]}) {
    sheet.disc(joint, 4, report::kWhite);
  }
  const OnSheet tip = joints[3];
  const OnSheet near_tip(268, 250);
  sheet.disc(near_tip, 20, report::kPerson);
  const OnSheet d = (near_tip - tip).normalized();
  sheet.line(tip, near_tip - 20 * d, report::kUnseenAnswer, 2);
  sheet.arrow(tip, tip - 62 * d, report::kNothingNear, 2.4);
  sheet.arrow(tip, tip + OnSheet(58, 6), report::kSeenAnswer, 2.4);
  sheet.point(tip, kInk);
  sheet.text(tip - 62 * d + OnSheet(6, 4), "V_rep", report::kNothingNear);
  sheet.text(tip + OnSheet(28, -3), "task", report::kSeenAnswer);
  sheet.text(tip + 42 * d + OnSheet(8, 4), "D, d", report::kUnseenAnswer);

  const OnSheet body = 0.5 * (joints[0] + joints[1]);
  const OnSheet near_body(172, 262);
  sheet.disc(near_body, 13, report::kPerson);
  const OnSheet n = (near_body - body).normalized();
  sheet.line(body, near_body - 13 * n, report::kUnseenAnswer, 2);
  sheet.point(body, kInk);
  sheet.text(body + OnSheet(26, -6), "n", report::kUnseenAnswer);
}

struct Axes {
  OnSheet origin;  ///< where D = 0 and the value is 0
  double width = 0;
  double up = 0;  ///< of the sheet a unit of the value
  [[nodiscard]] OnSheet at(double distance_m, double value) const {
    return origin + OnSheet(width * distance_m / kFarthest, -up * value);
  }
};

void draw_axes(Sheet& sheet, const Axes& axes, double lowest, double highest) {
  sheet.arrow(axes.at(0, 0), axes.at(kFarthest, 0) + OnSheet(8, 0), kInk, 1);
  sheet.arrow(axes.at(0, lowest), axes.at(0, highest) - OnSheet(0, 14), kInk, 1);
  sheet.text(axes.at(kFarthest, 0) + OnSheet(8, 16), "D", kInk, Align::right);
}

std::vector<OnSheet> curve(const Axes& axes, const std::function<double(double)>& value) {
  std::vector<OnSheet> points;
  for (double distance = 0; distance < kFarthest; distance += 0.002) {
    points.push_back(axes.at(distance, value(distance)));
  }
  return points;
}

double f(double distance_m) { return control::risk(distance_m, kDefaultRho, kDefaultAlpha); }

/// Middle: v_max f(D).
void draw_repulsion(Sheet& sheet) {
  const Axes axes{{350, kTop + kHeight - 14}, 168, 190};
  const double half = 0.5 * kDefaultRho;
  sheet.line(axes.at(kDefaultRho, 0), axes.at(kDefaultRho, 1.0), kSoftInk, 0.9, 3);
  sheet.line(axes.at(0, 0.5), axes.at(half, 0.5), kSoftInk, 0.9, 3);
  sheet.line(axes.at(half, 0), axes.at(half, 0.5), kSoftInk, 0.9, 3);
  draw_axes(sheet, axes, 0, 1);
  sheet.line(curve(axes, f), report::kNothingNear, 2.4);
  sheet.text(axes.at(0, 1) + OnSheet(-6, 4), "v_max", kInk, Align::right);
  sheet.text(axes.at(0, 0.5) + OnSheet(-6, 4), "half", kInk, Align::right);
  sheet.text(axes.at(half, 0) + OnSheet(0, 16), "rho/2", kInk, Align::centre);
  sheet.text(axes.at(kDefaultRho, 0) + OnSheet(0, 16), "rho", kInk, Align::centre);
  sheet.text(axes.at(0.13, 0.93), "v_max f(D)", report::kNothingNear);
}

/// Right: the velocities of a joint that brings a point of the body nearer.
void draw_limits(Sheet& sheet) {
  const Axes axes{{606, kTop + 0.5 * kHeight}, 150, 100};
  std::vector<OnSheet> allowed = curve(axes, [](double distance) { return 1 - f(distance); });
  allowed.push_back(axes.at(kFarthest, -1));
  allowed.push_back(axes.at(0, -1));
  std::vector<OnSheet> excluded = curve(axes, [](double distance) { return 1 - f(distance); });
  excluded.push_back(axes.at(kFarthest, 1));
  excluded.push_back(axes.at(0, 1));
  sheet.polygon(allowed, report::kFreeByOther);
  sheet.polygon(excluded, report::kGrayArea);
  sheet.line(curve(axes, [](double distance) { return 1 - f(distance); }), report::kUnseenAnswer, 2.4);
  sheet.line(axes.at(kDefaultRho, -1), axes.at(kDefaultRho, 0.2), kSoftInk, 0.9, 3);
  draw_axes(sheet, axes, -1, 1);
  sheet.text(axes.at(0, 1) + OnSheet(-6, 4), "+V", kInk, Align::right);
  sheet.text(axes.at(0, -1) + OnSheet(-6, 4), "-V", kInk, Align::right);
  sheet.text(axes.at(kDefaultRho, -1) + OnSheet(0, 16), "rho", kInk, Align::centre);
  sheet.text(axes.at(0.014, 0.62), "towards:\ntoo fast");
  sheet.text(axes.at(0.235, 0.4), "V (1 - f(D))", report::kUnseenAnswer);
  sheet.text(axes.at(0.03, -0.5), "away: always\nallowed");
}

}  // namespace

Sheet draw_control() {
  Sheet sheet(342);
  for (const auto& [x, title, what] : {std::tuple{20.0, "Where", "two points, what is near them"},
                                       {310.0, "The end effector evades", "against d, this fast"},
                                       {562.0, "The body's joints slow", "a joint's velocity, by distance"}}) {
    sheet.title({x, 24}, title);
    sheet.text({x, 44}, what, kSoftInk);
  }
  draw_arm(sheet);
  draw_repulsion(sheet);
  draw_limits(sheet);
  return sheet;
}

}  // namespace depthgrid::lab
