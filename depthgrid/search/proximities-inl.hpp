// Boxes and the axis of a primitive: how near, and whether the search may end there. Included once for each instruction
// set. Internal.
#if defined(DEPTHGRID_SEARCH_PROXIMITIES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_SEARCH_PROXIMITIES_INL
#undef DEPTHGRID_SEARCH_PROXIMITIES_INL
#else
#define DEPTHGRID_SEARCH_PROXIMITIES_INL
#endif

#include "depthgrid/search/boxes-inl.hpp"
#include "depthgrid/search/cube_split.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::HWY_NAMESPACE {

/// The axis and the boxes.
struct Proximities {
  V distance;  ///< no point of the box is nearer to the axis
  /// A point at that distance from the axis, towards the box's centre: where an answer of that distance may point to.
  V near_x, near_y, near_z;
};

HWY_INLINE Proximities proximities(const Axis& axis, const Boxes& boxes) {
  const Floats d;
  const V zero = hn::Zero(d);
  V px = hn::Set(d, axis.a[0]);
  V py = hn::Set(d, axis.a[1]);
  V pz = hn::Set(d, axis.a[2]);
  const bool segment = axis.inverse_square != 0;
  if (segment) {
    const V ax = hn::Sub(boxes.x, px);
    const V ay = hn::Sub(boxes.y, py);
    const V az = hn::Sub(boxes.z, pz);
    const V t0 = hn::Mul(weighted(axis.along.data(), ax, ay, az), hn::Set(d, axis.inverse_square));
    const V t = clamp(t0, zero, hn::Set(d, 1.0F));
    px = hn::Add(px, hn::Mul(t, hn::Set(d, axis.along[0])));
    py = hn::Add(py, hn::Mul(t, hn::Set(d, axis.along[1])));
    pz = hn::Add(pz, hn::Mul(t, hn::Set(d, axis.along[2])));
  }
  const V x = hn::Sub(boxes.x, px);
  const V y = hn::Sub(boxes.y, py);
  const V z = hn::Sub(boxes.z, pz);
  const V to_centre = length(x, y, z);
  Proximities result;
  if (segment) {
    // The ball around the box: another point of the axis may be nearer to the box than the one nearest to its centre.
    result.distance = hn::Max(hn::Sub(to_centre, boxes.half_diagonal), zero);
  } else {
    result.distance =
        length(hn::Max(hn::Sub(hn::Abs(x), boxes.half_x), zero), hn::Max(hn::Sub(hn::Abs(y), boxes.half_y), zero),
               hn::Max(hn::Sub(hn::Abs(z), boxes.half_z), zero));
  }
  const V share = hn::Div(result.distance, hn::Max(to_centre, hn::Set(d, 1e-9F)));
  result.near_x = hn::Add(px, hn::Mul(x, share));
  result.near_y = hn::Add(py, hn::Mul(y, share));
  result.near_z = hn::Add(pz, hn::Mul(z, share));
  return result;
}

/// Lanes around whose point a camera may have not known free space within slack and pose error: the point lies out of
/// its view, or its pixel or one of the three nearest to it begins to be not known free near enough. With t the tangent
/// of the angle between ray and optical axis, c its cosine and s the lateral distance to the pixel, a depth h beyond
/// the point is near enough on the worst side if (s + t h)^2 + h^2 <= slack^2, which is h <= c sqrt(slack^2 - s^2 c^2)
/// - s t c^2.
HWY_INLINE M touches(const LocalCamera& camera, V x_local, V y_local, V z_local, float slack_m) {
  const Floats d;
  const Ints di;
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0F);
  const V x = hn::Add(weighted(camera.rotation.data(), x_local, y_local, z_local), hn::Set(d, camera.offset_m[0]));
  const V y = hn::Add(weighted(camera.rotation.data() + 3, x_local, y_local, z_local), hn::Set(d, camera.offset_m[1]));
  const V z = hn::Add(weighted(camera.rotation.data() + 6, x_local, y_local, z_local), hn::Set(d, camera.offset_m[2]));
  const V range = length(x, y, z);
  V slack = hn::Set(d, slack_m);
  if (camera.has_pose_error) {
    slack =
        hn::Add(slack, hn::Add(hn::Set(d, camera.pose_error_m), hn::Mul(hn::Set(d, camera.pose_error_per_m), range)));
  }
  const V inverse = hn::Div(one, z);
  const V u = hn::Add(hn::Mul(hn::Mul(x, inverse), hn::Set(d, camera.fx)), hn::Set(d, camera.cx));
  const V v = hn::Add(hn::Mul(hn::Mul(y, inverse), hn::Set(d, camera.fy)), hn::Set(d, camera.cy));
  const M in_view = hn::And(hn::And(hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, camera.width))),
                                    hn::And(hn::Ge(v, zero), hn::Lt(v, hn::Set(d, camera.height)))),
                            hn::Gt(z, hn::Set(d, camera.blind_m)));
  const V inside_u = hn::IfThenElseZero(in_view, u);
  const V inside_v = hn::IfThenElseZero(in_view, v);
  const I column = hn::ConvertTo(di, inside_u);
  const I row = hn::ConvertTo(di, inside_v);
  const V part_u = hn::Sub(inside_u, hn::ConvertTo(d, column));
  const V part_v = hn::Sub(inside_v, hn::ConvertTo(d, row));
  // The neighbour on the nearer side; at the image's edge the pixel itself, which is no less true.
  const V half = hn::Set(d, 0.5F);
  const auto beside = [&](V coordinate, V part, float size) HWY_ATTR {
    const V next = hn::Add(coordinate, hn::IfThenElse(hn::Lt(part, half), hn::Neg(one), one));
    return hn::ConvertTo(di, clamp(next, zero, hn::Set(d, size - 1)));
  };
  const I column1 = beside(inside_u, part_u, camera.width);
  const I row1 = beside(inside_v, part_v, camera.height);
  const V side_u = hn::Mul(hn::Min(part_u, hn::Sub(one, part_u)), hn::Mul(z, hn::Set(d, 1.0F / camera.fx)));
  const V side_v = hn::Mul(hn::Min(part_v, hn::Sub(one, part_v)), hn::Mul(z, hn::Set(d, 1.0F / camera.fy)));
  const V cosine = hn::Div(z, range);
  const V square = hn::Mul(cosine, cosine);
  const V slant = hn::Sqrt(hn::Max(hn::Sub(one, square), zero));  // t c
  const auto reaches = [&](V free_m, V side) HWY_ATTR {
    const V rest = hn::Sub(hn::Mul(slack, slack), hn::Mul(hn::Mul(side, side), square));
    const V depth = hn::Sub(hn::Mul(cosine, hn::Sqrt(hn::Max(rest, zero))), hn::Mul(hn::Mul(side, slant), cosine));
    return hn::And(hn::Le(side, slack), hn::Le(free_m, hn::Add(z, hn::Max(depth, zero))));
  };
  const I width = hn::Set(di, camera.width_px);
  const I line0 = hn::Mul(row, width);
  const I line1 = hn::Mul(row1, width);
  const float* HWY_RESTRICT values = camera.free_m;
  const M own = reaches(hn::GatherIndex(d, values, hn::Add(line0, column)), zero);
  const M by_column = reaches(hn::GatherIndex(d, values, hn::Add(line0, column1)), side_u);
  const M by_row = reaches(hn::GatherIndex(d, values, hn::Add(line1, column)), side_v);
  return hn::Or(hn::Not(in_view), hn::Or(own, hn::Or(by_column, by_row)));
}

}  // namespace depthgrid::search::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
