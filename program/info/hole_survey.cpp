#include "program/info/hole_survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "depthgrid/views/view.hpp"

namespace depthgrid::program {

namespace {

/// Of the image: what a smallest obstacle frees less of is not worth an assumption.
constexpr double kWorthwhile = 0.005;

CameraMargins margins_of(const RigCamera& camera, double smallest_obstacle_m) {
  CameraMargins margins = camera.margins.value_or(CameraMargins{});
  margins.smallest_obstacle_m = smallest_obstacle_m;
  margins.second_view_x_m = camera.rule.near_m > 0 ? margins.second_view_x_m : 0;
  return margins;
}

/// Pixels without reading in the row or the column through this one, whichever are fewer.
int narrower_px(const DepthView& depth, const MeasurementRule& rule, int u, int v, int most_px) {
  const auto missing = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < depth.width_px && y < depth.height_px && !measured_depth_m(depth, rule, x, y);
  };
  const auto run = [&](int du, int dv) {
    int count = 1;
    for (const int side : {-1, 1}) {
      for (int n = 1; count < most_px && missing(u + side * n * du, v + side * n * dv); ++n) {
        ++count;
      }
    }
    return count;
  };
  return std::min(run(1, 0), run(0, 1));
}

std::string share_text(std::int64_t part, std::int64_t whole) {
  std::array<char, 32> text{};
  const double share = whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  (void)std::snprintf(text.data(), text.size(), "%8.1f", share);  // NOLINT(cppcoreguidelines-pro-type-vararg)
  return text.data();
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

}  // namespace

DepthImage freed_depths(const RigCamera& camera, const Frame& frame, double smallest_obstacle_m) {
  DepthImage free_m(camera.intrinsics.width_px, camera.intrinsics.height_px);
  views::View view(camera, margins_of(camera, smallest_obstacle_m), views::Policies{});
  (void)view.update(frame, Pose::Identity());
  for (int v = 0; v < free_m.height_px(); ++v) {
    for (int u = 0; u < free_m.width_px(); ++u) {
      const float free = view.free_m(u, v);
      free_m.at(u, v) = static_cast<double>(free) > camera.rule.near_m ? free : 0.0F;
    }
  }
  return free_m;
}

void HoleSurvey::add(const Frame& frame) {
  const int width_px = camera_.intrinsics.width_px;
  const int height_px = camera_.intrinsics.height_px;
  const auto each_pixel = [&](const auto& visit) {
    for (int v = 0; v < height_px; ++v) {
      for (int u = 0; u < width_px; ++u) {
        visit(u, v);
      }
    }
  };
  if (frame.depth.data == nullptr) {
    return;
  }
  for (std::size_t i = 0; i < kSizes_m.size(); ++i) {
    const DepthImage free_m = freed_depths(camera_, frame, kSizes_m[i]);
    each_pixel([&](int u, int v) { nothing_[i] += free_m.at(u, v) == 0.0F ? 1 : 0; });
  }
  pixels_ += std::int64_t{width_px} * height_px;
  DepthView depth = frame.depth;
  depth.stride_bytes = depth.stride_bytes != 0 ? depth.stride_bytes : row_bytes(depth.format, width_px);
  each_pixel([&](int u, int v) {
    if (!measured_depth_m(depth, camera_.rule, u, v)) {
      const int width = narrower_px(depth, camera_.rule, u, v, 1 << (kWidths - 1));
      ++by_width_[std::min(static_cast<std::size_t>(std::floor(std::log2(width))), kWidths - 1)];
    }
  });
}

double HoleSurvey::useful_size_m() const noexcept {
  const auto freed = [&](std::size_t i) { return static_cast<double>(nothing_.front() - nothing_[i]); };
  const double most = freed(kSizes_m.size() - 1);
  if (most < kWorthwhile * static_cast<double>(pixels_)) {
    return 0;
  }
  std::size_t i = 1;
  while (freed(i) < 0.75 * most) {
    ++i;
  }
  return kSizes_m[i];
}

std::string holes_text(const Rig& rig, const std::vector<HoleSurvey>& surveys) {
  std::string text =
      "holes: % of the image that frees nothing, if no obstacle is smaller than (docs/smallest-obstacle.md)\n"
      "camera               0 cm    1 cm    2 cm    3 cm    5 cm   would help\n";
  for (std::size_t k = 0; k < surveys.size(); ++k) {
    text += padded(rig.cameras[k].id, 17);
    for (const std::int64_t nothing : surveys[k].freeing_nothing()) {
      text += share_text(nothing, surveys[k].pixels());
    }
    const double useful_m = surveys[k].useful_size_m();
    text += useful_m > 0 ? "   smallest_obstacle_m " + std::to_string(useful_m).substr(0, 4) + "\n" : "   none\n";
  }
  text +=
      "pixels without measurement, % of the image, by the width of their hole in its row or column, the narrower\n"
      "camera               1 px   2-3 px  4-7 px 8-15 px  16-31   wider\n";
  for (std::size_t k = 0; k < surveys.size(); ++k) {
    text += padded(rig.cameras[k].id, 17);
    for (const std::int64_t count : surveys[k].by_width()) {
      text += share_text(count, surveys[k].pixels());
    }
    text += "\n";
  }
  return text;
}

}  // namespace depthgrid::program
