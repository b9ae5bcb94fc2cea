// The minimum filter in single precision. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_VIEWS_DEPTH_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_VIEWS_DEPTH_ROWS_INL
#undef DEPTHGRID_VIEWS_DEPTH_ROWS_INL
#else
#define DEPTHGRID_VIEWS_DEPTH_ROWS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "depthgrid/views/image_preparation.hpp"
#include "depthgrid/views/reading_rows-inl.hpp"
#include "depthgrid/views/vector_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {

/// Whether some readings limit what their own pixel frees and say nothing of its neighbours.
HWY_INLINE bool has_own_limits(const NewImage& image) {
  return image.robot.near_m != nullptr && image.robot.within_margin;
}

/// Lanes of a row in which the image has what the camera gave, no hole's.
template <class D>
HWY_INLINE M is_measured(D d_values, const NewImage& image, int v, int u, const auto& part) {
  using Value = hn::TFromD<D>;
  const auto row = [v](const DepthView& depth) HWY_ATTR {
    return reinterpret_cast<const Value*>(static_cast<const char*>(depth.data) + depth.stride_bytes * v);
  };
  const auto counts_as = part.load(d_values, row(image.depth) + u, Value{0});
  const auto given = part.load(d_values, row(image.measured) + u, Value{0});
  if constexpr (sizeof(Value) == 2) {
    const Ints d;
    return hn::RebindMask(Floats(), hn::Eq(hn::PromoteTo(d, counts_as), hn::PromoteTo(d, given)));
  } else {
    return hn::Eq(counts_as, given);
  }
}

/// A reading D that may be the robot's where some of what it may mean lies in the interval: near <= D + m(D) and
/// D - m(D) <= far. Then its pixel is free up to the exit. What it shows is the robot and says nothing of what stands
/// beside it, unless it may mean what is behind the interval, or fills a hole.
struct Explained {
  /// `reduced`: D - m(D), below the exact value by up to 2^-20 D, so that 2 D less that is above D + m(D).
  HWY_INLINE Explained(V depth, V reduced, V near, V far, M measured) {
    const Floats d;
    const V last = hn::Sub(hn::Add(depth, depth), reduced);
    const M in_front = hn::And(hn::Gt(near, hn::Zero(d)), hn::Le(near, hn::Mul(last, hn::Set(d, 1.0F - 0x1p-18F))));
    const M holds = hn::And(hn::Le(near, far), hn::Le(far, hn::Set(d, kLargest)));
    robot = hn::And(in_front, hn::And(hn::Le(reduced, far), holds));
    const M not_behind = hn::Le(hn::Mul(last, hn::Set(d, 1.0F + 0x1p-18F)), far);
    alone = hn::And(hn::And(robot, measured), hn::And(not_behind, hn::Gt(reduced, hn::Zero(d))));
  }
  M robot, alone;
};

/// Reduced depths of one row: D - m(D), or the robot's exit where the reading is the robot's. `values` are codes or
/// metres. `own_m`, where has_own_limits(): exits that limit their own pixel alone, whose reduced depth is infinite.
template <class Reader, class D>
HWY_INLINE void reduce_row(D d_values, const Reader& reader, const Reduction& reduction, const NewImage& image, int v,
                           const hn::TFromD<D>* values, const PixelRange& columns, PreparationRows& rows,
                           float* own_m) {
  const Floats d;
  const int width_px = image.depth.width_px;
  const bool robot_here = image.robot.near_m != nullptr && !rows.columns().robot(v).empty();
  const float* near_m = robot_here ? image.robot.near_m + image.robot.stride_px * v : nullptr;
  const float* far_m = robot_here ? image.robot.far_m + image.robot.stride_px * v : nullptr;
  float* reduced_m = rows.reduced_m(v);
  const Reducer reduced(reduction);
  const V pocket = hn::Set(d, image.pocket_m);
  const V pocket_rounding = hn::Set(d, image.pocket_m > 0 ? 1.0F - 0x1p-23F : 1.0F);
  const V largest = hn::Set(d, kLargest);
  const V infinite = hn::Set(d, kInf);
  const bool own_limits = has_own_limits(image);
  for_columns(columns, lanes(d), [&](int u, const auto& part) HWY_ATTR {
    const auto value = part.load(d_values, values + u, hn::TFromD<D>{0});
    V result = reduced(reader(value));
    V own = infinite;
    const V near = robot_here ? part.load(d, near_m + u, 0.0F) : hn::Zero(d);
    // Beside the robot there is nothing to be read of its far ends, which no cache has.
    if (!hn::AllFalse(d, hn::Gt(near, hn::Zero(d)))) {
      const V far = part.load(d, far_m + u, 0.0F);
      const V exit = hn::Max(hn::Min(hn::Mul(hn::Add(far, pocket), pocket_rounding), largest), far);
      if (own_limits) {
        const Explained is(reader.about_m(value), result, near, far, is_measured(d_values, image, v, u, part));
        own = hn::IfThenElse(is.alone, exit, own);
        result = hn::IfThenElse(is.alone, infinite, hn::IfThenElse(is.robot, exit, result));
      } else {
        const M in_front = hn::And(hn::Gt(near, hn::Zero(d)), hn::Le(near, result));
        const M inside = hn::And(reader.at_most(value, far), hn::Le(far, largest));
        result = hn::IfThenElse(hn::And(in_front, inside), exit, result);
      }
    }
    if (own_limits) {
      part.store(own, d, own_m + u);
    }
    hn::StoreU(result, d, reduced_m + u);
  });
  if (columns.end == width_px) {
    std::fill_n(reduced_m + width_px, image.radius_px, 0.0F);
  }
}

