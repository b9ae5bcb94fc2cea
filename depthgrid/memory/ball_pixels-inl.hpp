// What pixels say of balls around the voxels of a block. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_MEMORY_BALL_PIXELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_MEMORY_BALL_PIXELS_INL
#undef DEPTHGRID_MEMORY_BALL_PIXELS_INL
#else
#define DEPTHGRID_MEMORY_BALL_PIXELS_INL
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "depthgrid/memory/block_voxels-inl.hpp"
#include "depthgrid/memory/blocking_pixels.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::memory::HWY_NAMESPACE {

using namespace views::octants::HWY_NAMESPACE;

/// More than is rounded off a sum of a few products, in terms of the largest.
constexpr float kRoundedOff = 2e-6F;
/// A ray that is asked stays so far within its pixel.
constexpr float kInPixel = 0.01F;

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
  const auto square = hn::Set(d, std::max(least_m, 0.0F) * std::max(least_m, 0.0F));
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

/// Voxels that are not free because the pixel is not that showed it last.
HWY_INLINE Block blocking_pixels_show_not_free(const views::LocalCamera& camera, const Places& places, Block asked,
                                               float least_m, const std::int16_t* HWY_RESTRICT offsets) {
  const lanes::HWY_NAMESPACE::Floats d;
  const lanes::HWY_NAMESPACE::Ints di;
  const hn::Rebind<std::int16_t, lanes::HWY_NAMESPACE::Floats> narrow;
  const auto one = hn::Set(d, 1.0F);
  const auto zero = hn::Zero(d);
  const auto zero_px = hn::Zero(di);
  const auto last_u = hn::Set(di, camera.width_px - 1);
  const auto last_v = hn::Set(di, camera.image->free_m.height_px() - 1);
  const auto square = hn::Set(d, std::max(least_m, 0.0F) * std::max(least_m, 0.0F));
  const auto in_pixel = hn::Set(d, kInPixel);
  const auto to_end = hn::Set(d, 1 - kInPixel);
  constexpr std::size_t kLayer = 16;
  Block result = 0;
  for (std::size_t at = 0; at < BlockingPixels::kVoxels; at += hn::Lanes(d)) {
    if (((asked >> at) & ((1U << hn::Lanes(d)) - 1U)) == 0) {
      continue;
    }
    const Layer p = layer_of(places, at % kLayer, at / kLayer);
    const auto by_z = hn::Div(one, p.z);
    const auto u_ball = hn::Add(hn::Mul(hn::Mul(p.x, by_z), hn::Set(d, camera.fx)), hn::Set(d, camera.cx));
    const auto v_ball = hn::Add(hn::Mul(hn::Mul(p.y, by_z), hn::Set(d, camera.fy)), hn::Set(d, camera.cy));
    const auto offset = hn::PromoteTo(di, hn::LoadU(narrow, offsets + at));
    const auto columns = hn::ShiftRight<24>(hn::ShiftLeft<24>(offset));
    const auto rows = hn::ShiftRight<8>(hn::Sub(offset, columns));
    const auto pixel = [&](auto middle, float size, auto away, auto last) HWY_ATTR {
      const auto from = hn::ConvertTo(di, clamp(middle, zero, hn::Set(d, size)));
      return hn::Min(hn::Max(hn::Add(from, away), zero_px), last);
    };
    const auto u = pixel(u_ball, camera.width, columns, last_u);
    const auto v = pixel(v_ball, camera.height, rows, last_v);
    const auto index = hn::Add(hn::Mul(v, hn::Set(di, camera.width_px)), u);
    auto free_m = hn::GatherIndex(d, camera.free_m, index);
    if (camera.has_islands) {
      free_m = hn::Max(free_m, hn::GatherIndex(d, camera.image->island_far_m.data(), index));
    }
    const auto slope = [&](auto middle, auto begin, float c, float f) HWY_ATTR {
      const auto nearest = clamp(middle, hn::Add(begin, in_pixel), hn::Add(begin, to_end));
      return hn::Mul(hn::Sub(nearest, hn::Set(d, c)), hn::Set(d, 1 / f));
    };
    const auto right = slope(u_ball, hn::ConvertTo(d, u), camera.cx, camera.fx);
    const auto down = slope(v_ball, hn::ConvertTo(d, v), camera.cy, camera.fy);
    const auto along = hn::Div(hn::Add(hn::Add(hn::Mul(right, p.x), hn::Mul(down, p.y)), p.z),
                               hn::Add(hn::Add(hn::Mul(right, right), hn::Mul(down, down)), one));
    const auto depth = hn::Max(along, free_m);
    const auto away = [](auto value) HWY_ATTR { return hn::Mul(value, value); };
    const auto sum =
        hn::Add(hn::Add(away(hn::Sub(p.x, hn::Mul(depth, right))), away(hn::Sub(p.y, hn::Mul(depth, down)))),
                away(hn::Sub(p.z, depth)));
    result |= static_cast<Block>(lanes::HWY_NAMESPACE::bits_of(hn::Lt(sum, square))) << at;
  }
  return result;
}

