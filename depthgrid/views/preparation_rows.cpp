#include "depthgrid/views/preparation_rows.hpp"

#include <cstddef>
#include <cstdlib>

namespace depthgrid::views {

FloatColumns::FloatColumns(int width_px, int height_px, int radius_px)
    : width_px_(width_px), height_px_(height_px), radius_px_(radius_px), robot_(static_cast<std::size_t>(height_px)) {}

void FloatColumns::begin(bool everything) noexcept {
  everything_ = everything;
  first_robot_row_ = height_px_;
  last_robot_row_ = -1;
}

void FloatColumns::add_robot(int v, const PixelRange& columns) noexcept {
  robot_[static_cast<std::size_t>(v)] = columns;
  if (!columns.empty()) {
    first_robot_row_ = std::min(first_robot_row_, v);
    last_robot_row_ = v;
  }
}

PixelRange FloatColumns::around(int first, int last, int left, int right) const noexcept {
  if (everything_) {
    return {0, width_px_};
  }
  if (first > last_robot_row_ || last < first_robot_row_) {
    return {};
  }
  PixelRange all;
  for (int v = std::max(first, first_robot_row_); v <= std::min(last, last_robot_row_); ++v) {
    all = joined(all, robot(v));
  }
  if (all.empty()) {
    return {};
  }
  return {std::max(all.begin - left, 0) / kStep * kStep,
          std::min((all.end + right + kStep - 1) / kStep * kStep, width_px_)};
}

PreparationRows::PreparationRows(int width_px, int height_px, int radius_px)
    : columns_(width_px, height_px, radius_px),
      height_px_(height_px),
      radius_px_(radius_px),
      narrow_(width_px, kNarrow + 2 * radius_px + 9),
      wide_(width_px, last() + kSecond) {
  wide_.fill(kInfinite, std::numeric_limits<float>::infinity());
}

}  // namespace depthgrid::views
