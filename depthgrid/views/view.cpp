#include "depthgrid/views/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depthgrid/core/rounding.hpp"
#include "depthgrid/core/usable_frame.hpp"
#include "depthgrid/views/image_preparation.hpp"
#include "depthgrid/views/pyramid_rows.hpp"
#include "depthgrid/views/reading.hpp"

namespace depthgrid::views {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

std::size_t pixel_count(const DepthImage& image) noexcept { return image.index(0, image.height_px()); }

float pocket_m(const Policies& policies) noexcept {
  return policies.robot_pockets == Policy::ignored ? rounded_down(policies.ignored_pocket_m) : 0.0F;
}

}  // namespace

std::vector<PyramidLevel> pyramid_levels(int width_px, int height_px, std::size_t& total) {
  std::vector<PyramidLevel> levels;
  total = 0;
  for (int size = 1;; size *= 2) {
    const PyramidLevel level{static_cast<std::uint32_t>(total), (width_px + size - 1) / size,
                             (height_px + size - 1) / size};
    total += static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height);
    levels.push_back(level);
    if (std::max(level.width, level.height) <= kPyramidSpan) {
      return levels;
    }
  }
}

/// What only update() needs.
struct View::Preparation {
  Preparation(const RigCamera& camera_in, const CameraMargins& margins, const Policies& policies)
      : camera(camera_in),
        reading(camera.rule, camera.metres_per_unit, margins.sensor),
        reach_px(margins.sensor.lateral_px),
        pocket(pocket_m(policies)),
        blind_m(rounded_up(camera.rule.near_m)),
        rows(camera.intrinsics.width_px, camera.intrinsics.height_px, reach_px),
        island_columns(static_cast<std::size_t>(camera.intrinsics.height_px)) {}

  RigCamera camera;
  Reading reading;
  int reach_px;
  float pocket;
  float blind_m;
  PreparationRows rows;
  std::vector<PixelRange> island_columns;  ///< where a row of the island images may differ from "none"
  std::vector<PixelRange> island_texels;   ///< the same of all rows of the island pyramids
};

View::View(const RigCamera& camera, const CameraMargins& margins, const Policies& policies)
    : free_m_(camera.intrinsics.width_px, camera.intrinsics.height_px),
      island_near_m_(free_m_),
      island_far_m_(free_m_),
      island_bands_(static_cast<std::size_t>((height_px() + kBandRows - 1) / kBandRows)),
      T_world_camera_(camera.T_world_camera) {
  validate(margins.sensor);
  preparation_ = std::make_unique<Preparation>(camera, margins, policies);
  kept_.resize(pixel_count(free_m_) * sizeof(float));
  std::size_t total = 0;
  levels_ = pyramid_levels(width_px(), height_px(), total);
  preparation_->island_texels.resize(row_count(levels_));
  minima_m_.resize(total);
  std::fill_n(island_near_m_.data(), pixel_count(free_m_), kInf);
  std::fill_n(island_far_m_.data(), pixel_count(free_m_), -kInf);
  island_near_maxima_m_.assign(total, kInf);
  island_far_minima_m_.assign(total, -kInf);
  clear();
}

View::~View() = default;
View::View(View&&) noexcept = default;
View& View::operator=(View&&) noexcept = default;

float View::measured_m(int u, int v) const noexcept {
  if (!present_) {
    return 0.0F;
  }
  const DepthView kept{kept_.data(),
                       kept_format_,
                       width_px(),
                       height_px(),
                       row_bytes(kept_format_, width_px()),
                       preparation_->reading.metres_per_unit};
  return measured_depth_m(kept, preparation_->camera.rule, u, v).value_or(0.0F);
}

const char* View::why_unusable(const Frame& frame) const noexcept {
  return depthgrid::why_unusable(frame, preparation_->camera);
}

void View::clear() noexcept {
  present_ = false;
  has_islands_ = false;
  time_s_ = std::numeric_limits<double>::quiet_NaN();
  std::fill_n(free_m_.data(), pixel_count(free_m_), 0.0F);
  std::fill(minima_m_.begin(), minima_m_.end(), 0.0F);
}

/// Only where the frame before left something.
void View::clear_islands() noexcept {
  for (int v = 0; v < height_px(); ++v) {
    PixelRange& columns = preparation_->island_columns[static_cast<std::size_t>(v)];
    if (!columns.empty()) {
      const std::size_t first = free_m_.index(columns.begin, v);
      std::fill_n(island_near_m_.data() + first, columns.end - columns.begin, kInf);
      std::fill_n(island_far_m_.data() + first, columns.end - columns.begin, -kInf);
      columns = {};
    }
  }
}

/// Bands begin and end at multiples of the longest vector: the columns of a row are only known to the length of this
/// instruction set's.
void View::join_island_bands() noexcept {
  constexpr int kStep = FloatColumns::kStep;
  std::fill(island_bands_.begin(), island_bands_.end(), PixelRange{});
  for (int v = 0; v < height_px(); ++v) {
    const PixelRange& columns = preparation_->island_columns[static_cast<std::size_t>(v)];
    if (!columns.empty()) {
      PixelRange& band = island_bands_[static_cast<std::size_t>(v / kBandRows)];
      band = joined(band, {columns.begin / kStep * kStep, (columns.end + kStep - 1) / kStep * kStep});
    }
  }
}

bool View::update(const Frame& frame, const Pose& T_world_camera) noexcept {
  T_world_camera_ = T_world_camera;  // what the camera covers is known although nothing in it is free
  if (why_unusable(frame) != nullptr) {
    clear();
    return false;
  }
  Preparation& p = *preparation_;
  const Frame read = with_strides(frame);
  const NewImage image{read.depth, read.robot, p.reach_px, p.pocket, p.blind_m};
  if (image.robot.near_m != nullptr) {
    clear_islands();
  }
  const PreparedImage result{kept_.data(),          free_m_.data(),       minima_m_.data(), levels_,
                             island_near_m_.data(), island_far_m_.data(), p.island_columns};
  has_islands_ = !prepare(p.reading, image, p.rows, result).empty();
  if (has_islands_) {
    join_island_bands();
    build_island_pyramids(levels_, island_near_m_.data(), island_far_m_.data(), p.island_columns, p.rows.scratch(),
                          island_near_maxima_m_.data(), island_far_minima_m_.data(), p.island_texels);
  }
  kept_format_ = frame.depth.format;
  time_s_ = frame.time_s;
  present_ = true;
  return true;
}

}  // namespace depthgrid::views
