#include "depthgrid/search/image_preparation.hpp"

#include <cstring>

#include "depthgrid/search/pyramid_rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/image_preparation.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: seen once for each target.
#include <hwy/highway.h>

#include "depthgrid/search/vector_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::HWY_NAMESPACE {

using Ints = hn::RebindToSigned<Floats>;
using FewUnits = hn::Rebind<std::uint16_t, Floats>;
using Units = hn::CappedTag<std::uint16_t, 32>;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr int kCacheLine = 64 / sizeof(float);
constexpr int kLargestReach = 16;  ///< as validate() of SensorMargin has it

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

template <class Value>
HWY_INLINE Value* pixel_row(Value* pixels, int width_px, int v) {
  return pixels + std::ptrdiff_t{width_px} * v;
}

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
  /// D, exactly.
  HWY_INLINE V depth(hn::Vec<FewUnits> code) const {
    const Floats d;
    const V x = hn::ConvertTo(d, hn::PromoteTo(Ints(), code));
    HWY_ALIGN float values[HWY_MAX_BYTES / sizeof(float)];
    hn::Store(x, d, values);
    for (int i = 0; i < lanes(d); ++i) {
      values[i] = static_cast<float>(static_cast<double>(values[i]) * reading.metres_per_unit);
    }
    return hn::IfThenElse(hn::Eq(x, beyond_code), hn::Set(d, reading.beyond_m), hn::Load(d, values));
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
  V lowest, highest, beyond_highest;
};

/// Keeps one row of 16-bit values, and makes codes of them. `ahead_bytes`: how far behind this row is the
/// one to ask for now.
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

