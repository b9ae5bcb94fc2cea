// The eight children of a cube at once, or as many as the instruction set has lanes. Included once for each instruction
// set. Internal.
#if defined(DEPTHGRID_VIEWS_EIGHT_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_VIEWS_EIGHT_LANES_INL
#undef DEPTHGRID_VIEWS_EIGHT_LANES_INL
#else
#define DEPTHGRID_VIEWS_EIGHT_LANES_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>

#include "depthgrid/core/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::octants::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using lanes::HWY_NAMESPACE::clamp;
using lanes::HWY_NAMESPACE::length;
using lanes::HWY_NAMESPACE::weighted;

// No fused multiply-add anywhere: every instruction set gives the same bits.
using Floats = hn::CappedTag<float, 8>;
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
using M = hn::Mask<Floats>;

/// Where the children's centres lie from the parent's, in half sides of theirs.
alignas(64) constexpr std::array<float, 8> kSignX{-1, 1, -1, 1, -1, 1, -1, 1};
alignas(64) constexpr std::array<float, 8> kSignY{-1, -1, 1, 1, -1, -1, 1, 1};
alignas(64) constexpr std::array<float, 8> kSignZ{-1, -1, -1, -1, 1, 1, 1, 1};

/// Bit i of the result: lane i.
HWY_INLINE std::uint32_t bits_of(M mask) {
  const Floats d;
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, mask, bytes.data());
  return bytes[0];
}

/// A child's coordinate from its parent's.
HWY_INLINE V child_centre(float parent, const float* HWY_RESTRICT signs, V half) {
  const Floats d;
  return hn::Add(hn::Set(d, parent), hn::Mul(hn::Load(d, signs), half));
}

}  // namespace depthgrid::views::octants::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
