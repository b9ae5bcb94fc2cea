// docs/search.md: what the margins take off a camera's free space, and which cubes the search opens.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>

#include "lab/pictures/flat_world.hpp"
#include "lab/pictures/pictures.hpp"

namespace depthgrid::lab {
namespace {

using Eigen::Vector2d;
using report::Align;
using report::Colour;

constexpr double kScale = 150;  // of the sheet a metre
constexpr double kTop = 62;
const OnSheet kSize(370, 330);
const OnSheet kLeft(20, kTop);
const OnSheet kRight(410, kTop);

constexpr Colour kLostToNoise{0.90, 0.55, 0.38};
constexpr Colour kLostToPixels{0.97, 0.74, 0.52};
constexpr Colour kLostToPose{0.99, 0.89, 0.68};

/// Left: one camera, and what each margin takes away.
void draw_margins(Sheet& sheet) {
  constexpr double kNoise = 0.08;
  constexpr double kPose = 0.07;
  const std::array<FlatSolid, 2> solids{FlatSolid{{1.12, 1.0}, {1.12, 1.0}, 0.15},
                                        FlatSolid{{2.4, -1.0}, {2.4, 3.5}, 0.12}};
  const FlatCamera camera{{0.14, 1.12}, {1, 0}, 0.42, 30, 0.35, 3};
  const FlatView raw(camera, solids);
  const FlatView less_noise(camera, solids, kNoise);
  const FlatView less_pixels(camera, solids, kNoise, 1);
  sheet.shade(kLeft, kSize, [&](const OnSheet& p) {
    const Vector2d p_world = (p - kLeft) / kScale;
    return distance_m(solids, p_world) <= 0    ? report::kPerson
           : !raw.looks_at(p_world)            ? report::kOutsideView
           : less_pixels.frees(p_world, kPose) ? report::kWhite
           : less_pixels.frees(p_world)        ? kLostToPose
           : less_noise.frees(p_world)         ? kLostToPixels
           : raw.frees(p_world)                ? kLostToNoise
                                               : report::kGrayArea;
  });
  const auto at = [](double x, double y) { return OnSheet(kLeft + kScale * Vector2d(x, y)); };
  sheet.camera(at(0.14, 1.12), camera.axis, camera.half_angle_rad);
  sheet.text(at(0.08, 1.42), "camera");
  sheet.text(at(0.40, 0.66), "near");
  sheet.line(at(0.49, 0.70), at(0.49, 0.98), kInk, 0.9);
  sheet.text(at(1.45, 1.0), "shadow");
}

/// The points at a distance from the solid's surface, all around.
std::vector<Vector2d> around(const FlatSolid& solid, double distance) {
  const Vector2d along = (solid.to - solid.from).normalized();
  const double turn = std::atan2(along.y(), along.x());
  std::vector<Vector2d> points;
  constexpr int kSteps = 60;
  for (int i = 0; i <= 2 * kSteps + 1; ++i) {
    const bool first = i <= kSteps;
    const double angle = turn + std::numbers::pi * ((first ? i : i - 1) / static_cast<double>(kSteps) - 0.5);
    points.emplace_back((first ? solid.to : solid.from) +
                        (solid.radius_m + distance) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  points.push_back(points.front());
  return points;
}

/// A square of the tree.
struct Square {
  Vector2d corner;
  double side_m = 0;
  double distance_m = 0;  ///< from the link's surface
  bool operator<(const Square& other) const { return distance_m > other.distance_m; }
};

double distance_to(const FlatSolid& link, const Vector2d& corner, double side_m) {
  double least = 1e9;
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      least = std::min(least, distance_m(link, corner + side_m / kSteps * Vector2d(i, j)));
    }
  }
  return std::max(0.0, least);
}

/// Whether one of the cameras frees all of the square.
bool known_free(std::span<const FlatView> views, const Square& square) {
  constexpr int kSteps = 12;
  return std::any_of(views.begin(), views.end(), [&](const FlatView& view) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= kSteps; ++j) {
        if (!view.frees(square.corner + square.side_m / kSteps * Vector2d(i, j))) {
          return false;
        }
      }
    }
    return true;
  });
}

