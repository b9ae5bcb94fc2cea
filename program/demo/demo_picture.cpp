#include "program/demo/demo_picture.hpp"

#include <array>
#include <string>

#include "depthgrid/core/margin.hpp"
#include "report/canvas.hpp"
#include "report/depth_picture.hpp"
#include "report/free_space_slice.hpp"
#include "report/scene_colours.hpp"

namespace depthgrid::program {

namespace {

using report::Align;
using report::Canvas;
using report::CanvasPoint;
using report::Colour;
using report::kFreeByOther;
using report::kGrayArea;
using report::kNothingNear;
using report::kOutsideView;
using report::kPerson;
using report::kRobot;
using report::kSeenAnswer;
using report::kUnseenAnswer;
using report::Rectangle;
using report::Sight;

constexpr double kMargin = 24;
constexpr double kPanelWidth = 660;
constexpr double kDepthHeight = kPanelWidth * 480 / 640;
constexpr double kTextSize = 16;

/// The slice: x to the right, y upwards, at the height of the forearm.
constexpr double kLeftX = -2.55;
constexpr double kRightX = 1.75;
constexpr double kTopY = 1.45;
constexpr double kBottomY = -1.25;
constexpr double kSliceHeight = kPanelWidth * (kTopY - kBottomY) / (kRightX - kLeftX);

CanvasPoint on_slice(const Rectangle& area, const Eigen::Vector3d& p_world) {
  return {area.x_px + (p_world.x() - kLeftX) / (kRightX - kLeftX) * area.width_px,
          area.y_px + (kTopY - p_world.y()) / (kTopY - kBottomY) * area.height_px};
}

CanvasPoint on_image(const Rectangle& area, const RigCamera& camera, const Eigen::Vector3d& p_world) {
  const DepthPoint p = project(camera.intrinsics, camera.T_world_camera.inverse(Eigen::Isometry) * p_world);
  return {area.x_px + p.x_px / camera.intrinsics.width_px * area.width_px,
          area.y_px + p.y_px / camera.intrinsics.height_px * area.height_px};
}

Colour answer_colour(const Proximity& answer) {
  switch (answer.state) {
    case ProximityState::beyond_rho:
      return kNothingNear;
    case ProximityState::measured:
      return kSeenAnswer;
    default:
      return kUnseenAnswer;
  }
}

/// Control points and the lines to their nearest points; `place` maps the world to the canvas.
template <class Place>
void draw_answers(Canvas& canvas, const std::vector<Eigen::Vector3d>& points_world,
                  const std::vector<Proximity>& answers, const Place& place) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    const CanvasPoint from = place(points_world[i]);
    if (answers[i].nearest_world.allFinite()) {
      const CanvasPoint to = place(answers[i].nearest_world);
      canvas.line(from, to, {report::kWhite, 5});
      canvas.line(from, to, {answer_colour(answers[i]), 2.5});
      canvas.disc(to, 3, answer_colour(answers[i]));
    }
    canvas.disc(from, 6, report::kWhite);
    canvas.disc(from, 4.5, answer_colour(answers[i]));
  }
}

/// The slice's cross-section of person and arm, and what the cameras say of the rest.
report::Raster slice_raster(const simulation::DemoScene& demo, const Rig& rig, std::span<const DepthImage> free_m,
                            const grid::DepthGrid& depths, double z_m) {
  const auto width = static_cast<int>(kPanelWidth);
  const auto height = static_cast<int>(kSliceHeight);
  const report::WorldRectangle area{{kLeftX, kTopY, z_m}, {kRightX - kLeftX, 0, 0}, {0, kBottomY - kTopY, 0}};
  const auto sights = report::free_space_slice(rig, free_m, depths.d_min_m(), depths.d_max_m(), area, width, height);
  report::Raster raster(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Eigen::Vector3d p_world =
          area.corner_world + (column + 0.5) / width * area.along_world + (row + 0.5) / height * area.down_world;
      Colour colour = kGrayArea;
      switch (
          sights[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)]) {
        case Sight::outside:
          colour = kOutsideView;
          break;
        case Sight::free_for_principal:
          colour = report::kWhite;
          break;
        case Sight::free_for_other:
          colour = kFreeByOther;
          break;
        case Sight::gray:
          break;
      }
      if (demo.scene.contains(p_world, simulation::Body::obstacle)) {
        colour = kPerson;
      } else if (demo.scene.contains(p_world, simulation::Body::robot)) {
        colour = kRobot;
      }
      raster.set(column, row, colour);
    }
  }
  return raster;
}

/// A camera as a small triangle with its name.
void draw_camera(Canvas& canvas, const Rectangle& area, const RigCamera& camera, bool used) {
  const Eigen::Vector3d position = camera.T_world_camera.translation();
  const Eigen::Vector3d view = camera.T_world_camera.linear().col(2);
  const Eigen::Vector3d side(-view.y(), view.x(), 0);
  const std::array<CanvasPoint, 3> triangle{on_slice(area, position),
                                            on_slice(area, position + 0.13 * view + 0.07 * side),
                                            on_slice(area, position + 0.13 * view - 0.07 * side)};
  canvas.polygon(triangle, used ? report::kBlack : Colour{0.65, 0.67, 0.70});
  const CanvasPoint label = on_slice(area, position + Eigen::Vector3d(0, 0.13, 0));
  canvas.text(label, camera.id, kTextSize - 3, used ? report::kBlack : Colour{0.55, 0.57, 0.60},
              view.x() > 0 ? Align::left : Align::right);
}

