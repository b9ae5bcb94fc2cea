#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "depthgrid/memory/carving.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/memory/voxels_seen.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: they must be seen once for each target.
#include "depthgrid/views/known_free-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::memory::HWY_NAMESPACE {

using namespace views::octants::HWY_NAMESPACE;

/// Windows of an image, one a lane, and the planes of each.
struct Planes {
  V x, y, z_near, z_far, nearest, farthest;
};

/// Of the smallest windows that hold these rectangles of pixels. Lanes that are not asked do not make them larger.
HWY_INLINE Planes planes_of(const Carver& carver, M asked, const Rectangle& r) {
  const Floats d;
  const Ints di;
  const V zero = hn::Zero(d);
  const auto pixel = [&](V at, float size) HWY_ATTR {
    return hn::ConvertTo(di, hn::IfThenElseZero(asked, clamp(at, zero, hn::Set(d, size - 1))));
  };
  const I u0 = pixel(r.u_low, carver.camera.width);
  const I u1 = pixel(r.u_high, carver.camera.width);
  const I v0 = pixel(r.v_low, carver.camera.height);
  const I v1 = pixel(r.v_high, carver.camera.height);
  const std::int32_t last = hn::GetLane(hn::MaxOfLanes(di, hn::Max(hn::Sub(u1, u0), hn::Sub(v1, v0))));
  const DepthPlanes& planes = *carver.planes;
  std::size_t n = 0;
  while (n + 1 < planes.level_count() && last > (DepthPlanes::kTiles - 1) << planes.levels()[n].shift) {
    ++n;
  }
  const DepthPlanes::Level& level = planes.levels()[n];
  const I i = hn::Min(hn::ShiftRightSame(u0, level.shift), hn::Set(di, level.width - DepthPlanes::kTiles));
  const I j = hn::Min(hn::ShiftRightSame(v0, level.shift), hn::Set(di, level.height - DepthPlanes::kTiles));
  const I at = hn::Add(hn::Set(di, level.offset), hn::Add(hn::Mul(j, hn::Set(di, level.width)), i));
  return {hn::GatherIndex(d, planes.x(), at),       hn::GatherIndex(d, planes.y(), at),
          hn::GatherIndex(d, planes.z_near(), at),  hn::GatherIndex(d, planes.z_far(), at),
          hn::GatherIndex(d, planes.nearest(), at), hn::GatherIndex(d, planes.farthest(), at)};
}

/// More than single precision takes in the distance of a point from a plane, at most range_m from the camera.
HWY_INLINE V guard_of(const Carver& carver, V range_m) {
  const Floats d;
  return hn::Add(hn::Set(d, 2 * carver.camera.guard_m), hn::Mul(range_m, hn::Set(d, 3e-5F)));
}

/// The planes through the camera's centre that bound its image, and the end of its blind zone: how far a point lies
/// within, weighted(row, p) - beyond.
constexpr std::size_t kBorders = 5;
struct Border {
  std::array<float, 3> row;
  float beyond;
};
HWY_INLINE std::array<Border, kBorders> borders_of(const views::LocalCamera& camera) {
  const auto side = [](float f, float from, float sign, bool along_u) {
    const float by = sign / std::sqrt(1 + (from / f) * (from / f));
    return along_u ? Border{{by, 0, -from / f * by}, 0} : Border{{0, by, -from / f * by}, 0};
  };
  return {side(camera.fx, -camera.cx, 1, true), side(camera.fx, camera.width - camera.cx, -1, true),
          side(camera.fy, -camera.cy, 1, false), side(camera.fy, camera.height - camera.cy, -1, false),
          // The robot may be seen in the blind zone.
          Border{{0, 0, 1}, camera.has_islands ? 0.0F : static_cast<float>(camera.near_m)}};
}

