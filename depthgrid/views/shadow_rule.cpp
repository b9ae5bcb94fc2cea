#include "depthgrid/views/shadow_rule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/rounding.hpp"

namespace depthgrid::views {
namespace {

/// No reading: far below every delta less a way in the image.
constexpr float kNone = -1e9F;
/// Readings that are so near are all the same.
constexpr double kMost = 1e6;

/// Columns that the reading's place moves at most, rounded up.
float delta_px(double depth_m, const SensorMargin& margin, double reach_px_m) noexcept {
  const double least_m = depth_m - depth_margin_m(margin, depth_m);
  return least_m * kMost > reach_px_m ? rounded_up(reach_px_m / least_m) : static_cast<float>(kMost);
}

}  // namespace

ShadowRule::ShadowRule(const PinholeCamera& camera, double metres_per_unit, const MeasurementRule& rule,
                       const SensorMargin& margin, double second_view_x_m)
    : width_px_(camera.width_px),
      height_px_(camera.height_px),
      radius_px_(margin.lateral_px),
      towards_right_(second_view_x_m > 0),
      reach_px_m_(camera.fx_px * std::abs(second_view_x_m)),
      most_px_(reach_px_m_ / rule.near_m),
      rule_(rule),
      margin_(margin),
      reading_(rule, metres_per_unit, margin),
      delta_of_units_(65536, kNone),
      band_(static_cast<std::size_t>(width_px_)) {
  if (second_view_x_m == 0 || !std::isfinite(second_view_x_m) || !(rule.near_m > 0)) {
    fail("the second view stands at ", second_view_x_m, " m, the nearest reading is at ", rule.near_m,
         " m; neither may be 0");
  }
  for (std::size_t i = 0; i < delta_of_units_.size(); ++i) {
    const auto value = static_cast<std::uint16_t>(i);
    const DepthView pixel{&value, DepthFormat::uint16_units, 1, 1, sizeof value, metres_per_unit};
    if (const auto depth_m = measured_depth_m(pixel, rule, 0, 0)) {
      delta_of_units_[i] = delta_px(static_cast<double>(*depth_m), margin, reach_px_m_);
    }
  }
  for (Row& row : rows_) {
    row.tall.assign(band_.size(), kNone);
    row.hidden.assign(band_.size(), kNone);
  }
  const std::size_t pixels = band_.size() * static_cast<std::size_t>(height_px_);
  deltas_px_.resize(pixels);
  filled_units_.resize(pixels);
  filled_m_.resize(pixels);
}

float* ShadowRule::deltas(int v) noexcept { return deltas_px_.data() + std::ptrdiff_t{width_px_} * v; }

void ShadowRule::read_row(const DepthView& depth, int v) noexcept {
  const char* source = static_cast<const char*>(depth.data) + depth.stride_bytes * v;
  float* delta = deltas(v);
  if (of_units_) {
    std::uint16_t* units = filled_units_.data() + std::ptrdiff_t{width_px_} * v;
    std::memcpy(units, source, static_cast<std::size_t>(width_px_) * sizeof *units);
    for (int i = 0; i < width_px_; ++i) {
      delta[i] = delta_of_units_[units[column(i)]];
    }
  } else {
    float* metres = filled_m_.data() + std::ptrdiff_t{width_px_} * v;
    std::memcpy(metres, source, static_cast<std::size_t>(width_px_) * sizeof *metres);
    for (int i = 0; i < width_px_; ++i) {
      const float x = metres[column(i)];
      const bool beyond = x > reading_.highest_m && std::isfinite(x);
      const float depth_m = beyond ? reading_.beyond_highest_m : x;
      const bool valid = depth_m >= reading_.lowest_m && depth_m <= reading_.highest_m;
      delta[i] = valid ? delta_px(static_cast<double>(depth_m), margin_, reach_px_m_) : kNone;
    }
  }
}

void ShadowRule::widen(int v, Row& row) noexcept {
  std::copy_n(deltas(v), width_px_, row.tall.data());
  for (int r = std::max(v - radius_px_, 0); r <= std::min(v + radius_px_, height_px_ - 1); ++r) {
    const float* other = deltas(r);
    float* tall = row.tall.data();
    for (int i = 0; i < width_px_; ++i) {
      tall[i] = std::max(tall[i], other[i]);
    }
  }
}

void ShadowRule::find_hidden() noexcept {
  std::array<float, kRowsAtOnce> hidden{};
  hidden.fill(kNone);
  for (int i = width_px_ - 1; i >= 0; --i) {
    for (std::size_t r = 0; r < kRowsAtOnce; ++r) {
      rows_[r].hidden[static_cast<std::size_t>(i)] = hidden[r];
      hidden[r] = std::max(hidden[r], rows_[r].tall[static_cast<std::size_t>(i)]) - 1;
    }
  }
}

float ShadowRule::least_of_last(const float* delta, int end) noexcept {
  auto least = static_cast<float>(kMost);
  int readings = 0;
  for (int i = end - 1; i >= 0 && readings < 3; --i) {
    if (delta[i] > kNone) {
      least = std::min(least, delta[i]);
      ++readings;
    }
  }
  return least;
}

void ShadowRule::find_bands(int v, const Row& row) noexcept {
  const float* delta = deltas(v);
  // Of the last three readings: one of them may be between two surfaces.
  auto behind = static_cast<float>(kMost);
  for (int i = 0; i < width_px_; ++i) {
    const auto at = static_cast<std::size_t>(i);
    band_[at] = 0;
    if (delta[i] > kNone) {
      continue;
    }
    if (i > 0 && delta[i - 1] > kNone) {
      behind = least_of_last(delta, i);
    }
    band_[at] = i >= most_px_ && row.hidden[at] > 0 && behind <= row.hidden[at] + 1.5F ? 1 : 0;
  }
}

void ShadowRule::write_row(int v, const Row& row, std::vector<HoleBounds>* rims) noexcept {
  int last_lowered = -1 - radius_px_;
  for (int i = 0; i < width_px_; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (band_[at] == 0) {
      continue;
    }
    // The filter takes the value of a neighbour w farther on, which is less by w, unless a reading stands between.
    const auto next = band_.begin() + i + 1;
    const bool lowered_beside =
        i + radius_px_ < width_px_ && std::all_of(next, next + radius_px_, [](auto band) { return band != 0; });
    const double beside_image_px = most_px_ - (width_px_ - i);
    const double most_px = std::max(static_cast<double>(row.hidden[at]), beside_image_px) + 1;
    // Only where the filter lowers another column of the band by this one has it to be so low.
    const float largest = of_units_ ? 65535.0F : std::numeric_limits<float>::infinity();
    const double counts_m = counts_as_m(lowered_beside ? most_px : most_px + radius_px_);
    const std::ptrdiff_t pixel = std::ptrdiff_t{width_px_} * v + column(i);
    const auto value = [this](double depth_m) {
      return of_units_ ? static_cast<float>(units_not_above(reading_, depth_m)) : metres_not_above(reading_, depth_m);
    };
    last_lowered = lowered_beside ? i : last_lowered;
    if (!lowered_beside && rims != nullptr && rims->size() < rims->capacity()) {
      rims->push_back({static_cast<std::size_t>(pixel), value(counts_m),
                       i - last_lowered <= radius_px_ ? value(counts_as_m(most_px)) : largest});
    } else if (of_units_) {
      filled_units_[static_cast<std::size_t>(pixel)] = units_not_above(reading_, counts_m);
    } else {
      filled_m_[static_cast<std::size_t>(pixel)] = metres_not_above(reading_, counts_m);
    }
  }
}

double ShadowRule::counts_as_m(double most_px) const noexcept {
  const double nearest_m = reach_px_m_ / most_px;
  // The margin of more is more.
  return nearest_m + depth_margin_m(margin_, nearest_m);
}

DepthView ShadowRule::fill(const DepthView& depth, std::vector<HoleBounds>* rims) noexcept {
  if (rims != nullptr) {
    rims->clear();
  }
  of_units_ = depth.format == DepthFormat::uint16_units;
  for (int v = 0; v < height_px_; ++v) {
    read_row(depth, v);
  }
  // Several rows at once, because each step along a row waits for the one before.
  for (int v = 0; v < height_px_; v += static_cast<int>(kRowsAtOnce)) {
    const int count = std::min(static_cast<int>(kRowsAtOnce), height_px_ - v);
    for (int r = 0; r < count; ++r) {
      widen(v + r, rows_[static_cast<std::size_t>(r)]);
    }
    find_hidden();
    for (int r = 0; r < count; ++r) {
      find_bands(v + r, rows_[static_cast<std::size_t>(r)]);
      write_row(v + r, rows_[static_cast<std::size_t>(r)], rims);
    }
  }
  DepthView filled = depth;
  filled.stride_bytes = row_bytes(depth.format, width_px_);
  filled.data = of_units_ ? static_cast<const void*>(filled_units_.data()) : filled_m_.data();
  return filled;
}

}  // namespace depthgrid::views
