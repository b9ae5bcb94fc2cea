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

/// Minima down the columns: of the rows 0 to 2 w, and of the rows 1 to 2 w + 1. kRadius is w, or 0 where it is not
/// known here.
template <int kRadius>
HWY_INLINE void narrow_minima(const std::uint16_t* const* rows, int width_px, int radius_if_unknown,
                              std::uint16_t* HWY_RESTRICT first, std::uint16_t* HWY_RESTRICT second) {
  const Units d;
  const int last = 2 * (kRadius > 0 ? kRadius : radius_if_unknown) + 1;
  for (int u = 0; u < width_px; u += lanes(d)) {
    auto shared = hn::LoadU(d, rows[1] + u);
    for (int row = 2; row < last; ++row) {
      shared = hn::Min(shared, hn::LoadU(d, rows[row] + u));
    }
    hn::StoreU(hn::Min(shared, hn::LoadU(d, rows[0] + u)), d, first + u);
    hn::StoreU(hn::Min(shared, hn::LoadU(d, rows[last] + u)), d, second + u);
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

/// Brings the second row below this one near, which is written soon: as many columns as one vector of codes has.
HWY_INLINE void ask_for_pair(const float* row, int width_px) {
  constexpr int kCacheLine = 64 / sizeof(float);
  for (int i = 0; i < lanes(Units()); i += kCacheLine) {
    ask_for(row + i, 2 * std::ptrdiff_t{width_px} * static_cast<std::ptrdiff_t>(sizeof(float)));
  }
}

/// g of one row, and its codes: minima of each column's minimum and w to both sides. kRadius is w, or 0 where it is not
/// known here.
template <int kRadius, class Converter>
HWY_INLINE void free_of_codes(const Converter& convert, const std::uint16_t* HWY_RESTRICT minimum,
                              int radius_if_unknown, const PixelRange& columns, int width_px,
                              std::uint16_t* HWY_RESTRICT codes, float* HWY_RESTRICT free_m) {
  const Units d;
  const int radius_px = kRadius > 0 ? kRadius : radius_if_unknown;
  for (int u = columns.begin; u < columns.end; u += lanes(d)) {
    ask_for_pair(free_m + u, width_px);
    auto smallest = hn::Min(hn::LoadU(d, minimum + u - radius_px), hn::LoadU(d, minimum + u + radius_px));
    for (int k = 1 - radius_px; k < radius_px; ++k) {
      smallest = hn::Min(smallest, hn::LoadU(d, minimum + u + k));
    }
    hn::StoreU(smallest, d, codes + u);
    convert(smallest, columns.end - u, free_m + u);
  }
}

/// Some of a row of level 0 from the codes of g of this row and of the third below it. With w >= 1, and no robot, the
/// neighbourhoods of a texel's corners cover those of all its pixels.
template <class Converter>
HWY_INLINE void texels_of_codes(const Converter& convert, const std::uint16_t* HWY_RESTRICT upper,
                                const std::uint16_t* HWY_RESTRICT lower, const PixelRange& columns, int width_px,
                                float* HWY_RESTRICT texels) {
  const Units d;
  for (int u = columns.begin; u < columns.end; u += lanes(d)) {
    ask_for_pair(texels + u, width_px);
    const auto left = hn::Min(hn::LoadU(d, upper + u), hn::LoadU(d, lower + u));
    const auto right = hn::Min(hn::LoadU(d, upper + u + 3), hn::LoadU(d, lower + u + 3));
    convert(hn::Min(left, right), columns.end - u, texels + u);
  }
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
