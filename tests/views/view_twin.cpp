#include "views/view_twin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "depthgrid/core/rounding.hpp"
#include "depthgrid/views/hole_rule.hpp"
#include "depthgrid/views/prepared_image.hpp"

namespace depthgrid::views {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// What a computed depth may be.
struct Bounds {
  long double low_m;
  long double high_m;
};

struct Interval {
  float near_m;
  float far_m;
};

/// What every part of the twin reads.
struct Twin {
  const View& view;
  const PreparedImage& image;
  const RigCamera& camera;
  const CameraMargins& margins;
  double pocket_m;
  DepthView depth;
  DepthView counts_as;  ///< with holes filled, which has its own test
  RobotView robot;

  [[nodiscard]] int width_px() const { return camera.intrinsics.width_px; }
  [[nodiscard]] int height_px() const { return camera.intrinsics.height_px; }
  [[nodiscard]] float measured_m(int u, int v) const {
    return measured_depth_m(depth, camera.rule, u, v).value_or(0.0F);
  }
  [[nodiscard]] float counts_as_m(int u, int v) const {
    return measured_depth_m(counts_as, camera.rule, u, v).value_or(0.0F);
  }
  /// near_m = 0: the robot is not in this pixel.
  [[nodiscard]] Interval robot_at(int u, int v) const {
    if (robot.near_m == nullptr) {
      return {0, 0};
    }
    const Interval read{robot.near_m[v * robot.stride_px + u], robot.far_m[v * robot.stride_px + u]};
    const bool valid = read.near_m > 0 && std::isfinite(read.far_m) && read.near_m <= read.far_m;
    return valid ? read : Interval{0, 0};
  }