/// What the pixels say of one ball; of one that is not free, the pixel that says so.
struct PixelsSay {
  bool is_free = false;
  bool is_not_free = false;
  int u = 0, v = 0;
  float free_m = 0;
};

/// How near a ray comes to a point behind a depth, against two distances, without a division. With p . q of the ray
/// q = (right, down, 1), it is nearest at the depth p . q / q^2, where its square distance is p^2 - (p . q)^2 / q^2.
struct Approach {
  lanes::HWY_NAMESPACE::V along, square, begin;  ///< p . q, q^2, and q^2 times the depth from which on it counts

  /// Whether its square distance is below p^2 - rest.
  [[nodiscard]] HWY_INLINE lanes::HWY_NAMESPACE::M is_within(lanes::HWY_NAMESPACE::V from_m, float rest) const {
    const lanes::HWY_NAMESPACE::Floats d;
    const auto limit = hn::Set(d, rest);
    const auto at_foot = hn::Gt(hn::Mul(along, along), hn::Mul(limit, square));
    const auto at_begin = hn::Gt(hn::Mul(from_m, hn::Sub(hn::Add(along, along), begin)), limit);
    return hn::Or(hn::And(hn::Gt(along, begin), at_foot), hn::AndNot(hn::Gt(along, begin), at_begin));
  }
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
  if (width < lanes) {
    return {};  // left to the exact test
  }
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
  const float range = x * x + y * y + z * z;
  const float nearest = std::max(least_m, 0.0F);
  const float farthest = most_m + half_pixel_m;
  const float rest_touching = range * (1 + kRoundedOff) - nearest * nearest;
  const float rest_clear = range * (1 - kRoundedOff) - farthest * farthest;
  const auto u_ball = hn::Set(d, x / z * camera.fx + camera.cx);
  const float v_ball = y / z * camera.fy + camera.cy;
  const auto x_ball = hn::Set(d, x);
  const auto in_pixel = hn::Set(d, kInPixel);
  const auto to_end = hn::Set(d, 1 - kInPixel);
  PixelsSay result;
  auto unclear = hn::Lt(far_end, far_end);  // none so far
  // From the middle outwards: what is found there says more of other balls.
  const int middle = (first_v + last_v) / 2;
  const int rows = last_v - first_v + 1;
  for (int first = first_u; first <= last_u; first += lanes) {
    const int column = std::min(first, width - lanes);
    const auto columns = hn::Iota(d, static_cast<float>(column));
    const auto asked = hn::And(hn::Ge(columns, hn::Set(d, static_cast<float>(first))),
                               hn::Le(columns, hn::Set(d, static_cast<float>(last_u))));
    const auto slope = [&](auto u) HWY_ATTR { return hn::Mul(hn::Sub(u, hn::Set(d, camera.cx)), hn::Set(d, by_fx)); };
    const auto right_nearest = slope(clamp(u_ball, hn::Add(columns, in_pixel), hn::Add(columns, to_end)));
    const auto right_middle = slope(hn::Add(columns, hn::Set(d, 0.5F)));
    const auto along_nearest = hn::Mul(right_nearest, x_ball);
    const auto along_middle = hn::Mul(right_middle, x_ball);
    const auto square_nearest = hn::Mul(right_nearest, right_nearest);
    const auto square_middle = hn::Mul(right_middle, right_middle);
    for (int n = 0; n < rows; ++n) {
      const int row = middle + ((n & 1) != 0 ? (n + 1) / 2 : -(n / 2));
      const int at = row * width + column;
      const auto free_m = hn::LoadU(d, camera.free_m + at);
      const auto near = hn::And(asked, hn::Le(free_m, far_end));
      if (hn::AllFalse(d, near)) {
        continue;
      }
      auto most_free_m = free_m;
      if (camera.has_islands) {
        most_free_m = hn::Max(most_free_m, hn::LoadU(d, image.island_far_m.data() + at));
      }
      const auto approach = [&](auto along, auto right_square, float v, auto from_m) HWY_ATTR {
        const float down = (v - camera.cy) * by_fy;
        const auto ray_square = hn::Add(right_square, hn::Set(d, down * down + 1));
        return Approach{hn::Add(along, hn::Set(d, y * down + z)), ray_square, hn::Mul(ray_square, from_m)};
      };
      const auto top = static_cast<float>(row);
      const float v_nearest = std::min(std::max(v_ball, top + kInPixel), top + 1 - kInPixel);
      const auto found = hn::And(
          near, approach(along_nearest, square_nearest, v_nearest, most_free_m).is_within(most_free_m, rest_touching));
      unclear = hn::Or(
          unclear,
          hn::And(near, approach(along_middle, square_middle, top + 0.5F, free_m).is_within(free_m, rest_clear)));
      if (!hn::AllFalse(d, found)) {
        const auto lane = std::countr_zero(lanes::HWY_NAMESPACE::bits_of(found));
        result.is_not_free = true;
        result.u = column + lane;
        result.v = row;
        result.free_m = camera.free_m[at + lane];
        if (camera.has_islands) {
          result.free_m = std::max(result.free_m, image.island_far_m.data()[at + lane]);
        }
        return result;
      }
    }
  }
  result.is_free = hn::AllFalse(d, unclear);
  return result;
}

