// docs/avoidance.md: the loop from image to command, who runs what, and how old an image is when it counts. The times
// are those that docs/experiments.md and docs/control.md measured.
#include <array>
#include <string>

#include "lab/pictures/pictures.hpp"

namespace depthgrid::lab {
namespace {

using report::Align;
using report::Colour;

constexpr Colour kCamerasLane{0.93, 0.95, 0.98};
constexpr Colour kRobotLane{0.93, 0.92, 0.97};
constexpr double kBoxHeight = 62;

void box(Sheet& sheet, const OnSheet& corner, double width, const std::string& what, const std::string& how,
         const Colour& colour) {
  sheet.fill(corner, {width, kBoxHeight}, report::kWhite);
  sheet.outline(corner, {width, kBoxHeight}, colour, 1.6);
  sheet.text(corner + OnSheet(0.5 * width, 18), what, kInk, Align::centre);
  sheet.text(corner + OnSheet(0.5 * width, kBoxHeight - 9), how, kSoftInk, Align::centre, 11.5);
}

/// Above: the two threads and what passes between them.
void draw_threads(Sheet& sheet) {
  constexpr double kFirst = 62;
  constexpr double kSecond = 208;
  constexpr Colour kCamera = report::kSeenAnswer;
  constexpr Colour kRobot = report::kRobot;
  sheet.fill({20, kFirst - 24}, {760, kBoxHeight + 34}, kCamerasLane);
  sheet.fill({20, kSecond - 24}, {760, kBoxHeight + 34}, kRobotLane);
  sheet.text({28, kFirst - 8}, "the cameras' threads, with every image");
  sheet.text({772, kSecond - 8}, "the robot's thread, every 2 ms", kInk, Align::right);

  box(sheet, {30, kFirst}, 150, "depth image\nand its time", "30 Hz, 20 ms late", kCamera);
  box(sheet, {226, kFirst}, 150, "the arm's pixels\ntaken out", "FrameIntake: 0.2 ms", kCamera);
  box(sheet, {422, kFirst}, 150, "margins, prepared\nfor the search", "update(): 0.4 ms", kCamera);
  box(sheet, {618, kFirst}, 152, "newest image\nof each camera", "ViewStore", kCamera);
  box(sheet, {30, kSecond}, 150, "joint state", "RobotPort::read()", kRobot);
  box(sheet, {226, kSecond}, 150, "where the links\nare now", "parts_world()", kRobot);
  box(sheet, {422, kSecond}, 150, "distances, lower\nbounds as of now", "evaluate(): 0.7 ms", kRobot);
  box(sheet, {618, kSecond}, 152, "repulsion, limits,\njoint command", "Controller: 0.003 ms", kRobot);
  for (const double y : {kFirst, kSecond}) {
    for (const double x : {180.0, 376.0, 572.0}) {
      sheet.arrow({x + 3, y + 0.5 * kBoxHeight}, {x + 43, y + 0.5 * kBoxHeight}, kInk);
    }
  }
  constexpr double kBetween = 146;
  const std::array<OnSheet, 3> up{OnSheet(105, kSecond - 2), {105, kBetween}, {300, kBetween}};
  sheet.line(up, kInk, 1.4);
  sheet.arrow({300, kBetween}, {300, kFirst + kBoxHeight + 3}, kInk);
  sheet.text({112, kBetween + 16}, "joint history: where the arm\nwas when the image was taken");
  const std::array<OnSheet, 3> down{OnSheet(694, kFirst + kBoxHeight + 2), {694, kBetween}, {497, kBetween}};
  sheet.line(down, kInk, 1.4);
  sheet.arrow({497, kBetween}, {497, kSecond - 3}, kInk);
  sheet.text({505, kBetween + 16}, "snapshot: nobody waits");
}

/// Below: 80 ms of it, with the oldest that an image gets.
void draw_times(Sheet& sheet) {
  constexpr double kZero = 116;
  constexpr double kPerMs = 8;
  constexpr double kImages = 334;
  constexpr double kPeriods = 384;
  constexpr double kAge = 424;
  const auto x = [](double time_ms) { return kZero + kPerMs * time_ms; };
  sheet.text({20, kImages + 5}, "images");
  sheet.text({20, kPeriods - 2}, "distances");
  for (const double exposed_ms : {0.0, 33.3, 66.7}) {
    sheet.disc({x(exposed_ms), kImages}, 4, report::kSeenAnswer);
    if (exposed_ms < 60) {
      sheet.arrow({x(exposed_ms) + 5, kImages}, {x(exposed_ms + 20), kImages}, report::kSeenAnswer);
      sheet.fill({x(exposed_ms + 20), kImages - 7}, {2 * kPerMs, 14}, report::kSeenAnswer);
    }
  }
  sheet.text({x(0), kImages - 11}, "exposed");
  sheet.text({x(20), kImages - 11}, "here, then prepared");
  for (int ms = 0; ms <= 80; ms += 2) {
    sheet.line({x(ms), kPeriods}, {x(ms), kPeriods + (ms % 10 == 0 ? 8 : 4)}, kSoftInk, 0.8);
  }
  for (const int ms : {0, 20, 40, 60, 80}) {
    sheet.text({x(ms), kPeriods + 20}, std::to_string(ms), kSoftInk, Align::centre, 11.5);
  }
  for (int ms = 3; ms <= 80; ms += 10) {
    sheet.fill({x(ms), kPeriods - 14}, {0.7 * kPerMs, 14}, report::kRobot);
  }
  sheet.line({x(0), kPeriods}, {x(80), kPeriods}, kSoftInk, 0.8);
  sheet.text({x(80) + 10, kPeriods + 20}, "ms", kSoftInk, Align::left, 11.5);
  sheet.line({x(0), kPeriods + 24}, {x(0), kAge + 6}, kSoftInk, 0.8, 2.5);
  sheet.line({x(63), kPeriods + 2}, {x(63), kAge + 6}, kSoftInk, 0.8, 2.5);
  sheet.arrow({x(0), kAge}, {x(63), kAge}, report::kUnseenAnswer, 1.4, true);
  sheet.text({x(0) + 10, kAge + 18},
             "the first image counts for 63 ms: at 1.6 m/s 0.10 m (v_max times age) come off its distances");
}

}  // namespace

Sheet draw_avoidance() {
  Sheet sheet(456);
  sheet.title({20, 25}, "From image to joint command");
  draw_threads(sheet);
  draw_times(sheet);
  return sheet;
}

}  // namespace depthgrid::lab
