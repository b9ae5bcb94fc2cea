// The robot in the rows of an image: where it is, and what is free up to behind it. Included once for each instruction
// set. Internal.
#if defined(DEPTHGRID_VIEWS_ROBOT_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_VIEWS_ROBOT_ROWS_INL
#undef DEPTHGRID_VIEWS_ROBOT_ROWS_INL
#else
#define DEPTHGRID_VIEWS_ROBOT_ROWS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "depthgrid/views/image_preparation.hpp"
#include "depthgrid/views/vector_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {

/// Where a row shows the robot.
HWY_INLINE PixelRange robot_columns(const NewImage& image, int v) {
  const Floats d;
  constexpr int kStep = FloatColumns::kStep;
  const int width_px = image.depth.width_px;
  const float* near_m = image.robot.near_m + image.robot.stride_px * v;
  const float* far_m = image.robot.far_m + image.robot.stride_px * v;
  const std::ptrdiff_t ahead_bytes = 4 * image.robot.stride_px * static_cast<std::ptrdiff_t>(sizeof(float));
  int first = width_px;
  int last = -1;
  for_columns({0, width_px}, lanes(d), [&](int u, const auto& part) HWY_ATTR {
    ask_for(near_m + u, ahead_bytes);
    if (!hn::AllFalse(d, hn::Gt(part.load(d, near_m + u, 0.0F), hn::Zero(d)))) {
      ask_for(far_m + u, 0);
      first = std::min(first, u);
      last = u + lanes(d) - 1;
    }
  });
  return last < 0 ? PixelRange{} : PixelRange{first / kStep * kStep, std::min((last / kStep + 1) * kStep, width_px)};
}

/// Frees one row of g up to the robot's exits where the robot begins in free space. Where it does not, or reaches into
/// the blind zone, it is an island.
HWY_INLINE bool join_robot(const NewImage& image, int v, const PixelRange& columns, PreparedImage& result,
                           float* free_row_m) {
  const Floats d;
  const int n = lanes(d);
  const int width_px = image.depth.width_px;
  const float* near_m = image.robot.near_m + image.robot.stride_px * v;
  const float* far_m = image.robot.far_m + image.robot.stride_px * v;
  const V blind = hn::Set(d, image.blind_m);
  PixelRange islands;
  for (int u = columns.begin; u < columns.end; u += n) {
    const int count = width_px - u;
    const V near = load_some(d, near_m + u, count, 0.0F);
    if (hn::AllFalse(d, hn::Gt(near, hn::Zero(d)))) {
      continue;
    }
    const V far = load_some(d, far_m + u, count, 0.0F);
    const V free = load_some(d, free_row_m + u, count, 0.0F);
    // An interval that is not finite, or whose ends are swapped, holds nothing.
    const M robot = hn::And(hn::And(hn::Gt(near, hn::Zero(d)), hn::Le(near, far)), hn::Le(far, hn::Set(d, kLargest)));
    const M begins_free = hn::And(robot, hn::Le(near, free));
    store_some(hn::IfThenElse(begins_free, hn::Max(free, far), free), d, free_row_m + u, count);
    const M island = hn::And(robot, hn::Or(hn::Gt(near, free), hn::Lt(near, blind)));
    if (!hn::AllFalse(d, island)) {
      ask_for(pixel_row(result.island_near_m.data(), width_px, v + 2) + u, 0);
      ask_for(pixel_row(result.island_far_m.data(), width_px, v + 2) + u, 0);
      store_some(hn::IfThenElse(island, near, hn::Set(d, kInf)), d,
                 pixel_row(result.island_near_m.data(), width_px, v) + u, count);
      store_some(hn::IfThenElse(island, far, hn::Set(d, -kInf)), d,
                 pixel_row(result.island_far_m.data(), width_px, v) + u, count);
      islands = joined(islands, {u, std::min(u + n, width_px)});
    }
  }
  result.island_columns[static_cast<std::size_t>(v)] = islands;
  return !islands.empty();
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
