#include "lab/experiments/blind_layer/layer_picture.hpp"

#include <array>
#include <cmath>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "report/number_text.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kHalf_m = 0.42;  ///< half a section's side
constexpr double kSide = 430;     ///< of a section in the picture
constexpr double kGap = 14;
constexpr double kTitle = 44;
constexpr report::Colour kFree{1, 1, 1};
constexpr report::Colour kUnknown{0.78, 0.78, 0.80};
constexpr report::Colour kLayer{0.22, 0.45, 0.80};
constexpr report::Colour kLink{0.25, 0.25, 0.28};
constexpr report::Colour kHand{0.80, 0.12, 0.15};

struct Panel {
  double padding_m;
  double gap_m;
};
constexpr std::array<Panel, 4> kPanels{{{0.05, 0.02}, {0.05, 0.20}, {0.158, 0.02}, {0.158, 0.20}}};

/// The plane across the link's axis through its middle: x along the cameras' line of sight, y towards the hand.
struct Section {
  Eigen::Vector3d middle;
  Eigen::Vector3d x;
  Eigen::Vector3d y;
  report::Rectangle area;

  [[nodiscard]] Eigen::Vector3d at(double x_m, double y_m) const { return middle + x_m * x + y_m * y; }
  [[nodiscard]] report::CanvasPoint of(const Eigen::Vector3d& p) const {
    const double scale = area.width_px / (2 * kHalf_m);
    return {area.x_px + (kHalf_m + (p - middle).dot(x)) * scale, area.y_px + (kHalf_m - (p - middle).dot(y)) * scale};
  }
};

void draw_section(report::Canvas& canvas, const Section& section, const HandBeside& scene, const Panel& panel,
                  int side_px) {
  const Rig& rig = scene.rig();
  views::Settings settings = hand_settings(rig);
  search::SearchEvaluator evaluator(rig, settings);
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    robot::RobotRemoval removal(rig.cameras[k].intrinsics, scene.arm().capsules(), {panel.padding_m, true});
    Frame frame{depth_view(scene.depth_m(k)), {}, 0};
    frame.robot = removal.find(scene.arm().T_world_link(), rig.cameras[k].T_world_camera, {}, &frame.depth);
    if (!evaluator.update(k, frame).taken()) {
      fail("a simulated frame was not taken");
    }
  }
  report::Raster raster(side_px, side_px);
  for (int v = 0; v < side_px; ++v) {
    for (int u = 0; u < side_px; ++u) {
      const double step_m = 2 * kHalf_m / side_px;
      const Eigen::Vector3d p = section.at((u + 0.5) * step_m - kHalf_m, kHalf_m - (v + 0.5) * step_m);
      const bool free = evaluator.distance(Capsule::point(p)).nearest.distance_m > 0;
      raster.set(u, v, free ? kFree : kUnknown);
    }
  }
  canvas.clip(section.area);
  canvas.raster(section.area, raster);
  const double scale = section.area.width_px / (2 * kHalf_m);
  const Capsule& link = scene.link_world();
  const Answer answer = evaluator.distance(link);
  const report::CanvasPoint middle = section.of(section.middle);
  report::Colour layer = kLayer;
  layer.alpha = 0.30;
  canvas.disc(middle, (link.radius_m + answer.blind_m) * scale, layer);
  canvas.circle(middle, (link.radius_m + answer.blind_m) * scale, {kLayer, 1.5, 0});
  canvas.disc(middle, link.radius_m * scale, kLink);
  canvas.circle(section.of(scene.hand_world()), kHandRadius_m * scale, {kHand, 2.5, 0});
  if (answer.nearest.nearest_world.allFinite()) {
    canvas.line(section.of(answer.on_axis_world), section.of(answer.nearest.nearest_world), {kHand, 1.5, 4});
    canvas.disc(section.of(answer.nearest.nearest_world), 4, kHand);
  }
  canvas.unclip();
  canvas.outline(section.area, {kLink, 1, 0});
  canvas.text(
      {section.area.x_px, section.area.y_px - 24},
      "padding " + report::fixed(panel.padding_m, 3) + " m, the hand really at " + report::fixed(panel.gap_m, 2) + " m",
      15);
  canvas.text({section.area.x_px, section.area.y_px - 7},
              "answered: D = " + report::fixed(answer.nearest.distance_m, 3) +
                  " m, blind_m = " + report::fixed(answer.blind_m, 3) + " m, clear " +
                  report::fixed(std::max(0.0, answer.nearest.distance_m - answer.blind_m), 3) + " m",
              13);
}

}  // namespace

report::Canvas draw_blind_layer(HandBeside& scene, int side_px) {
  report::Canvas canvas(static_cast<int>(2 * kSide + 3 * kGap), static_cast<int>(2 * (kSide + kTitle) + kGap + 28));
  const Capsule& link = scene.link_world();
  Section section;
  section.middle = 0.5 * (link.a + link.b);
  section.x = -scene.direction_world(HandPlace::before);
  section.y = scene.direction_world(HandPlace::beside);
  for (std::size_t i = 0; i < kPanels.size(); ++i) {
    const std::size_t row = i / 2;
    const std::size_t column = i % 2;
    section.area = {kGap + static_cast<double>(column) * (kSide + kGap),
                    kTitle + static_cast<double>(row) * (kSide + kTitle), kSide, kSide};
    scene.take(HandPlace::beside, kPanels[i].gap_m);
    draw_section(canvas, section, scene, kPanels[i], side_px);
  }
  canvas.text({kGap, 2 * (kSide + kTitle) + 24},
              "white: known free   gray: not known free   blue: the blind layer   red: the hand, and what is answered "
              "for the link",
              13);
  return canvas;
}

}  // namespace depthgrid::experiments
