#include "depthgrid/search/preparation_rows.hpp"

#include <cstddef>
#include <cstdlib>

namespace depthgrid::search {
namespace {

/// Row v of the result: the columns of the rows v - above to v + below, wider by `left` and `right`.
void spread_rows(const std::vector<PixelRange>& from, int above, int below, int left, int right, int width_px,
                 std::vector<PixelRange>& to) noexcept {
  constexpr int kStep = FloatColumns::kStep;
  const auto height = static_cast<std::ptrdiff_t>(from.size());
  std::copy(from.begin(), from.end(), to.begin());
  for (std::ptrdiff_t offset = -above; offset <= below; ++offset) {
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(-offset, 0);
    const std::ptrdiff_t count = height - std::abs(offset);
    const PixelRange* other = from.data() + first + offset;
    PixelRange* result = to.data() + first;
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      result[i] = joined(result[i], other[i]);
    }
  }
  for (PixelRange& columns : to) {
    if (!columns.empty()) {
      columns.begin = std::max(columns.begin - left, 0) / kStep * kStep;
      columns.end = std::min((columns.end + right + kStep - 1) / kStep * kStep, width_px);
    }
  }
}

}  // namespace

FloatColumns::FloatColumns(int width, int height, int reach)
    : width_px(width),
      reach_px(reach),
      robot(static_cast<std::size_t>(height)),
      free(robot),
      filtered(robot),
      reduced(robot),
      texels(robot),
      windows(robot) {}

void FloatColumns::spread() noexcept {
  spread_rows(robot, reach_px, reach_px, reach_px, reach_px, width_px, free);
  spread_rows(free, reach_px, reach_px, 0, 0, width_px, filtered);
  spread_rows(filtered, 0, 0, reach_px, reach_px, width_px, reduced);
  spread_rows(free, 0, 3, 3, 0, width_px, texels);
  spread_rows(texels, 3, 0, 0, 0, width_px, windows);
}

void FloatColumns::fill() noexcept {
  for (std::vector<PixelRange>* ranges : {&free, &filtered, &reduced, &texels, &windows}) {
    std::fill(ranges->begin(), ranges->end(), PixelRange{0, width_px});
  }
}

void FloatColumns::clear() noexcept {
  for (std::vector<PixelRange>* ranges : {&robot, &free, &filtered, &reduced, &texels, &windows}) {
    std::fill(ranges->begin(), ranges->end(), PixelRange{});
  }
}

PreparationRows::PreparationRows(int width_px, int height_px, int reach_px)
    : columns(width_px, height_px, reach_px),
      height_px_(height_px),
      reach_px_(reach_px),
      narrow_(width_px, kNarrow + 5 * reach_px + 9),
      wide_(width_px, kWide + 2 * reach_px + 7) {
  wide_.fill(kInfinite, std::numeric_limits<float>::infinity());
}

}  // namespace depthgrid::search
