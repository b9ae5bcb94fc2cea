#include "program/info/hole_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "program/info/hole_survey.hpp"
#include "report/canvas.hpp"
#include "report/depth_picture.hpp"

namespace depthgrid::program {

namespace {

constexpr std::array<double, 3> kPicturedSizes_m{0.0, 0.02, 0.05};
constexpr std::array<const char*, 3> kPicturedNames{"frees, s = 0", "frees, s = 2 cm", "frees, s = 5 cm"};
constexpr std::size_t kMostRows = 4;
constexpr int kHoleTile_px = 320;
constexpr int kHoleGap_px = 8;
constexpr int kHoleCaption_px = 22;
constexpr int kHoleFoot_px = 40;

}  // namespace

void save_hole_picture(const std::filesystem::path& file, const Rig& rig, std::span<const Frame> frames) {
  const std::size_t rows = std::min(rig.cameras.size(), kMostRows);
  std::vector<std::array<DepthImage, 1 + kPicturedSizes_m.size()>> images(rows);
  report::DepthRange range{1e9, 0};
  double aspect = 0;
  for (std::size_t k = 0; k < rows; ++k) {
    const RigCamera& camera = rig.cameras[k];
    DepthImage measured(camera.intrinsics.width_px, camera.intrinsics.height_px);
    if (frames[k].depth.data != nullptr) {
      normalise(frames[k].depth, camera.rule, measured);
    }
    const auto own = report::depth_range(measured);
    range = {std::min(range.near_m, own.near_m), std::max(range.far_m, own.far_m)};
    aspect = std::max(aspect, static_cast<double>(camera.intrinsics.height_px) / camera.intrinsics.width_px);
    images[k][0] = std::move(measured);
    for (std::size_t i = 0; i < kPicturedSizes_m.size(); ++i) {
      images[k][i + 1] = freed_depths(camera, frames[k], kPicturedSizes_m[i]);
    }
  }
  const int height_px = static_cast<int>(std::lround(kHoleTile_px * aspect));
  const int columns = static_cast<int>(images.front().size());
  report::Canvas canvas(columns * (kHoleTile_px + kHoleGap_px) + kHoleGap_px,
                        static_cast<int>(rows) * (height_px + kHoleCaption_px) + kHoleGap_px + kHoleFoot_px);
  for (std::size_t k = 0; k < rows; ++k) {
    for (int i = 0; i < columns; ++i) {
      const DepthImage& image = images[k][static_cast<std::size_t>(i)];
      const report::Rectangle tile{
          static_cast<double>(kHoleGap_px + i * (kHoleTile_px + kHoleGap_px)),
          static_cast<double>(kHoleGap_px + static_cast<int>(k) * (height_px + kHoleCaption_px)), kHoleTile_px,
          kHoleTile_px * static_cast<double>(image.height_px()) / image.width_px()};
      canvas.raster(tile, report::depth_raster(image, range));
      canvas.text({tile.x_px, tile.y_px + height_px + 15},
                  i == 0 ? rig.cameras[k].id + ", measured" : kPicturedNames.at(static_cast<std::size_t>(i - 1)), 13);
    }
  }
  report::draw_depth_legend(canvas, {kHoleGap_px, canvas.height_px() - kHoleFoot_px + 4.0, 190, 10}, range);
  canvas.save_png(file);
}

}  // namespace depthgrid::program