/// A number for each voxel of a block, linear in its place: which are above a limit.
struct Slope {
  float first, x, y, z;
};
HWY_INLINE Block above(const Slope& slope, float limit) {
  const lanes::HWY_NAMESPACE::Floats d;
  const lanes::HWY_NAMESPACE::Ints di;
  constexpr std::size_t kLayer = 16;
  Block result = 0;
  for (std::size_t first = 0; first < kLayer; first += hn::Lanes(d)) {
    const auto place = hn::Iota(di, static_cast<std::int32_t>(first));
    const auto x = hn::ConvertTo(d, hn::And(place, hn::Set(di, 3)));
    const auto y = hn::ConvertTo(d, hn::ShiftRight<2>(place));
    auto value =
        hn::Add(hn::Set(d, slope.first), hn::Add(hn::Mul(x, hn::Set(d, slope.x)), hn::Mul(y, hn::Set(d, slope.y))));
    for (std::size_t z = 0; z < 4; ++z) {
      result |= static_cast<Block>(lanes::HWY_NAMESPACE::bits_of(hn::Gt(value, hn::Set(d, limit))))
                << (kLayer * z + first);
      value = hn::Add(value, hn::Set(d, slope.z));
    }
  }
  return result;
}

/// Of the plane row . p, for the block whose middle has this value.
HWY_INLINE Slope slope_in_block(const views::LocalCamera& camera, float voxel_m, const std::array<float, 3>& row,
                                float middle) {
  std::array<float, 3> along{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    along[axis] = voxel_m * (row[0] * camera.rotation[axis] + row[1] * camera.rotation[3 + axis] +
                             row[2] * camera.rotation[6 + axis]);
  }
  return {middle - 1.5F * (along[0] + along[1] + along[2]), along[0], along[1], along[2]};
}

/// Where the voxels of a block are in the camera's frame, a layer at a time.
using Places = std::array<Slope, 3>;
struct Layer {
  lanes::HWY_NAMESPACE::V x, y, z;
};
HWY_INLINE Layer layer_of(const Places& places, std::size_t first, std::size_t layer) {
  const lanes::HWY_NAMESPACE::Floats d;
  const lanes::HWY_NAMESPACE::Ints di;
  const auto place = hn::Iota(di, static_cast<std::int32_t>(first));
  const auto i = hn::ConvertTo(d, hn::And(place, hn::Set(di, 3)));
  const auto j = hn::ConvertTo(d, hn::ShiftRight<2>(place));
  const auto k = static_cast<float>(layer);
  const auto at = [&](const Slope& slope) HWY_ATTR {
    return hn::Add(hn::Set(d, slope.first + k * slope.z),
                   hn::Add(hn::Mul(i, hn::Set(d, slope.x)), hn::Mul(j, hn::Set(d, slope.y))));
  };
  return {at(places[0]), at(places[1]), at(places[2])};
}

/// Those voxels of a block for which ask(layer) holds; only of layers with some of `asked` in them.
template <class Ask>
HWY_INLINE Block each_layer(const Places& places, Block asked, Ask&& ask) {
  const lanes::HWY_NAMESPACE::Floats d;
  constexpr std::size_t kLayer = 16;
  Block result = 0;
  for (std::size_t at = 0; at < 4 * kLayer; at += hn::Lanes(d)) {
    if (((asked >> at) & ((1U << hn::Lanes(d)) - 1U)) != 0) {
      const Layer layer = layer_of(places, at % kLayer, at / kLayer);
      result |= static_cast<Block>(lanes::HWY_NAMESPACE::bits_of(ask(layer))) << at;
    }
  }
  return result;
}

