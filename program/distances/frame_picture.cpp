#include "program/distances/frame_picture.hpp"

#include <algorithm>
#include <cmath>

#include "report/answers_picture.hpp"
#include "report/canvas.hpp"
#include "report/depth_picture.hpp"

namespace depthgrid::program {

namespace {

constexpr int kColumns = 3;
constexpr int kTileWidth_px = 480;
constexpr int kHead_px = 34;
constexpr int kFoot_px = 44;
constexpr int kCaption_px = 22;
constexpr int kGap_px = 8;
constexpr report::Colour kTaken{0.90, 0.05, 0.05};
constexpr report::Colour kNearer{0.10, 0.70, 0.20};
constexpr report::Colour kFarther{0.10, 0.30, 0.95};

void draw_robot(report::Raster& raster, const std::vector<RobotPixel>& kinds) {
  for (int v = 0; v < raster.height_px; ++v) {
    for (int u = 0; u < raster.width_px; ++u) {
      switch (kinds[static_cast<std::size_t>(v) * static_cast<std::size_t>(raster.width_px) +
                    static_cast<std::size_t>(u)]) {
        case RobotPixel::removed:
        case RobotPixel::in_padding:
          raster.set(u, v, kTaken);
          break;
        case RobotPixel::nearer:
        case RobotPixel::within_margin:
          raster.set(u, v, kNearer);
          break;
        case RobotPixel::farther:
          raster.set(u, v, kFarther);
          break;
        case RobotPixel::none:
        case RobotPixel::no_reading:
          break;
      }
    }
  }
}

/// A line of squares and words, as wide as one camera's picture.
void draw_robot_legend(report::Canvas& canvas, double x_px, double base_px) {
  const auto entry = [&](const report::Colour& colour, const char* text) {
    canvas.fill({x_px, base_px - 9, 10, 10}, colour);
    canvas.text({x_px + 14, base_px}, text, 11);
    x_px += 14 + canvas.text_width_px(text, 11) + 12;
  };
  entry(kTaken, "taken for the robot");
  entry(kNearer, "of its capsules: read nearer");
  entry(kFarther, "read farther");
  entry(report::kNoMeasurement, "no reading");
}

}  // namespace

std::filesystem::path picture_file(const std::string& folder, int frame_number) {
  std::string number = std::to_string(frame_number);
  number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
  return std::filesystem::path(folder) / ("frame_" + number + ".png");
}

void save_frame_picture(const std::filesystem::path& file, const std::string& title, const Rig& rig,
                        std::span<const Frame> frames, std::span<const PictureLine> lines, double rho_m,
                        std::span<const std::vector<RobotPixel>> robot) {
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
  report::Canvas canvas(
      columns * (kTileWidth_px + kGap_px) + kGap_px,
      kHead_px + rows * (tile_height_px + kCaption_px) + kFoot_px + (robot.empty() ? 0 : kCaption_px));
  canvas.text({kGap_px, 23}, title, 16);
  for (int k = 0; k < count; ++k) {
    const auto& camera = rig.cameras[static_cast<std::size_t>(k)];
    const int row = k / kColumns;
    const double scale = std::min(static_cast<double>(kTileWidth_px) / camera.intrinsics.width_px,
                                  static_cast<double>(tile_height_px) / camera.intrinsics.height_px);
    const report::Rectangle tile{static_cast<double>(kGap_px + (k % kColumns) * (kTileWidth_px + kGap_px)),
                                 static_cast<double>(kHead_px + row * (tile_height_px + kCaption_px)),
                                 scale * camera.intrinsics.width_px, scale * camera.intrinsics.height_px};
    report::Raster raster = report::depth_raster(images[static_cast<std::size_t>(k)], range);
    if (!robot.empty()) {
      draw_robot(raster, robot[static_cast<std::size_t>(k)]);
    }
    canvas.raster(tile, raster);
    report::draw_answers(canvas, camera, tile, lines, rho_m);
    canvas.text({tile.x_px, tile.y_px + tile.height_px + 15}, camera.id, 13);
  }
  if (!robot.empty()) {
    draw_robot_legend(canvas, kGap_px, canvas.height_px() - kFoot_px - 6);
  }
  const double foot_px = canvas.height_px() - kFoot_px + 8;
  report::draw_depth_legend(canvas, {static_cast<double>(kGap_px), foot_px, 190, 10}, range);
  report::draw_distance_legend(canvas, {static_cast<double>(kGap_px + 240), foot_px, 190, 10}, rho_m);
  canvas.save_png(file);
}

}  // namespace depthgrid::program
