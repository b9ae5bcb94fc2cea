// Numbers that are linear in place, for the voxels of a block. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_MEMORY_BLOCK_VOXELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_MEMORY_BLOCK_VOXELS_INL
#undef DEPTHGRID_MEMORY_BLOCK_VOXELS_INL
#else
#define DEPTHGRID_MEMORY_BLOCK_VOXELS_INL
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include "depthgrid/memory/voxel_set.hpp"
#include "depthgrid/views/boxes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::memory::HWY_NAMESPACE {

using namespace views::octants::HWY_NAMESPACE;

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
/// One of them.
struct Place {
  float x, y, z;
};
HWY_INLINE Place place_of(const Places& places, int voxel) {
  const auto at = [&](const Slope& slope) {
    return slope.first + static_cast<float>(voxel & 3) * slope.x + static_cast<float>((voxel >> 2) & 3) * slope.y +
           static_cast<float>(voxel >> 4) * slope.z;
  };
  return {at(places[0]), at(places[1]), at(places[2])};
}

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

}  // namespace depthgrid::memory::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