/// Voxels that are not free because what is behind their centres is not, as far as every ball reaches. `least_m` and
/// `range_m`: no ball is smaller, and no centre farther.
HWY_INLINE Block centre_shows_not_free(const views::LocalCamera& camera, const Places& places, Block asked,
                                       float least_m, float range_m) {
  const lanes::HWY_NAMESPACE::Floats d;
  const lanes::HWY_NAMESPACE::Ints di;
  const auto zero = hn::Zero(d);
  const auto behind = hn::Set(d, 1 + 0.99F * least_m / range_m);
  const auto width = hn::Set(d, camera.width);
  const auto height = hn::Set(d, camera.height);
  return each_layer(places, asked, [&](const Layer& p) HWY_ATTR {
    const auto by_z = hn::Div(hn::Set(d, 1.0F), p.z);
    const auto u = hn::Add(hn::Mul(hn::Mul(p.x, by_z), hn::Set(d, camera.fx)), hn::Set(d, camera.cx));
    const auto v = hn::Add(hn::Mul(hn::Mul(p.y, by_z), hn::Set(d, camera.fy)), hn::Set(d, camera.cy));
    const auto inside =
        hn::And(hn::And(hn::Ge(u, zero), hn::Lt(u, width)), hn::And(hn::Ge(v, zero), hn::Lt(v, height)));
    const auto at = hn::Add(hn::Mul(hn::ConvertTo(di, hn::IfThenElseZero(inside, v)), hn::Set(di, camera.width_px)),
                            hn::ConvertTo(di, hn::IfThenElseZero(inside, u)));
    auto free_m = hn::GatherIndex(d, camera.free_m, at);
    if (camera.has_islands) {
      free_m = hn::Max(free_m, hn::GatherIndex(d, camera.image->island_far_m.data(), at));
    }
    return hn::And(inside, hn::Lt(free_m, hn::Mul(p.z, behind)));
  });
}

/// Voxels that are free as far as the rectangle of pixels tells that their balls project to: balls that lie in front
/// of the camera and inside of its image, none larger than most_m.
HWY_INLINE Block rectangle_shows_free(const views::LocalCamera& camera, const Places& places, Block asked,
                                      float most_m) {
  const lanes::HWY_NAMESPACE::Floats d;
  const lanes::HWY_NAMESPACE::Ints di;
  const auto zero = hn::Zero(d);
  const auto grown = hn::Set(d, most_m);
  const auto square = hn::Mul(grown, grown);
  return each_layer(places, asked, [&](const Layer& p) HWY_ATTR {
    // Tangents from the camera's centre.
    const auto by = hn::Div(hn::Set(d, 1.0F), hn::Max(hn::Sub(hn::Mul(p.z, p.z), square), hn::Set(d, 1e-9F)));
    const auto pixels = [&](auto x, float f, float c, float size, auto& low, auto& high) HWY_ATTR {
      const auto rest = hn::Max(hn::Sub(hn::Add(hn::Mul(x, x), hn::Mul(p.z, p.z)), square), zero);
      const auto root = hn::Mul(grown, hn::Sqrt(rest));
      const auto product = hn::Mul(x, p.z);
      const auto scale = hn::Mul(hn::Set(d, f), by);
      const auto last = hn::Set(d, size - 1);
      const auto at = [&](auto value, float guard) HWY_ATTR {
        return hn::ConvertTo(di, clamp(hn::Add(hn::Mul(value, scale), hn::Set(d, c + guard)), zero, last));
      };
      low = at(hn::Sub(product, root), -2 * camera.guard_px);
      high = at(hn::Add(product, root), 2 * camera.guard_px);
    };
    lanes::HWY_NAMESPACE::I u0, u1, v0, v1;  // NOLINT(*-isolate-declaration, *-init-variables): written at once
    pixels(p.x, camera.fx, camera.cx, camera.width, u0, u1);
    pixels(p.y, camera.fy, camera.cy, camera.height, v0, v1);
    const auto last =
        static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(di, hn::Max(hn::Sub(u1, u0), hn::Sub(v1, v0)))));
    // Three texels of a level, of which each begins 2^level after the one before and is four times as wide, cover 10
    // 2^level + 1 pixels wherever they begin.
    const std::size_t level =
        std::min(1 + static_cast<std::size_t>(std::bit_width(last / 10)), static_cast<std::size_t>(camera.level_count));
    const views::Texels& texels = camera.texels[level];
    const float* HWY_RESTRICT values = camera.minima_m + texels.offset;
    const auto width = hn::Set(di, texels.width);
    const auto back = hn::Set(di, 3);
    const auto four = hn::Set(di, 4);
    const auto i0 = hn::ShiftRightSame(u0, texels.shift);
    const auto j0 = hn::ShiftRightSame(v0, texels.shift);
    const auto i2 = hn::Max(i0, hn::Sub(hn::ShiftRightSame(u1, texels.shift), back));
    const auto j2 = hn::Max(j0, hn::Sub(hn::ShiftRightSame(v1, texels.shift), back));
    const auto i1 = hn::Min(hn::Add(i0, four), i2);
    const auto far_end = hn::Add(p.z, grown);
    auto all = hn::Eq(zero, zero);
    for (const auto j : {j0, hn::Min(hn::Add(j0, four), j2), j2}) {
      const auto row = hn::Mul(j, width);
      const auto free_m =
          hn::Min(hn::Min(hn::GatherIndex(d, values, hn::Add(row, i0)), hn::GatherIndex(d, values, hn::Add(row, i1))),
                  hn::GatherIndex(d, values, hn::Add(row, i2)));
      all = hn::And(all, hn::Lt(far_end, free_m));
      if (hn::AllFalse(d, all)) {
        break;
      }
    }
    return all;
  });
}

