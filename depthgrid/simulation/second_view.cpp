#include "depthgrid/simulation/second_view.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::simulation {

namespace {

constexpr float kSameSurface_px = 1.5F;  ///< disparities of neighbours, and of what falls on the same place

/// One row: where its pixels lie in the second view, and the largest disparity at each place there.
class Row {
 public:
  explicit Row(int width_px) : disparity_(static_cast<std::size_t>(width_px)), nearest_(disparity_.size()) {}

  /// 0: no surface.
  void set(const float* depth_m, float focal_times_baseline) {
    for (std::size_t u = 0; u < disparity_.size(); ++u) {
      disparity_[u] = depth_m[u] > 0 ? focal_times_baseline / depth_m[u] : 0.0F;
    }
    std::fill(nearest_.begin(), nearest_.end(), 0.0F);
    for (std::size_t u = 0; u < disparity_.size(); ++u) {
      const float here = disparity_[u];
      if (here <= 0) {
        continue;
      }
      // A surface that goes on to the next pixel covers what lies between their places, else a pixel's width.
      float from = place(u);
      float to = from;
      if (u + 1 < disparity_.size() && disparity_[u + 1] > 0 && std::abs(disparity_[u + 1] - here) <= kSameSurface_px) {
        from = std::min(from, place(u + 1));
        to = std::max(to, place(u + 1));
      }
      const int last = std::min(static_cast<int>(std::floor(to + 0.5F)), static_cast<int>(nearest_.size()) - 1);
      for (int k = std::max(0, static_cast<int>(std::ceil(from - 0.5F))); k <= last; ++k) {
        nearest_[static_cast<std::size_t>(k)] = std::max(nearest_[static_cast<std::size_t>(k)], here);
      }
    }
  }

  [[nodiscard]] bool hidden(std::size_t u) const {
    if (disparity_[u] <= 0) {
      return false;
    }
    const int k = static_cast<int>(std::lround(place(u)));
    return k < 0 || nearest_[static_cast<std::size_t>(k)] > disparity_[u] + kSameSurface_px;
  }

 private:
  /// Column in the second view, of the pixel's centre less a half.
  [[nodiscard]] float place(std::size_t u) const { return static_cast<float>(u) - disparity_[u]; }

  std::vector<float> disparity_;
  std::vector<float> nearest_;
};

}  // namespace

void mark_hidden_from_second_view(const PinholeCamera& camera, const DepthImage& ideal_m, double baseline_m,
                                  std::vector<std::uint8_t>& hidden) {
  Row row(ideal_m.width_px());
  for (int v = 0; v < ideal_m.height_px(); ++v) {
    const std::size_t first = ideal_m.index(0, v);
    row.set(ideal_m.data() + first, static_cast<float>(camera.fx_px * baseline_m));
    for (std::size_t u = 0; u < static_cast<std::size_t>(ideal_m.width_px()); ++u) {
      if (row.hidden(u)) {
        hidden[first + u] = 1;
      }
    }
  }
}

}  // namespace depthgrid::simulation
