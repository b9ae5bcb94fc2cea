// Boxes in a camera's frame and in its image, one a lane. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_VIEWS_BOXES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_VIEWS_BOXES_INL
#undef DEPTHGRID_VIEWS_BOXES_INL
#else
#define DEPTHGRID_VIEWS_BOXES_INL
#endif

#include "depthgrid/views/eight_lanes-inl.hpp"
#include "depthgrid/views/local_camera.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::octants::HWY_NAMESPACE {

/// Boxes, one a lane: centre and half sides along the world's axes.
struct Boxes {
  V x, y, z;
  V half_x, half_y, half_z;
  V half_diagonal;
};

/// Bounds of the boxes in a camera's frame, a little more than rounding takes; grown by the camera's pose error if
/// asked for.
struct Bounds {
  V x_low, x_high, y_low, y_high, z_low, z_high;
};

HWY_INLINE Bounds bounds_in(const LocalCamera& camera, const Boxes& boxes, bool with_pose_error = true) {
  const Floats d;
  const V x = hn::Add(weighted(camera.rotation.data(), boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[0]));
  const V y = hn::Add(weighted(camera.rotation.data() + 3, boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[1]));
  const V z = hn::Add(weighted(camera.rotation.data() + 6, boxes.x, boxes.y, boxes.z), hn::Set(d, camera.offset_m[2]));
  V grown = hn::Set(d, camera.guard_m);
  if (camera.has_pose_error && with_pose_error) {
    const V range =
        hn::Add(hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z))), boxes.half_diagonal);
    const V pose_error = hn::Add(hn::Set(d, camera.pose_error_m), hn::Mul(hn::Set(d, camera.pose_error_per_m), range));
    grown = hn::Add(grown, hn::Mul(pose_error, hn::Set(d, 1.00001F)));
  }
  const float* HWY_RESTRICT spread = camera.absolute_rotation.data();
  const V half_x = hn::Add(weighted(spread, boxes.half_x, boxes.half_y, boxes.half_z), grown);
  const V half_y = hn::Add(weighted(spread + 3, boxes.half_x, boxes.half_y, boxes.half_z), grown);
  const V half_z = hn::Add(weighted(spread + 6, boxes.half_x, boxes.half_y, boxes.half_z), grown);
  return {hn::Sub(x, half_x), hn::Add(x, half_x), hn::Sub(y, half_y),
          hn::Add(y, half_y), hn::Sub(z, half_z), hn::Add(z, half_z)};
}

/// Continuous pixel coordinates of the rectangle around the boxes' projections, guards included.
struct Rectangle {
  V u_low, u_high, v_low, v_high;
};

HWY_INLINE Rectangle project(const LocalCamera& camera, const Bounds& b, V z_low, V z_high) {
  const Floats d;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0F);
  const V by_low = hn::Div(one, z_low);
  const V by_high = hn::Div(one, z_high);
  const V fx = hn::Set(d, camera.fx);
  const V fy = hn::Set(d, camera.fy);
  const auto least = [&](V low) HWY_ATTR { return hn::Mul(low, hn::IfThenElse(hn::Lt(low, zero), by_low, by_high)); };
  const auto most = [&](V high) HWY_ATTR { return hn::Mul(high, hn::IfThenElse(hn::Lt(high, zero), by_high, by_low)); };
  return {hn::Add(hn::Mul(least(b.x_low), fx), hn::Set(d, camera.cx - camera.guard_px)),
          hn::Add(hn::Mul(most(b.x_high), fx), hn::Set(d, camera.cx + camera.guard_px)),
          hn::Add(hn::Mul(least(b.y_low), fy), hn::Set(d, camera.cy - camera.guard_px)),
          hn::Add(hn::Mul(most(b.y_high), fy), hn::Set(d, camera.cy + camera.guard_px))};
}

}  // namespace depthgrid::views::octants::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