/// Voxels that are not free because one pixel's middle is not: no ball is smaller than least_m.
HWY_INLINE Block pixel_shows_not_free(const views::LocalCamera& camera, const Places& places, Block asked,
                                      float least_m, int u, int v, float free_m) {
  const lanes::HWY_NAMESPACE::Floats d;
  const float right = (static_cast<float>(u) + 0.5F - camera.cx) / camera.fx;
  const float down = (static_cast<float>(v) + 0.5F - camera.cy) / camera.fy;
  const float by_square = 1 / (1 + right * right + down * down);
  const auto square = hn::Set(d, least_m * least_m);
  const auto x = hn::Set(d, right);
  const auto y = hn::Set(d, down);
  return each_layer(places, asked, [&](const Layer& p) HWY_ATTR {
    // The depth at which the ray is nearest.
    const auto along = hn::Mul(hn::Add(hn::Add(hn::Mul(p.x, x), hn::Mul(p.y, y)), p.z), hn::Set(d, by_square));
    const auto depth = hn::Max(along, hn::Set(d, free_m));
    const auto away = [](auto value) HWY_ATTR { return hn::Mul(value, value); };
    const auto sum = hn::Add(hn::Add(away(hn::Sub(p.x, hn::Mul(depth, x))), away(hn::Sub(p.y, hn::Mul(depth, y)))),
                             away(hn::Sub(p.z, depth)));
    return hn::Lt(sum, square);
  });
}

/// What the pixels say of one ball; of one that is not free, the pixel that says so.
struct PixelsSay {
  bool is_free = false;
  bool is_not_free = false;
  int u = 0, v = 0;
  float free_m = 0;
};

