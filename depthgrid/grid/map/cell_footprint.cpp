#include "depthgrid/grid/map/cell_footprint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::grid {
namespace {

using RowSpan = PixelListMap::RowSpan;

std::uint16_t pixel(double x) noexcept { return static_cast<std::uint16_t>(x); }

}  // namespace

void CellFootprint::include(int u_px, int v_px) {
  const auto u = static_cast<std::uint16_t>(u_px);
  if (rows.empty()) {
    v_first_px = v_px;
    rows.push_back({u, u});
    return;
  }
  while (v_px < v_first_px) {
    rows.insert(rows.begin(), {u, u});
    --v_first_px;
  }
  while (v_px >= v_first_px + static_cast<int>(rows.size())) {
    rows.push_back({u, u});
  }
  RowSpan& row = rows[static_cast<std::size_t>(v_px - v_first_px)];
  row = {std::min(row.u_first_px, u), std::max(row.u_last_px, u)};
}

CellProjector::CellProjector(const PinholeCamera& principal, const SecondaryCamera& secondary)
    : principal_(principal), camera_(secondary.camera), T_secondary_principal_(secondary.T_secondary_principal) {}

void CellProjector::set_ray(int u, int v) noexcept {
  constexpr std::array<std::array<int, 2>, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (std::size_t i = 0; i < kAround.size(); ++i) {
    corner_[i] = T_secondary_principal_.linear() * deproject(principal_, {static_cast<double>(u + kAround[i][0]),
                                                                          static_cast<double>(v + kAround[i][1]), 1.0});
  }
  last_.depth_m = -1;
}

CellProjector::Face CellProjector::face(double depth_m) const noexcept {
  Face result;
  result.depth_m = depth_m;
  result.nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corner_.size(); ++i) {
    const Eigen::Vector3d p_secondary = depth_m * corner_[i] + T_secondary_principal_.translation();
    const DepthPoint projected = depthgrid::project(camera_, p_secondary);
    result.x_px[i] = projected.x_px;
    result.y_px[i] = projected.y_px;
    result.nearest_m = std::min(result.nearest_m, projected.depth_m);
  }
  return result;
}

void CellProjector::add_edge(double x0, double y0, double x1, double y1, int v_low, int v_high,
                             double slack_px) noexcept {
  if (y0 > y1) {
    std::swap(x0, x1);
    std::swap(y0, y1);
  }
  if (y1 + slack_px < v_low || y0 - slack_px >= v_high + 1) {
    return;
  }
  const int first = y0 - slack_px <= v_low ? v_low : static_cast<int>(std::floor(y0 - slack_px));
  const int last = y1 + slack_px >= v_high ? v_high : static_cast<int>(std::floor(y1 + slack_px));
  const double height = y1 - y0;
  for (int v = first; v <= last; ++v) {
    // The part of the edge within slack of the row. An edge along the row lies in it as a whole.
    const double begin = height > 0 ? std::clamp((v - slack_px - y0) / height, 0.0, 1.0) : 0.0;
    const double end = height > 0 ? std::clamp((v + 1 + slack_px - y0) / height, 0.0, 1.0) : 1.0;
    const double x_begin = x0 + begin * (x1 - x0);
    const double x_end = x0 + end * (x1 - x0);
    Extent& extent = extents_[static_cast<std::size_t>(v - v_low)];
    extent.low_px = std::min({extent.low_px, x_begin, x_end});
    extent.high_px = std::max({extent.high_px, x_begin, x_end});
  }
}

bool CellProjector::project(double front_m, double back_m, CellFootprint& footprint) {
  footprint.rows.clear();
  const Face front = last_.depth_m == front_m ? last_ : face(front_m);
  last_ = face(back_m);
  const Face& back = last_;
  const double nearest_m = std::min(front.nearest_m, back.nearest_m);
  if (!(nearest_m > kNearestCornerM)) {
    return false;
  }
  const auto [front_x_low, front_x_high] = std::minmax_element(front.x_px.begin(), front.x_px.end());
  const auto [back_x_low, back_x_high] = std::minmax_element(back.x_px.begin(), back.x_px.end());
  const auto [front_y_low, front_y_high] = std::minmax_element(front.y_px.begin(), front.y_px.end());
  const auto [back_y_low, back_y_high] = std::minmax_element(back.y_px.begin(), back.y_px.end());
  const double x_low = std::min(*front_x_low, *back_x_low);
  const double x_high = std::max(*front_x_high, *back_x_high);
  const double y_low = std::min(*front_y_low, *back_y_low);
  const double y_high = std::max(*front_y_high, *back_y_high);
  // Far outside the image coordinates are large and so is their rounding.
  const double slack_px =
      1e-7 + 1e-14 * std::max({std::abs(x_low), std::abs(x_high), std::abs(y_low), std::abs(y_high)});
  if (!(x_high + slack_px >= 0 && x_low - slack_px < camera_.width_px && y_high + slack_px >= 0 &&
        y_low - slack_px < camera_.height_px)) {
    return false;
  }
  const int v_low = static_cast<int>(std::floor(std::max(y_low - slack_px, 0.0)));
  const int v_high = static_cast<int>(std::floor(std::min(y_high + slack_px, camera_.height_px - 1.0)));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  extents_.assign(static_cast<std::size_t>(v_high - v_low) + 1, {kInfinity, -kInfinity});
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    add_edge(front.x_px[i], front.y_px[i], front.x_px[j], front.y_px[j], v_low, v_high, slack_px);
    add_edge(back.x_px[i], back.y_px[i], back.x_px[j], back.y_px[j], v_low, v_high, slack_px);
    add_edge(front.x_px[i], front.y_px[i], back.x_px[i], back.y_px[i], v_low, v_high, slack_px);
  }
  const double width_px = camera_.width_px;
  for (std::size_t row = 0; row < extents_.size(); ++row) {
    const double low = extents_[row].low_px - slack_px;
    const double high = extents_[row].high_px + slack_px;
    if (high < 0 || low >= width_px || low > high) {
      if (footprint.rows.empty()) {
        continue;  // convex: rows that miss the image stand before and after those that do not
      }
      break;
    }
    if (footprint.rows.empty()) {
      footprint.v_first_px = v_low + static_cast<int>(row);
    }
    footprint.rows.push_back({pixel(std::max(low, 0.0)), pixel(std::min(high, width_px - 1))});
  }
  footprint.d_start_m = static_cast<float>(nearest_m);
  return !footprint.rows.empty();
}

}  // namespace depthgrid::grid
