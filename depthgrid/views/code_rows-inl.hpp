// The minimum filter over 16-bit codes, for margins that ascend. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_VIEWS_CODE_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_VIEWS_CODE_ROWS_INL
#undef DEPTHGRID_VIEWS_CODE_ROWS_INL
#else
#define DEPTHGRID_VIEWS_CODE_ROWS_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "depthgrid/views/reading_rows-inl.hpp"
#include "depthgrid/views/vector_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {

/// Minima of codes along the row. kRadius is w, or 0 where it is not known here.
template <int kRadius>
HWY_INLINE void narrow_minimum(const std::uint16_t* HWY_RESTRICT codes, int width_px, int radius_if_unknown,
                               std::uint16_t* HWY_RESTRICT minimum) {
  const Units d;
  const int radius_px = kRadius > 0 ? kRadius : radius_if_unknown;
  // A few columns more: zeros that windows read.
  for (int u = 0; u < width_px + 4; u += lanes(d)) {
    auto smallest = hn::Min(hn::LoadU(d, codes + u - radius_px), hn::LoadU(d, codes + u + radius_px));
    for (int k = 1 - radius_px; k < radius_px; ++k) {
      smallest = hn::Min(smallest, hn::LoadU(d, codes + u + k));
    }
    hn::StoreU(smallest, d, minimum + u);
  }
}

/// Minima of those of four columns: with w >= 1 the neighbourhoods of the first and the last cover those between.
HWY_INLINE void narrow_window(const std::uint16_t* HWY_RESTRICT minimum, int width_px,
                              std::uint16_t* HWY_RESTRICT window) {
  const Units d;
  for (int u = 0; u < width_px; u += lanes(d)) {
    hn::StoreU(hn::Min(hn::LoadU(d, minimum + u), hn::LoadU(d, minimum + u + 3)), d, window + u);
  }
}

/// Converts codes, which may reach behind the row, and stores what belongs to it.
template <bool kHasBeyond>
struct CodeConverter {
  HWY_INLINE explicit CodeConverter(const Reading& reading) : read(reading), reduced(reading.of_units) {}
  HWY_INLINE void operator()(hn::Vec<Units> codes, int count, float* result_m) const {
    const Floats d;
#if HWY_TARGET == HWY_SCALAR
    store_some(reduced(read(codes)), d, result_m, count);
#else
    const int n = lanes(d);
    const V lower = reduced(read(hn::LowerHalf(codes)));
    const V upper = reduced(read(hn::UpperHalf(hn::Half<Units>(), codes)));
    if (count >= 2 * n) {
      hn::StoreU(lower, d, result_m);
      hn::StoreU(upper, d, result_m + n);
    } else {
      store_some(lower, d, result_m, count);
      store_some(upper, d, result_m + n, count - n);
    }
#endif
  }
  UnitReader<kHasBeyond> read;
  Reducer reduced;
};

/// The reduced depths of the minima of the rows 0 to count - 1, each column for itself, and of the rows 1 to count. A
/// null result is left out. kCount is the count, or 0 where it is not known here.
template <int kCount, bool kHasBeyond>
HWY_INLINE void narrow_columns(const Reading& reading, const std::uint16_t* const* rows, int count_if_unknown,
                               const PixelRange& columns, float* HWY_RESTRICT first, float* HWY_RESTRICT second) {
  const Units d;
  const CodeConverter<kHasBeyond> convert(reading);
  const int count = kCount > 0 ? kCount : count_if_unknown;
  const auto minimum = [&](int row, int end, int u) HWY_ATTR {
    auto smallest = hn::LoadU(d, rows[row] + u);
    for (++row; row < end; ++row) {
      smallest = hn::Min(smallest, hn::LoadU(d, rows[row] + u));
    }
    return smallest;
  };
  if (first == nullptr || second == nullptr) {
    float* only = first != nullptr ? first : second;
    const int row = first != nullptr ? 0 : 1;
    for (int u = columns.begin; u < columns.end && only != nullptr; u += lanes(d)) {
      convert(minimum(row, row + count, u), columns.end - u, only + u);
    }
    return;
  }
  const std::ptrdiff_t pair_bytes = 2 * (second - first) * static_cast<std::ptrdiff_t>(sizeof(float));
  for (int u = columns.begin; u < columns.end; u += lanes(d)) {
    constexpr int kCacheLine = 64 / sizeof(float);
    for (int i = 0; i < lanes(d); i += kCacheLine) {
      ask_for(first + u + i, pair_bytes);
      ask_for(second + u + i, pair_bytes);
    }
    const auto shared = minimum(1, count, u);
    convert(hn::Min(shared, hn::LoadU(d, rows[0] + u)), columns.end - u, first + u);
    convert(hn::Min(shared, hn::LoadU(d, rows[count] + u)), columns.end - u, second + u);
  }
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