  [[nodiscard]] Bounds reduced(int u, int v, bool beside) const;
  [[nodiscard]] Bounds within_margin(int u, int v, const Bounds& plain, bool beside) const;
  [[nodiscard]] Bounds filtered(int u, int v) const;
  [[nodiscard]] testing::AssertionResult pixel(int u, int v, bool& is_island) const;
  [[nodiscard]] Interval second(int u, int v) const;
  [[nodiscard]] bool covers_island(int size, int i, int j) const;
  [[nodiscard]] testing::AssertionResult second_level(std::size_t l) const;
  template <class Better>
  [[nodiscard]] testing::AssertionResult level(std::size_t l, const DepthImage& pixels, const float* texels,
                                               const Better& better) const;
};

/// Where near <= D + m(D) and D - m(D) <= far, the robot's exit; either where rounding decides. `beside`: for the
/// pixel's neighbours, of which it says nothing where D + m(D) <= far, too, and D was measured.
Bounds Twin::within_margin(int u, int v, const Bounds& plain, bool beside) const {
  const Interval r = robot_at(u, v);
  const SensorMargin& m = margins.sensor;
  const long double depth_m = counts_as_m(u, v);
  const long double last_m = depth_m + m.constant_m + m.linear * depth_m + m.quadratic_per_m * depth_m * depth_m;
  if (!(r.near_m > 0 && r.near_m <= last_m && plain.low_m <= r.far_m)) {
    return plain;
  }
  const long double exit_m = static_cast<long double>(r.far_m) + pocket_m;
  const long double exit_low_m = std::max(static_cast<long double>(r.far_m), exit_m * (1.0L - 0x1p-20L));
  const long double rounding_m = depth_m * 0x1p-16L;
  // Where m(D) is more than D, no more than 2 D is looked at.
  const bool surely = r.near_m <= std::min(last_m, 2 * depth_m) - rounding_m && plain.high_m <= r.far_m;
  Bounds result{surely ? exit_low_m : std::min(plain.low_m, exit_low_m), std::max(plain.high_m, exit_m)};
  if (beside && measured_m(u, v) > 0 && plain.high_m > 0 && last_m <= r.far_m) {
    result.high_m = kInf;
    result.low_m = surely && plain.low_m > 0 && last_m + rounding_m <= r.far_m ? kInf : result.low_m;
  }
  return result;
}

/// D - m(D), or the robot's exit and the ignored pocket; 0 outside the image.
Bounds Twin::reduced(int u, int v, bool beside) const {
  if (!camera.intrinsics.contains(u, v) || counts_as_m(u, v) == 0) {
    return {0, 0};
  }
  const long double depth_m = counts_as_m(u, v);
  const SensorMargin& m = margins.sensor;
  const long double exact_m =
      std::max(0.0L, depth_m - (m.constant_m + m.linear * depth_m + m.quadratic_per_m * depth_m * depth_m));
  const Bounds plain{std::max(0.0L, exact_m - depth_m * 0x1p-20L - 1e-30L), exact_m};
  const Interval r = robot_at(u, v);
  if (robot.within_margin) {
    return within_margin(u, v, plain, beside);
  }
  if (!(r.near_m > 0 && r.near_m <= plain.high_m && depth_m <= r.far_m)) {
    return plain;
  }
  const long double exit_m = static_cast<long double>(r.far_m) + pocket_m;
  const long double exit_low_m = std::max(static_cast<long double>(r.far_m), exit_m * (1.0L - 0x1p-20L));
  // So near the robot's front that rounding decides.
  return {r.near_m <= plain.low_m ? exit_low_m : plain.low_m, exit_m};
}

/// g.
Bounds Twin::filtered(int u, int v) const {
  Bounds result = reduced(u, v, false);
  const int radius_px = margins.sensor.lateral_px;
  for (int dv = -radius_px; dv <= radius_px; ++dv) {
    for (int du = -radius_px; du <= radius_px; ++du) {
      const Bounds other = reduced(u + du, v + dv, true);
      result = {std::min(result.low_m, other.low_m), std::min(result.high_m, other.high_m)};
    }
  }
  return result;
}

testing::AssertionResult Twin::pixel(int u, int v, bool& is_island) const {
  const auto wrong = [&](const char* what) {
    return testing::AssertionFailure() << what << " of pixel (" << u << ", " << v << ") is wrong: ";
  };
  if (view.measured_m(u, v) != measured_m(u, v)) {
    return wrong("measured depth") << view.measured_m(u, v) << ", should be " << measured_m(u, v);
  }
  const Interval r = robot_at(u, v);
  const float island_near_m = image.has_islands ? image.island_near_m.at(u, v) : kInf;
  const float island_far_m = image.has_islands ? image.island_far_m.at(u, v) : -kInf;
  is_island = island_near_m <= island_far_m;
  if (is_island ? island_near_m != r.near_m || island_far_m != r.far_m
                : island_near_m != kInf || island_far_m != -kInf) {
    return wrong("island") << '[' << island_near_m << ", " << island_far_m << "], the robot is [" << r.near_m << ", "
                           << r.far_m << ']';
  }
  Bounds free = filtered(u, v);
  if (r.near_m > 0) {
    const bool in_blind_zone = static_cast<double>(r.near_m) < camera.rule.near_m;
    if (is_island ? r.near_m <= free.low_m && !in_blind_zone : r.near_m > free.high_m || in_blind_zone) {
      return wrong(is_island ? "an island that is none: free depth" : "an island is missing: free depth")
             << static_cast<double>(free.low_m) << ", robot from " << r.near_m;
    }
    // In the blind zone the island does not say on which side of free_m the robot begins.
    if (in_blind_zone ? r.near_m <= free.low_m : !is_island) {
      free.low_m = std::max<long double>(free.low_m, r.far_m);
    }
    if (in_blind_zone ? r.near_m <= free.high_m : !is_island) {
      free.high_m = std::max<long double>(free.high_m, r.far_m);
    }
  }
  const float free_m = image.free_m.at(u, v);
  if (!(free_m >= free.low_m && free_m <= free.high_m)) {
    return wrong("free depth") << free_m << ", should be in [" << static_cast<double>(free.low_m) << ", "
                               << static_cast<double>(free.high_m) << ']';
  }
  return testing::AssertionSuccess();
}

template <class Better>
testing::AssertionResult Twin::level(std::size_t l, const DepthImage& pixels, const float* texels,
                                     const Better& better) const {
  const PyramidLevel& level = image.levels[l];
  const int size = 1 << l;
  if (level.width != (width_px() + size - 1) / size || level.height != (height_px() + size - 1) / size) {
    return testing::AssertionFailure() << "level " << l << " is " << level.width << " x " << level.height;
  }
  for (int j = 0; j < level.height; ++j) {
    for (int i = 0; i < level.width; ++i) {
      float expected = pixels.at(i * size, j * size);
      for (int v = j * size; v < std::min((j + 4) * size, height_px()); ++v) {
        for (int u = i * size; u < std::min((i + 4) * size, width_px()); ++u) {
          expected = better(pixels.at(u, v), expected) ? pixels.at(u, v) : expected;
        }
      }
      const float result = texels[level.offset + static_cast<std::uint32_t>(j * level.width + i)];
      if (result != expected) {
        return testing::AssertionFailure()
               << "texel (" << i << ", " << j << ") of level " << l << " is " << result << ", should be " << expected;
      }
    }
  }
  return testing::AssertionSuccess();
}

/// A pixel's second interval: one in which nothing is an obstacle.
Interval Twin::second(int u, int v) const {
  const float free_m = image.free_m.at(u, v);
  const float near_m = image.island_near_m.at(u, v);
  const float far_m = image.island_far_m.at(u, v);
  const float blind_m = rounded_up(camera.rule.near_m);
  if (near_m <= far_m && far_m >= blind_m) {
    return {near_m, std::max(far_m, free_m)};
  }
  return near_m <= far_m && free_m < far_m ? Interval{near_m, far_m} : Interval{std::nextafter(blind_m, kInf), free_m};
}

bool Twin::covers_island(int size, int i, int j) const {
  for (int v = std::max(j * size, 0); v < std::min((j + 4) * size, height_px()); ++v) {
    for (int u = std::max(i * size, 0); u < std::min((i + 4) * size, width_px()); ++u) {
      if (image.island_near_m.at(u, v) <= image.island_far_m.at(u, v)) {
        return true;
      }
    }
  }
  return false;
}

testing::AssertionResult Twin::second_level(std::size_t l) const {
  const PyramidLevel& level = image.levels[l];
  const int size = 1 << l;
  constexpr int kReach = PreparedImage::kSecondReach;
  for (int j = 0; j < level.height; ++j) {
    for (int i = 0; i < level.width; ++i) {
      Interval expected{-kInf, kInf};
      for (int v = j * size; v < std::min((j + 4) * size, height_px()); ++v) {
        for (int u = i * size; u < std::min((i + 4) * size, width_px()); ++u) {
          const Interval pixel = second(u, v);
          expected = {std::max(expected.near_m, pixel.near_m), std::min(expected.far_m, pixel.far_m)};
        }
      }
      const std::size_t at = level.offset + static_cast<std::size_t>(j * level.width + i);
      const Interval found{image.second_near_maxima_m[at], image.second_far_minima_m[at]};
      if (found.near_m == expected.near_m && found.far_m == expected.far_m) {
        continue;
      }
      bool beside_islands = found.near_m != kInf || found.far_m != -kInf;
      for (int dj = -kReach; dj <= kReach && !beside_islands; ++dj) {
        for (int di = -kReach; di <= kReach && !beside_islands; ++di) {
          const bool exists = i + di >= 0 && j + dj >= 0 && i + di < level.width && j + dj < level.height;
          beside_islands = exists && covers_island(size, i + di, j + dj);
        }
      }
      if (beside_islands) {
        return testing::AssertionFailure()
               << "the second interval in texel (" << i << ", " << j << ") of level " << l << " is [" << found.near_m
               << ", " << found.far_m << "), should be [" << expected.near_m << ", " << expected.far_m << ")";
      }
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace

testing::AssertionResult follows_definition(const View& view, const RigCamera& camera, const CameraMargins& margins,
                                            const Policies& policies, const Frame& frame) {
  const PreparedImage& image = prepared(view);
  Twin twin{view,
            image,
            camera,
            margins,
            policies.robot_pockets == Policy::ignored ? policies.ignored_pocket_m : 0.0,
            frame.depth,
            {},
            frame.robot};
  const bool units = frame.depth.format == DepthFormat::uint16_units;
  if (twin.depth.stride_bytes == 0) {
    twin.depth.stride_bytes = twin.width_px() * static_cast<std::ptrdiff_t>(units ? 2 : 4);
  }
  if (twin.robot.stride_px == 0) {
    twin.robot.stride_px = twin.width_px();
  }
  std::unique_ptr<HoleRule> holes;
  twin.counts_as = twin.depth;
  if (margins.smallest_obstacle_m > 0) {
    holes = std::make_unique<HoleRule>(camera.intrinsics, camera.metres_per_unit, camera.rule, margins.sensor,
                                       margins.smallest_obstacle_m);
    twin.counts_as = holes->fill(twin.depth);
  }
  bool some_island = false;
  for (int v = 0; v < twin.height_px(); ++v) {
    for (int u = 0; u < twin.width_px(); ++u) {
      bool is_island = false;
      if (auto result = twin.pixel(u, v, is_island); !result) {
        return result;
      }
      some_island = some_island || is_island;
    }
  }
  if (image.has_islands != some_island) {
    return testing::AssertionFailure() << "has_islands() is " << image.has_islands;
  }
  const int largest_side = std::max(twin.width_px(), twin.height_px());
  const std::size_t count = image.levels.size();
  if ((8 << (count - 1)) < largest_side || (count > 1 && (8 << (count - 2)) >= largest_side)) {
    return testing::AssertionFailure() << count << " levels";
  }
  for (std::size_t l = 0; l < count; ++l) {
    if (auto result = twin.level(l, image.free_m, image.minima_m.data(), std::less<>()); !result) {
      return result << " (free depth)";
    }
    if (!image.has_islands) {
      continue;
    }
    if (auto result = twin.second_level(l); !result) {
      return result;
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace depthgrid::views