void draw_slice(Canvas& canvas, const Rectangle& area, const simulation::DemoScene& demo, std::size_t cameras,
                std::span<const DepthImage> free_m, const std::vector<Proximity>& answers,
                const grid::DepthGrid& depths) {
  Rig rig = demo.rig;
  rig.cameras.resize(cameras);
  canvas.raster(area, slice_raster(demo, rig, free_m, depths, demo.arm.axis_world[2].z() - 0.03));
  canvas.outline(area, {report::kBlack, 1});
  for (std::size_t k = 0; k < demo.rig.cameras.size(); ++k) {
    draw_camera(canvas, area, demo.rig.cameras[k], k < cameras);
  }
  draw_answers(canvas, demo.control_points_world, answers,
               [&area](const Eigen::Vector3d& p_world) { return on_slice(area, p_world); });
  const CanvasPoint begin = on_slice(area, {0.95, kBottomY + 0.14, 0});
  const CanvasPoint end = on_slice(area, {1.45, kBottomY + 0.14, 0});
  canvas.line(begin, end, {report::kBlack, 3});
  canvas.text({0.5 * (begin.x_px + end.x_px), begin.y_px - 7}, "0.5 m", kTextSize - 3, report::kBlack, Align::centre);
}

void draw_key(Canvas& canvas, double y_px) {
  struct Entry {
    const char* text = "";
    Colour colour;
    bool point = false;
  };
  constexpr std::array<Entry, 8> kEntries{{
      {"gray area", kGrayArea, false},
      {"known free to camera 2", kFreeByOther, false},
      {"outside camera 1's view", kOutsideView, false},
      {"person", kPerson, false},
      {"arm", kRobot, false},
      {"nearest: unseen space", kUnseenAnswer, true},
      {"nearest: seen surface", kSeenAnswer, true},
      {"nothing within 0.4 m", kNothingNear, true},
  }};
  double x_px = kMargin;
  for (const Entry& entry : kEntries) {
    if (entry.point) {
      canvas.disc({x_px + 7, y_px - 5}, 5.5, entry.colour);
    } else {
      canvas.fill({x_px, y_px - 12, 14, 14}, entry.colour);
      canvas.outline({x_px, y_px - 12, 14, 14}, {report::kBlack, 0.5});
    }
    canvas.text({x_px + 20, y_px}, entry.text, kTextSize - 2);
    x_px += 20 + canvas.text_width_px(entry.text, kTextSize - 2) + 22;
  }
}

}  // namespace

void write_demo_picture(const std::filesystem::path& file, const simulation::DemoScene& demo,
                        std::span<const Frame> frames, const DemoAnswers& answers,
                        const grid::DepthQuantisation& quantisation) {
  std::vector<DepthImage> depth_m;
  std::vector<DepthImage> free_m;
  for (std::size_t k = 0; k < demo.rig.cameras.size(); ++k) {
    const RigCamera& camera = demo.rig.cameras[k];
    depth_m.emplace_back(camera.intrinsics.width_px, camera.intrinsics.height_px);
    normalise(frames[k].depth, camera.rule, depth_m[k]);
    FreeDepth free(camera.intrinsics.width_px, camera.intrinsics.height_px, {});
    free.update(depth_m[k], frames[k].robot);
    free_m.push_back(free.image());
  }
  const grid::DepthGrid depths(demo.rig.cameras.front().intrinsics, quantisation);
  const report::DepthRange range{0.9, 4.6};

  constexpr double kSecondColumn = kMargin + kPanelWidth + kMargin;
  constexpr double kFirstRow = kMargin + 20;
  constexpr double kSecondRow = kFirstRow + kDepthHeight + 52;
  constexpr double kKeyRow = kSecondRow + kSliceHeight + 34;
  Canvas canvas(static_cast<int>(kSecondColumn + kPanelWidth + kMargin), static_cast<int>(kKeyRow + 18));
  for (std::size_t k = 0; k < demo.rig.cameras.size(); ++k) {
    const Rectangle area{k == 0 ? kMargin : kSecondColumn, kFirstRow, kPanelWidth, kDepthHeight};
    const RigCamera& camera = demo.rig.cameras[k];
    const auto& shown = k == 0 ? answers.one_camera : answers.two_cameras;
    canvas.text({area.x_px, area.y_px - 9},
                camera.id + (k == 0 ? ": depth, and answers with it alone" : ": depth, and answers with both cameras"),
                kTextSize);
    report::draw_depth(canvas, area, depth_m[k], range);
    canvas.clip(area);
    draw_answers(canvas, demo.control_points_world, shown,
                 [&](const Eigen::Vector3d& p_world) { return on_image(area, camera, p_world); });
    canvas.unclip();
  }
  report::draw_depth_legend(canvas, {kSecondColumn + kPanelWidth - 230, kFirstRow - 22, 230, 13}, range);

  const Rectangle left{kMargin, kSecondRow, kPanelWidth, kSliceHeight};
  const Rectangle right{kSecondColumn, kSecondRow, kPanelWidth, kSliceHeight};
  canvas.text({left.x_px, left.y_px - 9}, "slice at the arm's height: what camera 1 alone leaves gray", kTextSize);
  canvas.text({right.x_px, right.y_px - 9}, "the same with both cameras", kTextSize);
  draw_slice(canvas, left, demo, 1, std::span(free_m).first(1), answers.one_camera, depths);
  draw_slice(canvas, right, demo, 2, free_m, answers.two_cameras, depths);
  draw_key(canvas, kKeyRow);
  canvas.save_png(file);
}

}  // namespace depthgrid::program