/// Voxel by voxel, all whose balls lie in front of the camera and inside of its image: what is not free is taken from
/// `open`, and what is from it, too, and returned.
HWY_INLINE Block look_at_voxels(const views::LocalCamera& camera, const Places& places, float least_m, float most_m,
                                std::int16_t* blocking, Block& open) {
  open &= ~blocking_pixels_show_not_free(camera, places, open, least_m, blocking);
  if (open == 0) {
    return 0;
  }
  Block freed = rectangle_shows_free(camera, places, open, most_m) & open;
  open &= ~freed;
  Block undecided = 0;
  while (open != 0) {
    const int bit = std::countr_zero(open);
    const Place p = place_of(places, bit);
    const PixelsSay said = look_at_pixels(camera, p.x, p.y, p.z, least_m, most_m);
    open &= ~(Block{1} << bit);
    if (said.is_not_free) {
      const Block others = pixel_shows_not_free(camera, places, open, least_m, said.u, said.v, said.free_m) & open;
      open &= ~others;
      for (Block rest = others | Block{1} << bit; rest != 0; rest &= rest - 1) {
        const int voxel = std::countr_zero(rest);
        const Place q = place_of(places, voxel);
        blocking[voxel] = BlockingPixels::offset(said.u - static_cast<int>(q.x / q.z * camera.fx + camera.cx),
                                                 said.v - static_cast<int>(q.y / q.z * camera.fy + camera.cy));
      }
    } else if (said.is_free) {
      freed |= Block{1} << bit;
    } else {
      undecided |= Block{1} << bit;
    }
  }
  open = undecided;
  return freed;
}

}  // namespace depthgrid::memory::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
