#include "depthgrid/memory/readings_outside.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/memory/readings_outside.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: it must be seen once for each target.
#include "depthgrid/core/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::memory::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

std::size_t find_outside(const RowOfReadings& row, const VoxelSet& voxels, ReadingOutside* to) {
  // Blocks are looked up, so that there are no more lanes than of those.
  const hn::CappedTag<std::uint64_t, 8> blocks;
  const hn::Rebind<float, decltype(blocks)> d;
  const hn::Rebind<std::int32_t, decltype(blocks)> di;
  const hn::RebindToSigned<decltype(blocks)> indices;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d);
  const std::array<int, 3>& count = voxels.voxels();
  const auto blocks_x = hn::Set(di, voxels.blocks(0)[0]);
  const auto blocks_y = hn::Set(di, voxels.blocks(0)[1]);
  const Block* HWY_RESTRICT bits = voxels.voxel_blocks().data();
  const auto strides = hn::Mul(hn::Iota(di, 0), hn::Set(di, row.stride));
  const auto three = hn::Set(di, 3);
  alignas(64) std::array<std::int32_t, 8> found_x;  // NOLINT(*-member-init): written before it is read
  alignas(64) std::array<std::int32_t, 8> found_y;  // NOLINT(*-member-init): as well
  alignas(64) std::array<std::int32_t, 8> found_z;  // NOLINT(*-member-init): as well
  std::size_t size = 0;
  for (int u = row.begin; u < row.end; u += lanes * row.stride) {
    const auto wanted = hn::Add(hn::Set(di, u), strides);
    const auto asked = hn::RebindMask(d, hn::Lt(wanted, hn::Set(di, row.end)));
    const auto pixels = hn::Min(wanted, hn::Set(di, row.end - 1));
    const auto depth_m = row.stride == 1 && u + lanes <= row.end ? hn::LoadU(d, row.depth_m + u)
                                                                 : hn::GatherIndex(d, row.depth_m, pixels);
    const auto column = hn::ConvertTo(d, pixels);
    const auto place = [&](std::size_t axis) HWY_ATTR {
      const auto slope = hn::Add(hn::Set(d, row.first[axis]), hn::Mul(column, hn::Set(d, row.step[axis])));
      return hn::Add(hn::Set(d, row.origin[axis]), hn::Mul(depth_m, slope));
    };
    const auto x = place(0);
    const auto y = place(1);
    const auto z = place(2);
    const auto is_between = [&](auto value, int end) HWY_ATTR {
      return hn::And(hn::Ge(value, zero), hn::Lt(value, hn::Set(d, static_cast<float>(end))));
    };
    const auto inside = hn::And(hn::And(hn::And(asked, hn::Gt(depth_m, zero)), is_between(x, count[0])),
                                hn::And(is_between(y, count[1]), is_between(z, count[2])));
    if (hn::AllFalse(d, inside)) {
      continue;
    }
    const auto i = hn::ConvertTo(di, hn::IfThenElseZero(inside, x));
    const auto j = hn::ConvertTo(di, hn::IfThenElseZero(inside, y));
    const auto k = hn::ConvertTo(di, hn::IfThenElseZero(inside, z));
    const auto block =
        hn::Add(hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<2>(k), blocks_y), hn::ShiftRight<2>(j)), blocks_x),
                hn::ShiftRight<2>(i));
    const auto bit =
        hn::Add(hn::Add(hn::And(i, three), hn::ShiftLeft<2>(hn::And(j, three))), hn::ShiftLeft<4>(hn::And(k, three)));
    const auto set = hn::GatherIndex(blocks, bits, hn::PromoteTo(indices, block));
    const auto here = hn::Shr(set, hn::BitCast(blocks, hn::PromoteTo(indices, bit)));
    const auto is_outside = hn::Eq(hn::And(here, hn::Set(blocks, 1)), hn::Zero(blocks));
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(d, inside, bytes.data());
    std::uint32_t rest = bytes[0];
    hn::StoreMaskBits(blocks, is_outside, bytes.data());
    rest &= bytes[0];
    if (rest == 0) {
      continue;
    }
    hn::Store(i, di, found_x.data());
    hn::Store(j, di, found_y.data());
    hn::Store(k, di, found_z.data());
    for (; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      to[size++] = {u + static_cast<std::int32_t>(lane) * row.stride, found_x[lane], found_y[lane], found_z[lane]};
    }
  }
  return size;
}

}  // namespace depthgrid::memory::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::memory {

HWY_EXPORT(find_outside);

std::size_t readings_outside(const RowOfReadings& row, const VoxelSet& voxels, ReadingOutside* to) noexcept {
  return HWY_DYNAMIC_DISPATCH(find_outside)(row, voxels, to);
}

}  // namespace depthgrid::memory
#endif
