#include "report/answers_picture.hpp"

#include <algorithm>
#include <optional>
#include <sstream>

#include "depthgrid/core/camera.hpp"

namespace depthgrid::report {

namespace {

/// Red at contact over orange to green at rho.
Colour distance_colour(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return {s < 0.5 ? 0.90 : 0.90 - 1.5 * (s - 0.5), s < 0.5 ? 0.10 + 1.2 * s : 0.70, 0.12};
}

/// Where a world point falls in a tile, or nothing when it is behind the camera.
std::optional<CanvasPoint> in_tile(const RigCamera& camera, const Eigen::Vector3d& p_world, const Rectangle& tile) {
  const Eigen::Vector3d p_camera = camera.T_world_camera.inverse() * p_world;
  if (!(p_camera.z() > 0.05)) {
    return std::nullopt;
  }
  const DepthPoint p = project(camera.intrinsics, p_camera);
  return CanvasPoint{tile.x_px + p.x_px * tile.width_px / camera.intrinsics.width_px,
                     tile.y_px + p.y_px * tile.height_px / camera.intrinsics.height_px};
}

}  // namespace

void draw_answers(Canvas& canvas, const RigCamera& camera, const Rectangle& tile, std::span<const AnsweredPoint> lines,
                  double rho_m) {
  canvas.clip(tile);
  for (const auto& line : lines) {
    const auto point = in_tile(camera, line.p_world, tile);
    if (!point) {
      continue;
    }
    const bool known = has_distance(line.answer);
    const Colour colour = known ? distance_colour(line.answer.distance_m / rho_m) : Colour{0.5, 0.5, 0.5};
    if (line.answer.nearest_world.allFinite()) {
      if (const auto nearest = in_tile(camera, line.answer.nearest_world, tile)) {
        canvas.line(*point, *nearest, {kWhite, 4.0});
        canvas.line(*point, *nearest, {colour, 2.2});
      }
      canvas.disc(*point, 4.5, kWhite);
      canvas.disc(*point, 3.5, colour);
    } else {
      canvas.circle(*point, 4.0, {kWhite, 3.5});
      canvas.circle(*point, 4.0, {colour, 2.0});
    }
  }
  canvas.unclip();
}

void draw_distance_legend(Canvas& canvas, const Rectangle& area, double rho_m) {
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    canvas.fill({area.x_px + area.width_px * i / kSteps, area.y_px, area.width_px / kSteps + 0.5, area.height_px},
                distance_colour((i + 0.5) / kSteps));
  }
  std::ostringstream rho_text;
  rho_text.precision(2);
  rho_text << rho_m;
  canvas.text({area.x_px, area.y_px + area.height_px + 13}, "distance 0", 12);
  canvas.text({area.x_px + area.width_px, area.y_px + area.height_px + 13}, rho_text.str() + " m and more", 12, kBlack,
              Align::right);
}

}  // namespace depthgrid::report
