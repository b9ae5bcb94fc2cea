// Sixteen numbers at once, or as many as the instruction set has. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_CORE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_CORE_LANES_INL
#undef DEPTHGRID_CORE_LANES_INL
#else
#define DEPTHGRID_CORE_LANES_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace depthgrid::lanes::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// No fused multiply-add anywhere: every instruction set gives the same bits.
using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
using M = hn::Mask<Floats>;

/// Bit i of the result: lane i.
HWY_INLINE std::uint32_t bits_of(M mask) {
  const Floats d;
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, mask, bytes.data());
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8U;
}

// Of any number of lanes.

/// A row of a matrix times (x, y, z).
template <class W>
HWY_INLINE W weighted(const float* HWY_RESTRICT row, W x, W y, W z) {
  const hn::DFromV<W> d;
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, row[0]), x), hn::Mul(hn::Set(d, row[1]), y)),
                 hn::Mul(hn::Set(d, row[2]), z));
}

template <class W>
HWY_INLINE W length(W x, W y, W z) {
  return hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
}

template <class W>
HWY_INLINE W clamp(W x, W low, W high) {
  return hn::Min(hn::Max(x, low), high);
}

}  // namespace depthgrid::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
