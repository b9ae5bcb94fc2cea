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
    report::draw_answers(canvas, camera, tile, lines, rho_m);
    canvas.text({tile.x_px, tile.y_px + tile.height_px + 15}, camera.id, 13);
  }
  const double foot_px = canvas.height_px() - kFoot_px + 8;
  report::draw_depth_legend(canvas, {static_cast<double>(kGap_px), foot_px, 190, 10}, range);
  report::draw_distance_legend(canvas, {static_cast<double>(kGap_px + 240), foot_px, 190, 10}, rho_m);
  canvas.save_png(file);
}

}  // namespace depthgrid::program
