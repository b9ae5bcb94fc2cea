#include "depthgrid/search/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::search {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();

/// The largest float that does not exceed a value >= 0.
float round_towards_zero(double value) noexcept {
  const float nearest = static_cast<float>(std::min(value, static_cast<double>(kLargest)));
  return static_cast<double>(nearest) > value ? std::nextafter(nearest, 0.0F) : nearest;
}

std::size_t pixel_count(const DepthImage& image) noexcept { return image.index(0, image.height_px()); }

/// All levels. `better(a, b)` is the extremum of two values. Four texels (or pixels) two apart make one texel of the
/// level above; four by four pixels make one of level 0.
template <class Better>
void build_pyramid(const DepthImage& image, const std::vector<PyramidLevel>& levels, float* texels,
                   const Better& better) noexcept {
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const PyramidLevel& level = levels[l];
    const int below_width = l == 0 ? image.width_px() : levels[l - 1].width;
    const int below_height = l == 0 ? image.height_px() : levels[l - 1].height;
    const float* source = l == 0 ? image.data() : texels + levels[l - 1].offset;
    const int scale = l == 0 ? 1 : 2;
    const int last = l == 0 ? 3 : 4;
    for (int j = 0; j < level.height; ++j) {
      for (int i = 0; i < level.width; ++i) {
        float best = source[scale * (j * below_width + i)];
        for (int dj = 0; dj <= last; dj += last - 3 == 0 ? 1 : 4) {
          for (int di = 0; di <= last; di += last - 3 == 0 ? 1 : 4) {
            if (scale * i + di < below_width && scale * j + dj < below_height) {
              best = better(best, source[(scale * j + dj) * below_width + scale * i + di]);
            }
          }
        }
        texels[level.offset + static_cast<std::uint32_t>(j * level.width + i)] = best;
      }
    }
  }
}

/// The robot with its exits moved back by the ignored pocket, written into `intervals` (all near ends, then all far
/// ends). Only where the reading lies before the exit, so that one between the exit and the pocket's end is not taken
/// for the robot.
RobotView with_pockets(const RobotView& robot, const DepthImage& measured, double pocket_m,
                       std::vector<float>& intervals) noexcept {
  float* near_m = intervals.data();
  float* far_m = near_m + pixel_count(measured);
  for (int v = 0; v < measured.height_px(); ++v) {
    for (int u = 0; u < measured.width_px(); ++u) {
      const float exit_m = robot.far_m[v * robot.stride_px + u];
      const bool before_exit = measured.at(u, v) <= exit_m && exit_m <= kLargest;
      near_m[measured.index(u, v)] = robot.near_m[v * robot.stride_px + u];
      far_m[measured.index(u, v)] = before_exit ? round_towards_zero(static_cast<double>(exit_m) + pocket_m) : exit_m;
    }
  }
  return {near_m, far_m, measured.width_px()};
}

float smaller(float a, float b) noexcept { return std::min(a, b); }
float larger(float a, float b) noexcept { return std::max(a, b); }

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

View::View(const RigCamera& camera, const CameraMargins& margins, const Policies& policies)
    : rule_(camera.rule),
      metres_per_unit_(camera.metres_per_unit),
      pocket_m_(policies.robot_pockets == Policy::ignored ? policies.ignored_pocket_m : 0.0),
      measured_m_(camera.intrinsics.width_px, camera.intrinsics.height_px),
      free_(camera.intrinsics.width_px, camera.intrinsics.height_px, margins.sensor),
      free_m_(camera.intrinsics.width_px, camera.intrinsics.height_px),
      island_near_m_(camera.intrinsics.width_px, camera.intrinsics.height_px),
      island_far_m_(camera.intrinsics.width_px, camera.intrinsics.height_px),
      pocket_intervals_m_(pocket_m_ > 0 ? 2 * pixel_count(measured_m_) : 0) {
  std::size_t total = 0;
  levels_ = pyramid_levels(width_px(), height_px(), total);
  for (std::vector<float>* texels : {&minima_m_, &island_near_maxima_m_, &island_far_minima_m_}) {
    texels->assign(total, 0.0F);
  }
  clear();
}

