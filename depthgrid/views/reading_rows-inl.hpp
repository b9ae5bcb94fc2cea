// What a pixel's stored value stands for, a vector at a time (see Reading). Included once for each instruction set.
// Internal.
#if defined(DEPTHGRID_VIEWS_READING_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_VIEWS_READING_ROWS_INL
#undef DEPTHGRID_VIEWS_READING_ROWS_INL
#else
#define DEPTHGRID_VIEWS_READING_ROWS_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "depthgrid/views/reading.hpp"
#include "depthgrid/views/vector_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {

using FewUnits = hn::Rebind<std::uint16_t, Floats>;
using Units = hn::CappedTag<std::uint16_t, 32>;

/// x (slope - curve x) - constant, see Reduction.
struct Reducer {
  HWY_INLINE explicit Reducer(const Reduction& reduction)
      : slope(hn::Set(Floats(), reduction.slope)),
        curve(hn::Set(Floats(), reduction.curve)),
        constant(hn::Set(Floats(), reduction.constant_m)),
        smallest(hn::Set(Floats(), kSmallestReduced)) {}
  HWY_INLINE V operator()(V x) const {
    const V reduced = hn::Sub(hn::Mul(x, hn::Sub(slope, hn::Mul(x, curve))), constant);
    return hn::IfThenElseZero(hn::Ge(reduced, smallest), reduced);
  }
  V slope, curve, constant, smallest;
};

/// Values of an image to codes, see Reading.
struct Decoder {
  HWY_INLINE explicit Decoder(const Reading& reading)
      : lowest(hn::Set(Units(), reading.lowest_code)),
        beyond(hn::Set(Units(), reading.beyond_code)),
        has_beyond(reading.has_beyond),
        invalid(reading.invalid_units.data()),
        invalid_count(reading.invalid_units.size()) {}
  HWY_INLINE hn::Vec<Units> operator()(hn::Vec<Units> u) const {
    for (std::size_t i = 0; i < invalid_count; ++i) {
      u = hn::IfThenZeroElse(hn::Eq(u, hn::Set(Units(), invalid[i])), u);
    }
    u = hn::IfThenElseZero(hn::Eq(hn::Max(u, lowest), u), u);
    u = hn::Min(u, beyond);
    return has_beyond ? u : hn::IfThenZeroElse(hn::Eq(u, beyond), u);
  }
  hn::Vec<Units> lowest, beyond;
  bool has_beyond;
  const std::uint16_t* invalid;
  std::size_t invalid_count;
};

/// Codes to the x that they stand for. kHasBeyond: Reading::has_beyond, or true where it is not known here.
template <bool kHasBeyond>
struct UnitReader {
  HWY_INLINE explicit UnitReader(const Reading& reading_in)
      : reading(reading_in),
        beyond_code(hn::Set(Floats(), static_cast<float>(reading.beyond_code))),
        beyond_value(hn::Set(Floats(), reading.beyond_value)) {}
  HWY_INLINE V operator()(hn::Vec<FewUnits> code) const {
    const V x = hn::ConvertTo(Floats(), hn::PromoteTo(Ints(), code));
    return kHasBeyond ? hn::IfThenElse(hn::Eq(x, beyond_code), beyond_value, x) : x;
  }
  /// Whether D <= limit for the depths D that they stand for. x metres_per_unit, rounded once or twice in whatever way,
  /// decides unless it is within the rounding of the limit.
  HWY_INLINE M at_most(hn::Vec<FewUnits> code, V limit_m) const {
    const Floats d;
    const V about_m = hn::Mul((*this)(code), hn::Set(d, static_cast<float>(reading.metres_per_unit)));
    const M surely = hn::Le(hn::Mul(about_m, hn::Set(d, 1.0F + 0x1p-20F)), limit_m);
    const M maybe = hn::Le(hn::Mul(about_m, hn::Set(d, 1.0F - 0x1p-20F)), limit_m);
    return hn::AllTrue(d, hn::Or(surely, hn::Not(maybe))) ? surely : hn::Le(depth(code), limit_m);
  }
  /// D, but for rounding.
  HWY_INLINE V about_m(hn::Vec<FewUnits> code) const {
    return hn::Mul((*this)(code), hn::Set(Floats(), static_cast<float>(reading.metres_per_unit)));
  }
  /// D, exactly.
  HWY_INLINE V depth(hn::Vec<FewUnits> code) const {
    const Floats d;
    const V x = hn::ConvertTo(d, hn::PromoteTo(Ints(), code));
    HWY_ALIGN VectorArray<float> values{};
    hn::Store(x, d, values.data());
    for (float& value : values) {
      value = static_cast<float>(static_cast<double>(value) * reading.metres_per_unit);
    }
    return hn::IfThenElse(hn::Eq(x, beyond_code), hn::Set(d, reading.beyond_m), hn::Load(d, values.data()));
  }
  const Reading& reading;
  V beyond_code, beyond_value;
};

/// Metres as they were stored, to measurements; 0 for none.
struct MetreReader {
  HWY_INLINE explicit MetreReader(const Reading& reading)
      : lowest(hn::Set(Floats(), reading.lowest_m)),
        highest(hn::Set(Floats(), reading.highest_m)),
        beyond_highest(hn::Set(Floats(), reading.beyond_highest_m)) {}
  HWY_INLINE V operator()(V x) const {
    // NaN fails the comparisons.
    const V from_low = hn::IfThenElseZero(hn::Ge(x, lowest), x);
    const V beyond = hn::IfThenElseZero(hn::Le(x, hn::Set(Floats(), kLargest)), beyond_highest);
    return hn::IfThenElse(hn::Gt(x, highest), beyond, from_low);
  }
  HWY_INLINE M at_most(V x, V limit_m) const { return hn::Le((*this)(x), limit_m); }
  HWY_INLINE V about_m(V x) const { return (*this)(x); }
  V lowest, highest, beyond_highest;
};

/// Keeps one row of 16-bit values, and makes codes of them. `ahead_bytes`: how far behind this row is the one to ask
/// for now.
HWY_INLINE void decode_row(const Reading& reading, const std::uint16_t* HWY_RESTRICT from, std::ptrdiff_t ahead_bytes,
                           int width_px, std::uint16_t* HWY_RESTRICT kept, std::uint16_t* HWY_RESTRICT codes) {
  const Units d;
  const Decoder decode(reading);
  for_columns({0, width_px}, lanes(d), [&](int u, const auto& part) HWY_ATTR {
    const auto read = part.load(d, from + u, std::uint16_t{0});
    part.stream(read, d, kept + u);
    ask_for(from + u, ahead_bytes);
    hn::StoreU(decode(read), d, codes + u);
  });
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
