#include "depthgrid/app/frame_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "depthgrid/app/number_text.hpp"
#include "depthgrid/report/canvas.hpp"
#include "depthgrid/report/depth_picture.hpp"

namespace depthgrid::app {

namespace {

constexpr int kColumns = 3;
constexpr int kTileWidth_px = 480;
constexpr int kHead_px = 34;
constexpr int kFoot_px = 44;
constexpr int kCaption_px = 22;
constexpr int kGap_px = 8;

using report::CanvasPoint;

/// Red at contact over orange to green at rho.
report::Colour distance_colour(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return {s < 0.5 ? 0.90 : 0.90 - 1.5 * (s - 0.5), s < 0.5 ? 0.10 + 1.2 * s : 0.70, 0.12};
}

/// Where a world point falls in a tile, or nothing when it is behind the camera.
std::optional<CanvasPoint> in_tile(const RigCamera& camera, const Eigen::Vector3d& p_world,
                                   const report::Rectangle& tile) {
  const Eigen::Vector3d p_camera = camera.T_world_camera.inverse() * p_world;
  if (!(p_camera.z() > 0.05)) {
    return std::nullopt;
  }
  const DepthPoint p = project(camera.intrinsics, p_camera);
  return CanvasPoint{tile.x_px + p.x_px * tile.width_px / camera.intrinsics.width_px,
                     tile.y_px + p.y_px * tile.height_px / camera.intrinsics.height_px};
}

void draw_lines(report::Canvas& canvas, const RigCamera& camera, const report::Rectangle& tile,
                std::span<const PictureLine> lines, double rho_m) {
  canvas.clip(tile);
  for (const auto& line : lines) {
    const auto point = in_tile(camera, line.p_world, tile);
    if (!point) {
      continue;
    }
    const bool known = has_distance(line.answer);
    const report::Colour colour =
        known ? distance_colour(line.answer.distance_m / rho_m) : report::Colour{0.5, 0.5, 0.5};
    if (line.answer.nearest_world.allFinite()) {
      if (const auto nearest = in_tile(camera, line.answer.nearest_world, tile)) {
        canvas.line(*point, *nearest, {report::kWhite, 4.0});
        canvas.line(*point, *nearest, {colour, 2.2});
      }
      canvas.disc(*point, 4.5, report::kWhite);
      canvas.disc(*point, 3.5, colour);
    } else {
      canvas.circle(*point, 4.0, {report::kWhite, 3.5});
      canvas.circle(*point, 4.0, {colour, 2.0});
    }
  }
  canvas.unclip();
}

void draw_distance_legend(report::Canvas& canvas, const report::Rectangle& area, double rho_m) {
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    canvas.fill({area.x_px + area.width_px * i / kSteps, area.y_px, area.width_px / kSteps + 0.5, area.height_px},
                distance_colour((i + 0.5) / kSteps));
  }
  canvas.text({area.x_px, area.y_px + area.height_px + 13}, "distance 0", 12);
  canvas.text({area.x_px + area.width_px, area.y_px + area.height_px + 13},
              micro_text(rho_m).substr(0, 4) + " m and more", 12, report::kBlack, report::Align::right);
}

}  // namespace

void save_frame_picture(const std::filesystem::path& file, const std::string& title, const Rig& rig,
                        std::span<const Frame> frames, std::span<const PictureLine> lines, double rho_m) {
  std::vector<DepthImage> images;
  report::DepthRange range{1e9, 0};
  double aspect = 0;
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    const auto& camera = rig.cameras[k];
    images.emplace_back(camera.intrinsics.width_px, camera.intrinsics.height_px);
    normalise(frames[k].depth, camera.rule, images.back());
    const auto own = report::depth_range(images.back());
    range = {std::min(range.near_m, own.near_m), std::max(range.far_m, own.far_m)};
    aspect = std::max(aspect, static_cast<double>(camera.intrinsics.height_px) / camera.intrinsics.width_px);
  }
  const int count = static_cast<int>(rig.cameras.size());
  const int columns = std::min(count, kColumns);
  const int rows = (count + kColumns - 1) / kColumns;
  const int tile_height_px = std::clamp(static_cast<int>(std::lround(kTileWidth_px * aspect)), 1, 2 * kTileWidth_px);
  report::Canvas canvas(columns * (kTileWidth_px + kGap_px) + kGap_px,
                        kHead_px + rows * (tile_height_px + kCaption_px) + kFoot_px);
  canvas.text({kGap_px, 23}, title, 16);
  for (int k = 0; k < count; ++k) {
    const auto& camera = rig.cameras[static_cast<std::size_t>(k)];
    const int row = k / kColumns;
    const double scale = std::min(static_cast<double>(kTileWidth_px) / camera.intrinsics.width_px,
                                  static_cast<double>(tile_height_px) / camera.intrinsics.height_px);
    const report::Rectangle tile{static_cast<double>(kGap_px + (k % kColumns) * (kTileWidth_px + kGap_px)),
                                 static_cast<double>(kHead_px + row * (tile_height_px + kCaption_px)),
                                 scale * camera.intrinsics.width_px, scale * camera.intrinsics.height_px};
    report::draw_depth(canvas, tile, images[static_cast<std::size_t>(k)], range);
    draw_lines(canvas, camera, tile, lines, rho_m);
    canvas.text({tile.x_px, tile.y_px + tile.height_px + 15}, camera.id, 13);
  }
  const double foot_px = canvas.height_px() - kFoot_px + 8;
  report::draw_depth_legend(canvas, {static_cast<double>(kGap_px), foot_px, 190, 10}, range);
  draw_distance_legend(canvas, {static_cast<double>(kGap_px + 240), foot_px, 190, 10}, rho_m);
  canvas.save_png(file);
}

}  // namespace depthgrid::app