/// A ball in front of the camera and inside of its image. Pixels that are free as far as its far end do not touch it.
/// Of the others the ray through the middle is asked how near it comes behind what it has free: nearer than least_m,
/// and the ball is not free; farther than most_m and half a pixel more, and the pixel does not touch it.
HWY_INLINE PixelsSay look_at_pixels(const views::LocalCamera& camera, float x, float y, float z, float least_m,
                                    float most_m) {
  const lanes::HWY_NAMESPACE::Floats d;
  const views::PreparedImage& image = *camera.image;
  const int width = camera.width_px;
  const int height = image.free_m.height_px();
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const int end = width * height - lanes;
  const float square = most_m * most_m;
  const float by = 1 / (z * z - square);
  const auto pixels = [&](float a, float f, float c, int size, int& low, int& high) {
    const float root = most_m * std::sqrt(std::max(a * a + z * z - square, 0.0F));
    const auto at = [&](float value, float guard) {
      return static_cast<int>(std::clamp(value * f * by + (c + guard), 0.0F, static_cast<float>(size - 1)));
    };
    low = at(a * z - root, -2 * camera.guard_px);
    high = at(a * z + root, 2 * camera.guard_px);
  };
  int first_u = 0;
  int last_u = 0;
  int first_v = 0;
  int last_v = 0;
  pixels(x, camera.fx, camera.cx, width, first_u, last_u);
  pixels(y, camera.fy, camera.cy, height, first_v, last_v);
  const float by_fx = 1 / camera.fx;
  const float by_fy = 1 / camera.fy;
  const float half_pixel_m = 0.7072F * (z + most_m) * std::max(by_fx, by_fy);
  const auto far_end = hn::Set(d, z + most_m);
  const auto touching = hn::Set(d, least_m * least_m);
  const auto clear = hn::Set(d, (most_m + half_pixel_m) * (most_m + half_pixel_m));
  const auto first_column = hn::Set(d, static_cast<float>(first_u));
  const auto last_column = hn::Set(d, static_cast<float>(last_u));
  constexpr float kInPixel = 0.01F;
  const auto u_ball = hn::Set(d, x / z * camera.fx + camera.cx);
  const float v_ball = y / z * camera.fy + camera.cy;
  const auto x_ball = hn::Set(d, x);
  const auto y_ball = hn::Set(d, y);
  const auto z_ball = hn::Set(d, z);
  PixelsSay result;
  bool is_clear = true;
  // From the middle outwards: what is found there says more of other balls.
  const int middle = (first_v + last_v) / 2;
  const int rows = last_v - first_v + 1;
  for (int n = 0; n < rows; ++n) {
    const int row = middle + ((n & 1) != 0 ? (n + 1) / 2 : -(n / 2));
    for (int column = first_u; column <= last_u; column += lanes) {
      const int at = std::min(row * width + column, end);
      const auto free_m = hn::LoadU(d, camera.free_m + at);
      auto near = hn::Le(free_m, far_end);
      if (hn::AllFalse(d, near)) {
        continue;
      }
      const auto columns = hn::Iota(d, static_cast<float>(at - row * width));
      const float top = static_cast<float>(row);
      near = hn::And(near, hn::And(hn::Ge(columns, first_column), hn::Le(columns, last_column)));
      if (hn::AllFalse(d, near)) {
        continue;
      }
      auto most_free_m = free_m;
      if (camera.has_islands) {
        most_free_m = hn::Max(most_free_m, hn::LoadU(d, image.island_far_m.data() + at));
      }
      const auto distance = [&](auto u, float v, auto from_m) HWY_ATTR {
        const auto right = hn::Mul(hn::Sub(u, hn::Set(d, camera.cx)), hn::Set(d, by_fx));
        const auto down = hn::Set(d, (v - camera.cy) * by_fy);
        const auto along = hn::Div(hn::Add(hn::Add(hn::Mul(right, x_ball), hn::Mul(down, y_ball)), z_ball),
                                   hn::Add(hn::Add(hn::Mul(right, right), hn::Mul(down, down)), hn::Set(d, 1.0F)));
        const auto depth = hn::Max(along, from_m);
        const auto off_x = hn::Sub(x_ball, hn::Mul(depth, right));
        const auto off_y = hn::Sub(y_ball, hn::Mul(depth, down));
        const auto off_z = hn::Sub(z_ball, depth);
        return hn::Add(hn::Add(hn::Mul(off_x, off_x), hn::Mul(off_y, off_y)), hn::Mul(off_z, off_z));
      };
      const auto nearest_u =
          hn::Min(hn::Max(u_ball, hn::Add(columns, hn::Set(d, kInPixel))), hn::Add(columns, hn::Set(d, 1 - kInPixel)));
      const float nearest_v = std::min(std::max(v_ball, top + kInPixel), top + 1 - kInPixel);
      const auto found = hn::And(near, hn::Lt(distance(nearest_u, nearest_v, most_free_m), touching));
      if (!hn::AllFalse(d, found)) {
        const auto lane = std::countr_zero(lanes::HWY_NAMESPACE::bits_of(found));
        result.is_not_free = true;
        result.u = at - row * width + lane;
        result.v = row;
        result.free_m = camera.free_m[at + lane];
        if (camera.has_islands) {
          result.free_m = std::max(result.free_m, image.island_far_m.data()[at + lane]);
        }
        return result;
      }
      is_clear = is_clear &&
                 hn::AllFalse(
                     d, hn::And(near, hn::Le(distance(hn::Add(columns, hn::Set(d, 0.5F)), top + 0.5F, free_m), clear)));
    }
  }
  result.is_free = is_clear;
  return result;
}