/// Minima of codes along the row. kReach is w, or 0 where it is not known here.
template <int kReach>
HWY_INLINE void narrow_minimum(const std::uint16_t* HWY_RESTRICT codes, int width_px, int reach_if_unknown,
                               std::uint16_t* HWY_RESTRICT minimum) {
  const Units d;
  const int reach_px = kReach > 0 ? kReach : reach_if_unknown;
  // A few columns more: zeros that windows read.
  for (int u = 0; u < width_px + 4; u += lanes(d)) {
    auto smallest = hn::Min(hn::LoadU(d, codes + u - reach_px), hn::LoadU(d, codes + u + reach_px));
    for (int k = 1 - reach_px; k < reach_px; ++k) {
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
    for (int i = 0; i < lanes(d); i += kCacheLine) {
      ask_for(first + u + i, pair_bytes);
      ask_for(second + u + i, pair_bytes);
    }
    const auto shared = minimum(1, count, u);
    convert(hn::Min(shared, hn::LoadU(d, rows[0] + u)), columns.end - u, first + u);
    convert(hn::Min(shared, hn::LoadU(d, rows[count] + u)), columns.end - u, second + u);
  }
}

/// Where a row shows the robot.
HWY_INLINE PixelRange robot_columns(const NewImage& image, int v) {
  const Floats d;
  constexpr int kStep = FloatColumns::kStep;
  const int width_px = image.depth.width_px;
  const float* near_m = image.robot.near_m + image.robot.stride_px * v;
  const float* far_m = image.robot.far_m + image.robot.stride_px * v;
  const std::ptrdiff_t ahead_bytes = 4 * image.robot.stride_px * static_cast<std::ptrdiff_t>(sizeof(float));
  int first = width_px;
  int last = -1;
  for_columns({0, width_px}, lanes(d), [&](int u, const auto& part) HWY_ATTR {
    ask_for(near_m + u, ahead_bytes);
    if (!hn::AllFalse(d, hn::Gt(part.load(d, near_m + u, 0.0F), hn::Zero(d)))) {
      ask_for(far_m + u, 0);
      first = std::min(first, u);
      last = u + lanes(d) - 1;
    }
  });
  return last < 0 ? PixelRange{} : PixelRange{first / kStep * kStep, std::min((last / kStep + 1) * kStep, width_px)};
}

/// Reduced depths of one row: D - m(D), or the robot's exit where the reading lies in the robot. `values` are codes or
/// metres.
template <class Reader, class D>
HWY_INLINE void reduce_row(D d_values, const Reader& reader, const Reduction& reduction, const NewImage& image, int v,
                           const hn::TFromD<D>* values, const PixelRange& columns, PreparationRows& rows) {
  const Floats d;
  const int width_px = image.depth.width_px;
  const bool robot_here = image.robot.near_m != nullptr && !rows.columns.robot(v).empty();
  const float* near_m = robot_here ? image.robot.near_m + image.robot.stride_px * v : nullptr;
  const float* far_m = robot_here ? image.robot.far_m + image.robot.stride_px * v : nullptr;
  float* reduced_m = rows.reduced_m();
  const Reducer reduced(reduction);
  const V pocket = hn::Set(d, image.pocket_m);
  const V pocket_rounding = hn::Set(d, image.pocket_m > 0 ? 1.0F - 0x1p-23F : 1.0F);
  const V largest = hn::Set(d, kLargest);
  for_columns(columns, lanes(d), [&](int u, const auto& part) HWY_ATTR {
    const auto value = part.load(d_values, values + u, hn::TFromD<D>{0});
    V result = reduced(reader(value));
    if (robot_here) {
      const V near = part.load(d, near_m + u, 0.0F);
      const M in_front = hn::And(hn::Gt(near, hn::Zero(d)), hn::Le(near, result));
      if (!hn::AllFalse(d, in_front)) {
        const V far = part.load(d, far_m + u, 0.0F);
        const V exit = hn::Min(hn::Mul(hn::Add(far, pocket), pocket_rounding), largest);
        const M inside = hn::And(reader.at_most(value, far), hn::Le(far, largest));
        result = hn::IfThenElse(hn::And(in_front, inside), hn::Max(exit, far), result);
      }
    }
    hn::StoreU(result, d, reduced_m + u);
  });
  if (columns.end == width_px) {
    std::fill_n(reduced_m + width_px, image.reach_px, 0.0F);
  }
}

/// Minima over the 2 w + 1 neighbours in the row.
template <int kReach>
HWY_INLINE void filter_row(const float* HWY_RESTRICT reduced_m, const PixelRange& columns, int reach_if_unknown,
                           float* HWY_RESTRICT minimum_m) {
  const Floats d;
  const int reach_px = kReach > 0 ? kReach : reach_if_unknown;
  for (int u = columns.begin; u < columns.end; u += lanes(d)) {
    V smallest = hn::LoadU(d, reduced_m + u - reach_px);
    for (int k = 1 - reach_px; k <= reach_px; ++k) {
      smallest = hn::Min(smallest, hn::LoadU(d, reduced_m + u + k));
    }
    hn::StoreU(smallest, d, minimum_m + u);
  }
}

/// g of one row from the minima of the rows around it. kReach is w, or 0 where it is not known here.
template <int kReach>
HWY_INLINE void filter_columns(PreparationRows& rows, const PixelRange& columns, int reach_if_unknown, int v,
                               float* HWY_RESTRICT free_m) {
  const Floats d;
  const int reach_px = kReach > 0 ? kReach : reach_if_unknown;
  const float* around[2 * kLargestReach + 1];
  for (int i = 0; i <= 2 * reach_px; ++i) {
    around[i] = rows.minimum_m(v - reach_px + i);
  }
  for_columns(columns, lanes(d), [&](int u, const auto& part) HWY_ATTR {
    V smallest = hn::LoadU(d, around[0] + u);
    for (int i = 1; i <= 2 * reach_px; ++i) {
      smallest = hn::Min(smallest, hn::LoadU(d, around[i] + u));
    }
    part.store(smallest, d, free_m + u);
  });
}

/// Frees one row of g up to the robot's exits where the robot begins in free space; where it does not, it is an island.
HWY_INLINE bool join_robot(const NewImage& image, int v, const PixelRange& columns, const PreparedImage& result,
                           float* free_row_m) {
  const Floats d;
  const int n = lanes(d);
  const int width_px = image.depth.width_px;
  const float* near_m = image.robot.near_m + image.robot.stride_px * v;
  const float* far_m = image.robot.far_m + image.robot.stride_px * v;
  PixelRange islands;
  for (int u = columns.begin; u < columns.end; u += n) {
    const int count = width_px - u;
    const V near = load_some(d, near_m + u, count, 0.0F);
    const V far = load_some(d, far_m + u, count, 0.0F);
    const V free = load_some(d, free_row_m + u, count, 0.0F);
    // An interval that is not finite, or whose ends are swapped, holds nothing.
    const M robot = hn::And(hn::And(hn::Gt(near, hn::Zero(d)), hn::Le(near, far)), hn::Le(far, hn::Set(d, kLargest)));
    const M begins_free = hn::And(robot, hn::Le(near, free));
    store_some(hn::IfThenElse(begins_free, hn::Max(free, far), free), d, free_row_m + u, count);
    const M island = hn::And(robot, hn::Gt(near, free));
    if (!hn::AllFalse(d, island)) {
      ask_for(pixel_row(result.island_near_m, width_px, v + 2) + u, 0);
      ask_for(pixel_row(result.island_far_m, width_px, v + 2) + u, 0);
      store_some(hn::IfThenElse(island, near, hn::Set(d, kInf)), d, pixel_row(result.island_near_m, width_px, v) + u,
                 count);
      store_some(hn::IfThenElse(island, far, hn::Set(d, -kInf)), d, pixel_row(result.island_far_m, width_px, v) + u,
                 count);
      islands = joined(islands, {u, std::min(u + n, width_px)});
    }
  }
  result.island_columns[static_cast<std::size_t>(v)] = islands;
  return !islands.empty();
}

/// One row of level 0 from the windows of four rows.
HWY_INLINE void first_level_row(PreparationRows& rows, const PixelRange& columns, int j, float* HWY_RESTRICT texels) {
  const Floats d;
  const float* HWY_RESTRICT row0 = rows.window_m(j);
  const float* HWY_RESTRICT row1 = rows.window_m(j + 1);
  const float* HWY_RESTRICT row2 = rows.window_m(j + 2);
  const float* HWY_RESTRICT row3 = rows.window_m(j + 3);
  for (int u = columns.begin; u < columns.end; u += lanes(d)) {
    const V upper = hn::Min(hn::LoadU(d, row0 + u), hn::LoadU(d, row1 + u));
    const V lower = hn::Min(hn::LoadU(d, row2 + u), hn::LoadU(d, row3 + u));
    store_some(hn::Min(upper, lower), d, texels + u, columns.end - u);
  }
}

/// The passes over one image. Rows are taken in as soon as the next ones need them. kReach is w, or 0 where it is not
/// known here.
template <bool kUnits, int kReach>
class Passes {
 public:
  HWY_INLINE Passes(const Reading& reading, const NewImage& image, PreparationRows& rows, const PreparedImage& result)
      : reading_(reading),
        image_(image),
        rows_(rows),
        result_(result),
        width_px_(image.depth.width_px),
        height_px_(image.depth.height_px),
        narrow_(kUnits && reading.ascending && image.reach_px > 0) {}

  HWY_INLINE PixelRange run() {
    rows_.columns.begin(!narrow_);
    PixelRange island_rows;
    int next = 0;
    int searched = 0;
    // Level 0 lags behind by three rows, whose texels cover the rows below them.
    for (int v = 0; v < height_px_ + 3; v += 2) {
      const int end = std::min(v + 2 + image_.reach_px, height_px_);
      for (; image_.robot.near_m != nullptr && searched < std::min(end + rows_.columns.lookahead(), height_px_);
           ++searched) {
        rows_.columns.add_robot(searched, robot_columns(image_, searched));
      }
      take(next, end);
      next = end;
      if (v < height_px_) {
        island_rows = joined(island_rows, free_rows(v));
      }
      first_level(v - 3);
    }
    return island_rows;
  }

 private:
  /// Rows [begin, end) of the image. One pass over all of them after the other: a pass that reads what the one before
  /// has just written, but at other columns, waits until it has reached the cache.
  HWY_INLINE void take(int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const char* source = static_cast<const char*>(image_.depth.data) + image_.depth.stride_bytes * v;
      if constexpr (kUnits) {
        decode_row(reading_, reinterpret_cast<const std::uint16_t*>(source), 2 * image_.depth.stride_bytes, width_px_,
                   pixel_row(static_cast<std::uint16_t*>(result_.kept), width_px_, v), rows_.codes(v));
      } else {
        std::memcpy(pixel_row(static_cast<float*>(result_.kept), width_px_, v), source,
                    static_cast<std::size_t>(width_px_) * sizeof(float));
      }
    }
    for (int v = begin; v < end && narrow_; ++v) {
      narrow_minimum<kReach>(rows_.codes(v), width_px_, image_.reach_px, rows_.narrow_minimum(v));
    }
    for (int v = begin; v < end && narrow_; ++v) {
      narrow_window(rows_.narrow_minimum(v), width_px_, rows_.narrow_window(v));
    }
    for (int v = begin; v < end; ++v) {
      const PixelRange reduced = rows_.columns.reduced(v);
      if (reduced.empty()) {
        continue;
      }
      if constexpr (kUnits) {
        reduce_row(FewUnits(), UnitReader<true>(reading_), reading_.of_units, image_, v, rows_.codes(v), reduced,
                   rows_);
      } else {
        reduce_row(Floats(), MetreReader(reading_), reading_.of_metres, image_, v,
                   pixel_row(static_cast<const float*>(result_.kept), width_px_, v), reduced, rows_);
      }
      filter_row<kReach>(rows_.reduced_m(), rows_.columns.filtered(v), image_.reach_px, rows_.minimum_m(v));
    }
  }

  /// The rows v and v + 1 of a result, where they exist, from minima of codes; what is done in single precision is left
  /// out if both rows have it.
  template <int kCount, class RowOf, class FloatColumnsOf>
  HWY_INLINE void from_codes(const RowOf& row_of, int v, int reach_below, float* pixels,
                             const FloatColumnsOf& in_floats) {
    const auto exists = [&](int row) { return row >= 0 && row < height_px_; };
    const auto floats = [&](int row) { return exists(row) ? in_floats(row) : PixelRange{0, width_px_}; };
    const auto result = [&](int row) { return exists(row) ? pixel_row(pixels, width_px_, row) : nullptr; };
    const int count = 2 * image_.reach_px + 1 + reach_below;
    const std::uint16_t* rows[2 * kLargestReach + 5];
    for (int i = 0; i <= count; ++i) {
      rows[i] = row_of(v - image_.reach_px + i);
    }
    const auto convert = [&](const PixelRange& columns) HWY_ATTR {
      reading_.has_beyond ? narrow_columns<kCount, true>(reading_, rows, count, columns, result(v), result(v + 1))
                          : narrow_columns<kCount, false>(reading_, rows, count, columns, result(v), result(v + 1));
    };
    const PixelRange floats_only = common(floats(v), floats(v + 1));
    convert({0, floats_only.empty() ? width_px_ : floats_only.begin});
    if (!floats_only.empty()) {
      convert({floats_only.end, width_px_});
    }
  }

  /// The rows v and v + 1; returns those with islands.
  HWY_INLINE PixelRange free_rows(int v) {
    PixelRange island_rows;
    if (narrow_) {
      from_codes<kReach == 0 ? 0 : 2 * kReach + 1>([&](int row) { return rows_.narrow_minimum(row); }, v, 0,
                                                   result_.free_m, [&](int row) { return rows_.columns.free(row); });
    }
    for (int row = v; row < std::min(v + 2, height_px_); ++row) {
      float* free_m = pixel_row(result_.free_m, width_px_, row);
      filter_columns<kReach>(rows_, rows_.columns.free(row), image_.reach_px, row, free_m);
      const PixelRange robot = image_.robot.near_m != nullptr ? rows_.columns.robot(row) : PixelRange{};
      if (!robot.empty() && join_robot(image_, row, robot, result_, free_m)) {
        island_rows = joined(island_rows, {row, row + 1});
      }
      window_row(Smaller(), free_m, width_px_, rows_.columns.windows(row), rows_.window_m(row));
    }
    return island_rows;
  }

  /// The rows j and j + 1 of level 0, and what can be made of them.
  HWY_INLINE void first_level(int j) {
    float* level = result_.minima_m + result_.levels[0].offset;
    if (narrow_) {
      from_codes<kReach == 0 ? 0 : 2 * kReach + 4>([&](int row) { return rows_.narrow_window(row); }, j, 3, level,
                                                   [&](int row) { return rows_.columns.texels(row); });
    }
    for (int row = std::max(j, 0); row < std::min(j + 2, height_px_); ++row) {
      first_level_row(rows_, rows_.columns.texels(row), row, pixel_row(level, width_px_, row));
      minimum_rows_above(result_.levels, row, rows_.scratch(), result_.minima_m);
    }
  }

  const Reading& reading_;
  const NewImage& image_;
  PreparationRows& rows_;
  const PreparedImage& result_;
  int width_px_;
  int height_px_;
  bool narrow_;  ///< filter codes, and single precision only where the robot asks for it
};

template <bool kUnits>
HWY_INLINE PixelRange prepare_as(const Reading& reading, const NewImage& image, PreparationRows& rows,
                                 const PreparedImage& result) {
  return image.reach_px == 1 ? Passes<kUnits, 1>(reading, image, rows, result).run()
                             : Passes<kUnits, 0>(reading, image, rows, result).run();
}

PixelRange prepare(const Reading& reading, const NewImage& image, PreparationRows& rows, const PreparedImage& result) {
  return image.depth.format == DepthFormat::uint16_units ? prepare_as<true>(reading, image, rows, result)
                                                         : prepare_as<false>(reading, image, rows, result);
}

}  // namespace depthgrid::search::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::search {

HWY_EXPORT(prepare);

PixelRange prepare(const Reading& reading, const NewImage& image, PreparationRows& rows,
                   const PreparedImage& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(prepare)(reading, image, rows, result);
}

}  // namespace depthgrid::search
#endif