/// Minima over the 2 w + 1 neighbours in the row.
template <int kRadius>
HWY_INLINE void filter_row(const float* HWY_RESTRICT reduced_m, const PixelRange& columns, int radius_if_unknown,
                           float* HWY_RESTRICT minimum_m) {
  const Floats d;
  const int radius_px = kRadius > 0 ? kRadius : radius_if_unknown;
  for (int u = columns.begin; u < columns.end; u += lanes(d)) {
    V smallest = hn::LoadU(d, reduced_m + u - radius_px);
    for (int k = 1 - radius_px; k <= radius_px; ++k) {
      smallest = hn::Min(smallest, hn::LoadU(d, reduced_m + u + k));
    }
    hn::StoreU(smallest, d, minimum_m + u);
  }
}

/// g of one row from the minima of the rows around it. kRadius is w, or 0 where it is not known here. `own_limits`:
/// free_m has what reduce_row() wrote, limits of the pixels themselves.
template <int kRadius>
HWY_INLINE void filter_columns(PreparationRows& rows, const PixelRange& columns, int radius_if_unknown, int v,
                               bool own_limits, float* HWY_RESTRICT free_m) {
  const Floats d;
  const int radius_px = kRadius > 0 ? kRadius : radius_if_unknown;
  std::array<const float*, 2 * (kRadius > 0 ? kRadius : kMaxFilterRadius) + 1> around{};
  for (int i = 0; i <= 2 * radius_px; ++i) {
    around[i] = rows.minimum_m(v - radius_px + i);
  }
  for_columns(columns, lanes(d), [&](int u, const auto& part) HWY_ATTR {
    V smallest = hn::LoadU(d, around[0] + u);
    for (int i = 1; i <= 2 * radius_px; ++i) {
      smallest = hn::Min(smallest, hn::LoadU(d, around[i] + u));
    }
    if (own_limits) {
      smallest = hn::Min(smallest, part.load(d, free_m + u, 0.0F));
    }
    part.store(smallest, d, free_m + u);
  });
}

/// One row of level 0 from the windows of four rows.
HWY_INLINE void first_level_row(PreparationRows& rows, const PixelRange& columns, int j, float* HWY_RESTRICT texels) {
  const Floats d;
  const float* HWY_RESTRICT row0 = rows.window_m(j);
  const float* HWY_RESTRICT row1 = rows.window_m(j + 1);
  const float* HWY_RESTRICT row2 = rows.window_m(j + 2);
  const float* HWY_RESTRICT row3 = rows.window_m(j + 3);
  for (int u = columns.begin; u < columns.end; u += lanes(d)) {
    const V upper = hn::Min(hn::LoadU(d, row0 + u), hn::LoadU(d, row1 + u));
    const V lower = hn::Min(hn::LoadU(d, row2 + u), hn::LoadU(d, row3 + u));
    store_some(hn::Min(upper, lower), d, texels + u, columns.end - u);
  }
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