bool View::is_usable(const Frame& frame) const noexcept {
  const DepthView& depth = frame.depth;
  const RobotView& robot = frame.robot;
  const bool units = depth.format == DepthFormat::uint16_units;
  const std::ptrdiff_t row_bytes =
      depth.width_px * static_cast<std::ptrdiff_t>(units ? sizeof(std::uint16_t) : sizeof(float));
  return depth.data != nullptr && depth.width_px == width_px() && depth.height_px == height_px() &&
         (depth.stride_bytes == 0 || std::abs(depth.stride_bytes) >= row_bytes) &&
         (!units || depth.metres_per_unit == metres_per_unit_) &&
         (robot.near_m == nullptr) == (robot.far_m == nullptr) &&
         (robot.near_m == nullptr || robot.stride_px == 0 || std::abs(robot.stride_px) >= depth.width_px);
}

void View::clear() noexcept {
  present_ = false;
  has_islands_ = false;
  time_s_ = std::numeric_limits<double>::quiet_NaN();
  std::fill_n(measured_m_.data(), pixel_count(measured_m_), 0.0F);
  std::fill_n(free_m_.data(), pixel_count(free_m_), 0.0F);
  std::fill(minima_m_.begin(), minima_m_.end(), 0.0F);
}

bool View::update(const Frame& frame, const Pose& T_world_camera) noexcept {
  if (!is_usable(frame)) {
    clear();
    return false;
  }
  present_ = true;
  time_s_ = frame.time_s;
  T_world_camera_ = T_world_camera;
  DepthView depth = frame.depth;
  if (depth.stride_bytes == 0) {
    const bool units = depth.format == DepthFormat::uint16_units;
    depth.stride_bytes = depth.width_px * static_cast<std::ptrdiff_t>(units ? sizeof(std::uint16_t) : sizeof(float));
  }
  RobotView robot = frame.robot;
  if (robot.stride_px == 0) {
    robot.stride_px = depth.width_px;
  }
  normalise(depth, rule_, measured_m_);
  const bool pockets = !pocket_intervals_m_.empty() && robot.near_m != nullptr;
  free_.update(measured_m_, pockets ? with_pockets(robot, measured_m_, pocket_m_, pocket_intervals_m_) : robot);
  std::copy_n(free_.image().data(), pixel_count(free_m_), free_m_.data());
  has_islands_ = false;
  if (robot.near_m != nullptr) {
    join_robot(robot);
  }
  build_pyramid(free_m_, levels_, minima_m_.data(), smaller);
  if (has_islands_) {
    build_pyramid(island_near_m_, levels_, island_near_maxima_m_.data(), larger);
    build_pyramid(island_far_m_, levels_, island_far_minima_m_.data(), smaller);
  }
  return true;
}

void View::join_robot(const RobotView& robot) noexcept {
  for (int v = 0; v < height_px(); ++v) {
    const float* near_m = robot.near_m + v * robot.stride_px;
    const float* far_m = robot.far_m + v * robot.stride_px;
    for (int u = 0; u < width_px(); ++u) {
      float& free_m = free_m_.at(u, v);
      // An interval that is not finite, or whose ends are swapped, holds nothing. NaN fails every comparison.
      const bool robot_here = near_m[u] > 0.0F && near_m[u] <= far_m[u] && far_m[u] <= kLargest;
      const bool island = robot_here && near_m[u] > free_m;
      if (robot_here && !island) {
        free_m = std::max(free_m, far_m[u]);
      }
      island_near_m_.at(u, v) = island ? near_m[u] : kInf;
      island_far_m_.at(u, v) = island ? far_m[u] : -kInf;
      has_islands_ = has_islands_ || island;
    }
  }
}

}  // namespace depthgrid::search
