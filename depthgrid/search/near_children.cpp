#include "depthgrid/search/near_children.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/near_children.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: it must be seen once for each target.
#include "depthgrid/search/near_children-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::octants::HWY_NAMESPACE {

std::uint32_t near(const Axis& axis, const Cube& cube, float half_m, float bound_m, std::array<float, 8>& distances_m) {
  return near_lanes(axis, cube, half_m, bound_m, distances_m);
}

}  // namespace depthgrid::search::octants::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::search {
namespace octants {

HWY_EXPORT(near);

std::uint32_t near_of_all(const Axis& axis, const Cube& cube, float half_m, float bound_m,
                          std::array<float, 8>& distances_m) noexcept {
  return HWY_DYNAMIC_DISPATCH(near)(axis, cube, half_m, bound_m, distances_m);
}

}  // namespace octants

std::uint32_t near_children(const Axis& axis, const Cube& cube, float half_m, float bound_m,
                            std::array<float, 8>& distances_m) noexcept {
  return octants::near_of_all(axis, cube, half_m, bound_m, distances_m);
}

}  // namespace depthgrid::search
#endif
