#include "views/view_twin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

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
  RobotView robot;

  [[nodiscard]] int width_px() const { return camera.intrinsics.width_px; }
  [[nodiscard]] int height_px() const { return camera.intrinsics.height_px; }
  [[nodiscard]] float measured_m(int u, int v) const {
    return measured_depth_m(depth, camera.rule, u, v).value_or(0.0F);
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

  [[nodiscard]] Bounds reduced(int u, int v) const;
  [[nodiscard]] Bounds filtered(int u, int v) const;
  [[nodiscard]] testing::AssertionResult pixel(int u, int v, bool& is_island) const;
  template <class Better>
  [[nodiscard]] testing::AssertionResult level(std::size_t l, const DepthImage& pixels, const float* texels,
                                               const Better& better) const;
};

/// D - m(D), or the robot's exit and the ignored pocket; 0 outside the image.
Bounds Twin::reduced(int u, int v) const {
  if (!camera.intrinsics.contains(u, v) || measured_m(u, v) == 0) {
    return {0, 0};
  }
  const long double depth_m = measured_m(u, v);
  const SensorMargin& m = margins.sensor;
  const long double exact_m =
      std::max(0.0L, depth_m - (m.constant_m + m.linear * depth_m + m.quadratic_per_m * depth_m * depth_m));
  const Bounds plain{std::max(0.0L, exact_m - depth_m * 0x1p-20L - 1e-30L), exact_m};
  const Interval r = robot_at(u, v);
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
  Bounds result = reduced(u, v);
  const int radius_px = margins.sensor.lateral_px;
  for (int dv = -radius_px; dv <= radius_px; ++dv) {
    for (int du = -radius_px; du <= radius_px; ++du) {
      const Bounds other = reduced(u + du, v + dv);
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
            frame.robot};
  const bool units = frame.depth.format == DepthFormat::uint16_units;
  if (twin.depth.stride_bytes == 0) {
    twin.depth.stride_bytes = twin.width_px() * static_cast<std::ptrdiff_t>(units ? 2 : 4);
  }
  if (twin.robot.stride_px == 0) {
    twin.robot.stride_px = twin.width_px();
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
    if (auto result = twin.level(l, image.island_near_m, image.island_near_maxima_m.data(), std::greater<>());
        !result) {
      return result << " (near ends of islands)";
    }
    if (auto result = twin.level(l, image.island_far_m, image.island_far_minima_m.data(), std::less<>()); !result) {
      return result << " (far ends of islands)";
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace depthgrid::views