/// Voxel by voxel, all whose balls lie in front of the camera and inside of its image: what is not free is taken from
/// `open`, and what is from it, too, and returned.
HWY_INLINE Block look_at_voxels(const views::LocalCamera& camera, const Places& places, float least_m, float most_m,
                                Block& open) {
  Block freed = rectangle_shows_free(camera, places, open, most_m) & open;
  open &= ~freed;
  Block undecided = 0;
  while (open != 0) {
    const int bit = std::countr_zero(open);
    const auto at = [&](const Slope& slope) {
      return slope.first + static_cast<float>(bit & 3) * slope.x + static_cast<float>((bit >> 2) & 3) * slope.y +
             static_cast<float>(bit >> 4) * slope.z;
    };
    const PixelsSay said = look_at_pixels(camera, at(places[0]), at(places[1]), at(places[2]), least_m, most_m);
    open &= ~(Block{1} << bit);
    if (said.is_not_free) {
      open &= ~pixel_shows_not_free(camera, places, open, least_m, said.u, said.v, said.free_m);
    } else if (said.is_free) {
      freed |= Block{1} << bit;
    } else {
      undecided |= Block{1} << bit;
    }
  }
  open = undecided;
  return freed;
}

/// Up to eight blocks.
struct EightBlocks {
  alignas(64) std::array<float, 8> x, y, z, near_limit, far_limit, plane_x, plane_y,
      plane_near, plane_far, least, most, near_z, far_z, range;
};