/// Right: the squares that are opened, the nearest first, until one of the resolution is in nobody's free space.
void draw_tree(Sheet& sheet) {
  constexpr double kRho = 0.55;
  constexpr double kResolution = 0.031;
  const Vector2d low(0.48, 0.13);
  constexpr double kSide = 1.92;
  const std::array<FlatSolid, 2> solids{FlatSolid{{1.87, 0.74}, {1.93, 0.84}, 0.12},
                                        FlatSolid{{3.4, -1.0}, {3.4, 3.5}, 0.12}};
  const std::array<FlatView, 2> views{
      FlatView{{{0.1, 1.1}, {1, 0}, 0.75, 160, 0.15, 4}, solids, 0.02, 1},
      FlatView{{{1.26, 2.13}, Vector2d(0.1, -1).normalized(), 0.62, 160, 0.12, 4}, solids, 0.02, 1}};
  const FlatSolid link{{1.23, 1.2}, {1.49, 1.06}, 0.07};
  const auto at = [](const Vector2d& p_world) { return OnSheet(kRight + kScale * p_world); };
  sheet.shade(kRight, kSize, [&](const OnSheet& p) {
    const Vector2d p_world = (p - kRight) / kScale;
    const bool inside = ((p_world - low).array() > 0).all() && ((p_world - low).array() < kSide).all();
    const bool free = std::any_of(views.begin(), views.end(), [&](const FlatView& v) { return v.frees(p_world); });
    return !inside                               ? report::kOutsideView
           : distance_m(link, p_world) <= 0      ? report::kRobot
           : distance_m(solids[0], p_world) <= 0 ? report::kPerson
           : free                                ? report::kWhite
                                                 : report::kGrayArea;
  });
  std::priority_queue<Square> open;
  open.push({low, kSide, 0});
  double answer_m = kRho;
  Vector2d nearest = low;
  while (!open.empty() && open.top().distance_m < answer_m) {
    const Square square = open.top();
    open.pop();
    if (known_free(views, square)) {
      sheet.fill(at(square.corner), OnSheet::Constant(kScale * square.side_m), {0.78, 0.92, 0.78, 0.55});
      sheet.outline(at(square.corner), OnSheet::Constant(kScale * square.side_m), report::kNothingNear, 0.7);
    } else if (square.side_m <= kResolution) {
      sheet.fill(at(square.corner), OnSheet::Constant(kScale * square.side_m), report::kUnseenAnswer);
      answer_m = square.distance_m;
      nearest = square.corner + Vector2d::Constant(0.5 * square.side_m);
    } else {
      sheet.outline(at(square.corner), OnSheet::Constant(kScale * square.side_m), report::kNothingNear, 0.7);
      const double half = 0.5 * square.side_m;
      for (const Vector2d& step : {Vector2d(0, 0), Vector2d(half, 0), Vector2d(0, half), Vector2d(half, half)}) {
        const Vector2d corner = square.corner + step;
        open.push({corner, half, distance_to(link, corner, half)});
      }
    }
  }
  sheet.outline(at(low), OnSheet::Constant(kScale * kSide), kInk, 1.3, 5);
  const auto outline = [&](double distance) {
    std::vector<OnSheet> points;
    for (const Vector2d& p : around(link, distance)) {
      points.push_back(at(p));
    }
    return points;
  };
  sheet.line(outline(kRho), kSoftInk, 1, 2.5);
  sheet.line(at(link.to), at(nearest), report::kUnseenAnswer, 2);
  sheet.polygon(outline(0), report::kRobot);
  sheet.text(at(low) + OnSheet(6, 16), "W");
  sheet.text(at({1.19, 0.60}), "rho");
  sheet.text(at({1.14, 1.44}), "link");
  sheet.text(at({1.64, 1.1}), "D", report::kUnseenAnswer);
  sheet.text(at({0.04, 1.36}), "camera 1");
  sheet.text(at({1.42, 2.16}), "camera 2");
  for (const FlatView& view : views) {
    sheet.camera(at(view.camera().place), view.camera().axis, 0.5);
  }
}

}  // namespace

Sheet draw_search() {
  Sheet sheet(452);
  sheet.title({20, 24}, "What one camera frees");
  sheet.text({20, 45}, "up to each pixel's reading, less three margins", kSoftInk);
  sheet.title({410, 24}, "What the search opens");
  sheet.text({410, 45}, "cubes around the link, the nearest first", kSoftInk);
  draw_margins(sheet);
  draw_tree(sheet);
  for (const OnSheet& corner : {kLeft, kRight}) {
    sheet.outline(corner, kSize, kInk, 0.8);
  }
  const double under = kTop + kSize.y();
  using Key = std::pair<std::string, Colour>;
  const std::array<Key, 3> first{Key{"known free", report::kWhite},
                                 {"not known free", report::kGrayArea},
                                 {"not looked at", report::kOutsideView}};
  const std::array<Key, 3> second{
      Key{"m: noise", kLostToNoise}, {"w: pixels beside", kLostToPixels}, {"e: pose, clocks", kLostToPose}};
  const std::array<Key, 2> third{Key{"cube that a camera frees", {0.88, 0.95, 0.88}}, {"not opened", report::kWhite}};
  const std::array<Key, 1> fourth{Key{"nearest cube, of the resolution, that none frees", report::kUnseenAnswer}};
  sheet.key({20, under + 25}, first);
  sheet.key({20, under + 47}, second);
  sheet.key({410, under + 25}, third);
  sheet.key({410, under + 47}, fourth);
  return sheet;
}

}  // namespace depthgrid::lab
