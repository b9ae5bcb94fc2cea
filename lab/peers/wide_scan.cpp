#include "lab/peers/wide_scan.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/peers/wide_scan.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: highway.h must be seen once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::lab::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kWidestVector>;

float nearest_squared(const CloudColumns& cloud, const Eigen::Vector3f& p, float bound_squared) {
  const Floats d;
  const auto px = hn::Set(d, p.x());
  const auto py = hn::Set(d, p.y());
  const auto pz = hn::Set(d, p.z());
  auto nearest = hn::Set(d, bound_squared);
  for (std::size_t i = 0; i < cloud.count; i += hn::Lanes(d)) {
    const auto x = hn::Sub(hn::LoadU(d, cloud.x + i), px);
    const auto y = hn::Sub(hn::LoadU(d, cloud.y + i), py);
    const auto z = hn::Sub(hn::LoadU(d, cloud.z + i), pz);
    nearest = hn::Min(nearest, hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
  }
  return hn::GetLane(hn::MinOfLanes(d, nearest));
}

float nearest_shadow_squared(const RayImage& image, const grid::PixelWindow& window, const Eigen::Vector3f& p,
                             float bound_squared) {
  const Floats d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto one = hn::Set(d, 1.0F);
  const auto px = hn::Set(d, p.x());
  const auto pz = hn::Set(d, p.z());
  auto nearest = hn::Set(d, bound_squared);
  const int first = std::min(window.u_begin, image.width_px - lanes);
  for (int v = window.v_begin; v < window.v_end; ++v) {
    const float* row = image.free_m + static_cast<std::ptrdiff_t>(v) * image.width_px;
    const auto ty = hn::Set(d, image.slope_y[v]);
    const auto py = hn::Set(d, p.y());
    const auto ty_squared_1 = hn::MulAdd(ty, ty, one);
    const auto y_z = hn::MulAdd(ty, py, pz);
    for (int begin = first; begin < window.u_end; begin += lanes) {
      const int u = std::min(begin, image.width_px - lanes);  // the last vector may overlap the one before
      const auto tx = hn::LoadU(d, image.slope_x + u);
      const auto foot = hn::Div(hn::MulAdd(tx, px, y_z), hn::MulAdd(tx, tx, ty_squared_1));
      const auto z = hn::Max(hn::LoadU(d, row + u), foot);
      const auto dx = hn::NegMulAdd(tx, z, px);
      const auto dy = hn::NegMulAdd(ty, z, py);
      const auto dz = hn::Sub(pz, z);
      nearest = hn::Min(nearest, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
    }
  }
  return hn::GetLane(hn::MinOfLanes(d, nearest));
}

void deproject_row(const WorldRow& row, float* HWY_RESTRICT x, float* HWY_RESTRICT y, float* HWY_RESTRICT z,
                   float* HWY_RESTRICT keep) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const std::array<float*, 3> out{x, y, z};
  for (std::size_t begin = 0; begin < row.width; begin += lanes) {
    const std::size_t u = std::min(begin, row.width - lanes);  // the last vector may overlap the one before
    const auto depth = hn::LoadU(d, row.depth_m + u);
    const auto slope = hn::LoadU(d, row.slope_x + u);
    auto inside = hn::Gt(depth, hn::Zero(d));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto ray = hn::MulAdd(slope, hn::Set(d, row.along[i]), hn::Set(d, row.offset[i]));
      const auto value = hn::MulAdd(depth, ray, hn::Set(d, row.origin[i]));
      inside = hn::And(inside, hn::And(hn::Ge(value, hn::Set(d, row.low[i])), hn::Le(value, hn::Set(d, row.high[i]))));
      hn::StoreU(value, d, out[i] + u);
    }
    hn::StoreU(hn::IfThenElseZero(inside, hn::Set(d, 1.0F)), d, keep + u);
  }
}

}  // namespace depthgrid::lab::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::lab {

HWY_EXPORT(nearest_squared);
HWY_EXPORT(nearest_shadow_squared);
HWY_EXPORT(deproject_row);

float nearest_squared(const CloudColumns& cloud, const Eigen::Vector3f& p, float bound_squared) {
  return HWY_DYNAMIC_DISPATCH(nearest_squared)(cloud, p, bound_squared);
}

float nearest_shadow_squared(const RayImage& image, const grid::PixelWindow& window, const Eigen::Vector3f& p,
                             float bound_squared) {
  return HWY_DYNAMIC_DISPATCH(nearest_shadow_squared)(image, window, p, bound_squared);
}

void deproject_row(const WorldRow& row, float* x, float* y, float* z, float* keep) {
  HWY_DYNAMIC_DISPATCH(deproject_row)(row, x, y, z, keep);
}

}  // namespace depthgrid::lab
#endif