std::int64_t look_at_row(const Carver& carver, const BlockRow& row) {
  const Floats d;
  const views::LocalCamera& camera = carver.camera;
  const std::array<Border, kBorders> borders = borders_of(camera);
  const float half_m = 1.5F * row.voxel_m;
  const V half = hn::Set(d, half_m);
  const V diagonal = hn::Set(d, 1.7320509F * half_m);
  std::int64_t removed = 0;
  EightBlocks eight;
  for (std::size_t begin = 0; begin < row.count; begin += hn::Lanes(d)) {
    const std::size_t count = std::min(row.count - begin, hn::Lanes(d));
    std::uint32_t here = 0;
    for (std::size_t i = 0; i < count; ++i) {
      here |= row.voxels[begin + i] != 0 ? 1U << i : 0U;
      row.open[begin + i] = 0;
    }
    if (here == 0) {
      continue;
    }
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(here)};
    M asked = hn::LoadMaskBits(d, bytes.data());
    const V x_local =
        hn::Add(hn::Set(d, row.x_m), hn::Mul(hn::Iota(d, static_cast<float>(begin)), hn::Set(d, 4 * row.voxel_m)));
    const V y_local = hn::Set(d, row.y_m);
    const V z_local = hn::Set(d, row.z_m);
    const auto in_camera = [&](std::size_t n) HWY_ATTR {
      return hn::Add(weighted(camera.rotation.data() + 3 * n, x_local, y_local, z_local),
                     hn::Set(d, camera.offset_m[n]));
    };
    const V x = in_camera(0);
    const V y = in_camera(1);
    const V z = in_camera(2);
    const V range = length(x, y, z);
    const V far_range = hn::Add(range, diagonal);
    const V guard = guard_of(carver, far_range);
    const V per_m = hn::Set(d, camera.pose_error_per_m);
    // No ball is larger, and none smaller.
    const V most = hn::Add(hn::Add(hn::Set(d, camera.pose_error_m), hn::Mul(per_m, far_range)), guard);
    const V least = hn::Sub(
        hn::Add(hn::Set(d, carver.least_radius_m), hn::Mul(per_m, hn::Max(hn::Sub(range, diagonal), hn::Zero(d)))),
        guard);
    const float* HWY_RESTRICT rotation = camera.rotation.data();
    const auto extent = [&](V a, V b, V c) HWY_ATTR {
      V sum = hn::Zero(d);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sum = hn::Add(
            sum,
            hn::Abs(hn::Add(hn::Add(hn::Mul(a, hn::Set(d, rotation[axis])), hn::Mul(b, hn::Set(d, rotation[3 + axis]))),
                            hn::Mul(c, hn::Set(d, rotation[6 + axis])))));
      }
      return hn::Mul(sum, half);
    };
    M inside = asked;
    M none = hn::AndNot(asked, asked);
    for (const Border& border : borders) {
      const V within = hn::Sub(weighted(border.row.data(), x, y, z), hn::Set(d, border.beyond));
      const V spread = extent(hn::Set(d, border.row[0]), hn::Set(d, border.row[1]), hn::Set(d, border.row[2]));
      inside = hn::And(inside, hn::Gt(hn::Sub(within, spread), most));
      none = hn::Or(none, hn::Lt(hn::Add(within, spread), least));
    }
    asked = hn::AndNot(none, asked);
    if (hn::AllFalse(d, asked)) {
      continue;
    }
    const float* HWY_RESTRICT spread = camera.absolute_rotation.data();
    const auto grown = [&](std::size_t n)
                           HWY_ATTR { return hn::Add(weighted(spread + 3 * n, half, half, half), most); };
    const Bounds b{hn::Sub(x, grown(0)), hn::Add(x, grown(0)), hn::Sub(y, grown(1)),
                   hn::Add(y, grown(1)), hn::Sub(z, grown(2)), hn::Add(z, grown(2))};
    const V before = hn::Set(d, std::max(camera.blind_m, 2e-3F));
    const M in_front = hn::And(asked, hn::Gt(b.z_low, before));
    inside = hn::And(inside, in_front);
    const Planes planes =
        planes_of(carver, in_front, project(camera, b, hn::Max(b.z_low, before), hn::Max(b.z_high, before)));
    const V one = hn::Set(d, 1.0F);
    const V across = hn::Add(hn::Mul(planes.x, x), hn::Mul(planes.y, y));
    const V at_near = hn::Add(across, hn::Mul(planes.z_near, z));
    const V at_far = hn::Add(across, hn::Mul(planes.z_far, z));
    const V near_limit = hn::Sub(one, hn::Mul(length(planes.x, planes.y, planes.z_near), most));
    const V far_limit = hn::Sub(one, hn::Mul(length(planes.x, planes.y, planes.z_far), least));
    const V near_z = hn::Sub(hn::Div(one, planes.nearest), most);
    const V far_z = hn::Sub(hn::Div(one, planes.farthest), least);
    const V deep = extent(hn::Zero(d), hn::Zero(d), one);
    const M free =
        hn::And(inside, hn::Or(hn::Lt(hn::Add(at_near, extent(planes.x, planes.y, planes.z_near)), near_limit),
                               hn::Lt(hn::Add(z, deep), near_z)));
    const M behind =
        hn::And(in_front, hn::Or(hn::Gt(hn::Sub(at_far, extent(planes.x, planes.y, planes.z_far)), far_limit),
                                 hn::Gt(hn::Sub(z, deep), far_z)));
    for (std::uint32_t rest = bits_of(free); rest != 0; rest &= rest - 1) {
      Block& voxels = row.voxels[begin + static_cast<std::size_t>(std::countr_zero(rest))];
      removed += std::popcount(voxels);
      voxels = 0;
    }
    const std::uint32_t split = bits_of(hn::AndNot(hn::Or(free, behind), asked));
    if (split == 0) {
      continue;
    }
    const std::uint32_t is_inside = bits_of(inside);
    const std::uint32_t is_in_front = bits_of(in_front);
    hn::Store(x, d, eight.x.data());
    hn::Store(y, d, eight.y.data());
    hn::Store(z, d, eight.z.data());
    hn::Store(at_near, d, eight.plane_near.data());
    hn::Store(at_far, d, eight.plane_far.data());
    hn::Store(near_limit, d, eight.near_limit.data());
    hn::Store(far_limit, d, eight.far_limit.data());
    hn::Store(planes.x, d, eight.plane_x.data());
    hn::Store(planes.y, d, eight.plane_y.data());
    hn::Store(least, d, eight.least.data());
    hn::Store(most, d, eight.most.data());
    alignas(64) std::array<float, 8> z_near;
    alignas(64) std::array<float, 8> z_far;
    hn::Store(far_range, d, eight.range.data());
    hn::Store(near_z, d, eight.near_z.data());
    hn::Store(far_z, d, eight.far_z.data());
    hn::Store(planes.z_near, d, z_near.data());
    hn::Store(planes.z_far, d, z_far.data());
    for (std::uint32_t rest = split; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      Block& voxels = row.voxels[begin + i];
      Block freed = 0;
      Block open = voxels;
      Block within = kWholeBlock;
      if (((is_inside >> i) & 1U) == 0) {
        for (const Border& border : borders) {
          const float middle =
              border.row[0] * eight.x[i] + border.row[1] * eight.y[i] + border.row[2] * eight.z[i] - border.beyond;
          const Slope slope = slope_in_block(camera, row.voxel_m, border.row, middle);
          within &= above(slope, eight.most[i]);
          open &= above(slope, eight.least[i]);
        }
      }
      if (((is_in_front >> i) & 1U) != 0) {
        const Places places{slope_in_block(camera, row.voxel_m, {1, 0, 0}, eight.x[i]),
                            slope_in_block(camera, row.voxel_m, {0, 1, 0}, eight.y[i]),
                            slope_in_block(camera, row.voxel_m, {0, 0, 1}, eight.z[i])};
        open &= ~above(places[2], eight.far_z[i]);
        open &= ~above(
            slope_in_block(camera, row.voxel_m, {eight.plane_x[i], eight.plane_y[i], z_far[i]}, eight.plane_far[i]),
            eight.far_limit[i]);
        freed = ~above(places[2], eight.near_z[i]);
        freed |= ~above(
            slope_in_block(camera, row.voxel_m, {eight.plane_x[i], eight.plane_y[i], z_near[i]}, eight.plane_near[i]),
            eight.near_limit[i]);
        freed &= within & open;
        open &= ~freed;
        if (open != 0) {
          open &= ~centre_shows_not_free(camera, places, open, eight.least[i], eight.range[i]);
        }
        Block rest_inside = open & within;
        open &= ~rest_inside;
        if (rest_inside != 0) {
          freed |= look_at_voxels(camera, places, eight.least[i], eight.most[i], rest_inside);
        }
        open |= rest_inside;
      }
      freed &= voxels;
      removed += std::popcount(freed);
      voxels &= ~freed;
      row.open[begin + i] = open & ~freed;
    }
  }
  return removed;
}

}  // namespace depthgrid::memory::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::memory {

HWY_EXPORT(look_at_row);

std::int64_t see_row(const Carver& carver, const BlockRow& row) noexcept {
  return HWY_DYNAMIC_DISPATCH(look_at_row)(carver, row);
}

}  // namespace depthgrid::memory
#endif
