// Which parts of an image need single precision, and the rows that the passes over a new image hand on to each other.
// Internal.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "depthgrid/core/aligned_vector.hpp"
#include "depthgrid/views/pixel_range.hpp"

namespace depthgrid::views {

/// The columns of each row that are worked out in single precision because of the robot, w being the radius of the
/// filter. All begin and end at multiples of kStep, or at the image's border, so that they do not depend on the length
/// of vectors.
class FloatColumns {
 public:
  static constexpr int kStep = 16;

  FloatColumns(int width_px, int height_px, int radius_px);

  /// Before the first row of an image. `everything`: all columns of all rows, wherever the robot is.
  void begin(bool everything) noexcept;
  /// Rows from row v on that a function may ask about are those up to here minus lookahead().
  [[nodiscard]] int lookahead() const noexcept { return std::max(2 * radius_px_, radius_px_ + 3); }
  /// Where row v shows the robot. Rows come in their order.
  void add_robot(int v, const PixelRange& columns) noexcept;
  [[nodiscard]] const PixelRange& robot(int v) const noexcept { return robot_[static_cast<std::size_t>(v)]; }

  /// g depends on the robot.
  [[nodiscard]] PixelRange free(int v) const noexcept {
    return around(v - radius_px_, v + radius_px_, radius_px_, radius_px_);
  }
  /// Minima along the row that free() reads.
  [[nodiscard]] PixelRange filtered(int v) const noexcept {
    return around(v - 2 * radius_px_, v + 2 * radius_px_, radius_px_, radius_px_);
  }
  /// What those read.
  [[nodiscard]] PixelRange reduced(int v) const noexcept {
    return around(v - 2 * radius_px_, v + 2 * radius_px_, 2 * radius_px_ + kStep, 2 * radius_px_ + kStep);
  }
  /// Texels of level 0 that depend on free().
  [[nodiscard]] PixelRange texels(int v) const noexcept {
    return around(v - radius_px_, v + 3 + radius_px_, radius_px_ + 3 + kStep, radius_px_);
  }
  /// Minima along the row that texels() reads.
  [[nodiscard]] PixelRange windows(int v) const noexcept {
    return around(v - 3 - radius_px_, v + 3 + radius_px_, radius_px_ + 3 + kStep, radius_px_);
  }

 private:
  /// The robot's columns in the rows from first to last, wider by `left` and `right` and then up to multiples of kStep.
  /// Whoever widens what was widened before adds a kStep.
  [[nodiscard]] PixelRange around(int first, int last, int left, int right) const noexcept;

  int width_px_;
  int height_px_;
  int radius_px_;
  bool everything_ = false;
  int first_robot_row_ = 0;
  int last_robot_row_ = -1;
  std::vector<PixelRange> robot_;
};

/// Rows of 16-bit values, or floats: with room for a vector and for neighbours before and behind.
template <class Value>
class ScratchRows {
 public:
  ScratchRows(int width_px, int count)
      : stride_((static_cast<std::size_t>(width_px) / kMargin + 3) * kMargin),
        values_(static_cast<std::size_t>(count) * stride_) {}
  [[nodiscard]] Value* operator[](int n) noexcept {
    return values_.data() + static_cast<std::size_t>(n) * stride_ + kMargin;
  }
  void fill(int n, Value value) noexcept { std::fill_n((*this)[n] - kMargin, stride_, value); }

 private:
  static constexpr std::size_t kMargin = 64;
  std::size_t stride_;
  AlignedVector<Value> values_;
};

/// Rows that are kept for as long as the next passes read them; w is the radius of the filter.
class PreparationRows {
 public:
  PreparationRows(int width_px, int height_px, int radius_px);

  /// Codes of row v (see Reading), all zero outside the image; zeros before and behind the row. The last 2 w + 2 rows
  /// are kept.
  [[nodiscard]] std::uint16_t* codes(int v) noexcept {
    return outside(v) ? narrow_[kZero] : narrow_[kNarrow + 7 + v % (2 * radius_px_ + 2)];
  }
  /// Of the rows v and v + 1, v even: minima of each code and w above and below; zeros before and behind the row.
  [[nodiscard]] std::uint16_t* narrow_minimum(int v) noexcept { return narrow_[kNarrow + v % 2]; }
  /// Minima of those and w to both sides: codes of g; all zero outside the image. The last five rows are kept.
  [[nodiscard]] std::uint16_t* narrow_free(int v) noexcept {
    return outside(v) ? narrow_[kZero] : narrow_[kNarrow + 2 + v % 5];
  }
  /// Reduced depths of row v; zeros before and behind the row. The last two rows are kept.
  [[nodiscard]] float* reduced_m(int v) noexcept { return wide_[2 + v % 2]; }
  /// Minima of each reduced depth and w to both sides; all zero outside the image. The last 2 w + 2 rows are kept.
  [[nodiscard]] float* minimum_m(int v) noexcept {
    return outside(v) ? wide_[kZero] : wide_[kWide + v % (2 * radius_px_ + 2)];
  }
  /// Minima of each free depth and the three to its right; all infinite outside the image. The last five rows are kept.
  [[nodiscard]] float* window_m(int v) noexcept {
    return outside(v) ? wide_[kInfinite] : wide_[kWide + 2 * radius_px_ + 2 + v % 5];
  }
  /// Near and far ends of the second interval of rows of pixels. The last kSecondRows are kept.
  static constexpr int kSecondRows = 4;
  [[nodiscard]] float* second_m(int v, bool far) noexcept {
    return wide_[last() + 2 * (v % kSecondRows) + (far ? 1 : 0)];
  }
  /// Extrema of those of each column and the three to its right. The last kSecondRows + 3 are kept.
  [[nodiscard]] float* second_window_m(int v, bool far) noexcept {
    return wide_[last() + 2 * (kSecondRows + v % (kSecondRows + 3)) + (far ? 1 : 0)];
  }

  [[nodiscard]] FloatColumns& columns() noexcept { return columns_; }

 private:
  static constexpr int kZero = 0;  ///< of both kinds
  static constexpr int kInfinite = 1;
  static constexpr int kNarrow = 1;
  static constexpr int kWide = 4;
  static constexpr int kSecond = 2 * (2 * kSecondRows + 3);  ///< rows for the second interval, the last ones
  [[nodiscard]] int last() const noexcept { return kWide + 2 * radius_px_ + 7; }
  [[nodiscard]] bool outside(int v) const noexcept { return v < 0 || v >= height_px_; }

  FloatColumns columns_;
  int height_px_;
  int radius_px_;
  ScratchRows<std::uint16_t> narrow_;
  ScratchRows<float> wide_;
};

}  // namespace depthgrid::views
