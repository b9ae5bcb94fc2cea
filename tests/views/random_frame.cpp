#include "views/random_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::views {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class Draw {
 public:
  explicit Draw(std::mt19937_64& random) : random_(random) {}
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool one_in(int n) { return whole(1, n) == 1; }
  /// Zero in a third of the draws.
  double part(double largest) { return one_in(3) ? 0.0 : uniform(0, largest); }
  template <class Choice>
  Choice one_of(std::initializer_list<Choice> choices) {
    return choices.begin()[whole(0, static_cast<int>(choices.size()) - 1)];
  }

 private:
  std::mt19937_64& random_;
};

/// Rectangles of an image in which something is the same.
struct Patch {
  Patch(int width_px, int height_px, Draw& draw)
      : u0(draw.whole(-4, width_px)),
        v0(draw.whole(-4, height_px)),
        u1(u0 + draw.whole(1, width_px + 4)),
        v1(v0 + draw.whole(1, height_px + 4)) {}
  [[nodiscard]] bool holds(int u, int v) const { return u >= u0 && u < u1 && v >= v0 && v < v1; }
  int u0, v0, u1, v1;
};

float broken_metres(Draw& draw) {
  return draw.one_of({kNaN, kInfinite, -kInfinite, -1.0F, -0.0F, 1e-42F, std::numeric_limits<float>::max()});
}

/// A robot's interval in front of, around, across or behind a reading, or none, or nonsense.
std::pair<float, float> interval(float depth_m, Draw& draw) {
  if (draw.one_in(20)) {
    return {draw.one_of({kNaN, -1.0F, kInfinite, 0.5F}), draw.one_of({kNaN, kInfinite, -kInfinite, 0.25F, 3e38F})};
  }
  const auto begin = static_cast<float>(draw.uniform(-0.4, 0.2));
  const float near_m = std::max(depth_m + begin, 0.0F);
  return {near_m, near_m + static_cast<float>(draw.uniform(0.0, 0.6))};
}

}  // namespace

RandomCamera random_camera(int width_px, int height_px, std::mt19937_64& random) {
  Draw draw(random);
  RandomCamera result;
  result.camera.id = "random";
  result.camera.intrinsics = {width_px, height_px, 100.0, 100.0, width_px / 2.0, height_px / 2.0};
  result.camera.metres_per_unit = draw.one_of({0.001, 0.001, 0.0001, 0.00025, 0.0123456789});
  const double full_scale_m = 65535 * result.camera.metres_per_unit;
  MeasurementRule& rule = result.camera.rule;
  rule.near_m = draw.one_in(2) ? 0.0 : draw.uniform(0, 0.1) * full_scale_m;
  rule.far_m = draw.one_in(2) ? std::numeric_limits<double>::infinity() : draw.uniform(0.5, 1.2) * full_scale_m;
  rule.clamp_beyond_far = draw.one_in(3);
  for (int n = draw.one_in(2) ? 0 : draw.whole(1, 9); n > 0; --n) {
    rule.invalid_units.push_back(static_cast<std::uint16_t>(draw.whole(0, draw.one_in(2) ? 100 : 65535)));
  }
  result.margins.sensor = {draw.part(0.05), draw.part(0.05), draw.part(0.02), draw.one_in(20) ? 16 : draw.whole(0, 3)};
  if (draw.one_in(4)) {
    result.margins.sensor = {0, 0, 0, draw.whole(0, 1)};
  }
  result.margins.smallest_obstacle_m = draw.one_in(3) ? draw.uniform(0.005, 0.3) : 0.0;
  result.policies = {Policy::obstacle, Policy::obstacle, Policy::obstacle, 0};
  if (draw.one_in(2)) {
    result.policies.robot_pockets = Policy::ignored;
    result.policies.ignored_pocket_m = draw.one_of({0.0, 1e-9, 0.05, 0.1234567890123});
  }
  return result;
}

RandomFrame::RandomFrame(const RandomCamera& camera, std::mt19937_64& random) {
  Draw draw(random);
  const int width_px = camera.camera.intrinsics.width_px;
  const int height_px = camera.camera.intrinsics.height_px;
  const double unit_m = camera.camera.metres_per_unit;
  const bool units = draw.one_in(2);
  const bool bottom_up = draw.one_in(5);
  const int row_px = width_px + (draw.one_in(2) ? 0 : draw.whole(1, 5));
  const auto size = static_cast<std::size_t>(row_px) * static_cast<std::size_t>(height_px);
  (units ? metres_.resize(0), units_.resize(size) : metres_.resize(size));
  const bool with_robot = draw.one_in(2);
  near_m_.resize(with_robot ? size : 0);
  far_m_.resize(near_m_.size());

  const double base_m = draw.uniform(0.05, 0.9) * 65535 * unit_m;
  const std::vector<Patch> surfaces(static_cast<std::size_t>(draw.whole(0, 3)), Patch(width_px, height_px, draw));
  const Patch hole(width_px, height_px, draw);
  const Patch before_robot(width_px, height_px, draw);
  const Patch robot(width_px, height_px, draw);
  const bool has_hole = draw.one_in(2);
  const int broken_one_in = draw.one_of({3, 50, 100000});
  const double noise = draw.one_of({0.0, 0.001, 0.1});
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      double depth_m = base_m * (1 + noise * draw.uniform(-1, 1));
      for (const Patch& surface : surfaces) {
        depth_m *= surface.holds(u, v) ? 0.8 : 1.0;
      }
      const auto robot_reading_m = static_cast<float>(depth_m);
      depth_m *= before_robot.holds(u, v) ? 0.5 : 1.0;
      const bool broken = draw.one_in(broken_one_in) || (has_hole && hole.holds(u, v));
      const auto index = static_cast<std::size_t>(v) * static_cast<std::size_t>(row_px) + static_cast<std::size_t>(u);
      if (units) {
        const auto rounded = static_cast<std::uint16_t>(std::clamp(depth_m / unit_m, 0.0, 65534.0));
        units_[index] = broken ? draw.one_of<std::uint16_t>({0, 65535, 65534, 1, 7}) : rounded;
      } else {
        metres_[index] = broken ? broken_metres(draw) : static_cast<float>(depth_m);
      }
      if (with_robot && robot.holds(u, v)) {
        std::tie(near_m_[index], far_m_[index]) = interval(robot_reading_m, draw);
      }
    }
  }
  const void* data = units ? static_cast<const void*>(units_.data()) : metres_.data();
  const auto row_bytes = static_cast<std::ptrdiff_t>(row_px) * (units ? 2 : 4);
  const auto format = units ? DepthFormat::uint16_units : DepthFormat::float32_metres;
  frame_.depth = {data, format, width_px, height_px, row_px == width_px && draw.one_in(2) ? 0 : row_bytes, unit_m};
  if (with_robot) {
    frame_.robot = {near_m_.data(), far_m_.data(), row_px == width_px && draw.one_in(2) ? 0 : row_px};
    frame_.robot.within_margin = draw.one_in(2);
  }
  if (bottom_up) {
    frame_.depth.data = static_cast<const char*>(data) + row_bytes * (height_px - 1);
    frame_.depth.stride_bytes = -row_bytes;
  }
  frame_.time_s = draw.uniform(0, 100);
}

}  // namespace depthgrid::views
