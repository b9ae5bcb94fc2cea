// Rows of an image, a vector at a time. Included once for each instruction set. Internal.
#if defined(DEPTHGRID_VIEWS_VECTOR_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef DEPTHGRID_VIEWS_VECTOR_ROWS_INL
#undef DEPTHGRID_VIEWS_VECTOR_ROWS_INL
#else
#define DEPTHGRID_VIEWS_VECTOR_ROWS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "depthgrid/core/lanes-inl.hpp"
#include "depthgrid/views/preparation_rows.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {
using namespace lanes::HWY_NAMESPACE;
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr int kMaxFilterRadius = 16;  ///< as validate() of SensorMargin has it

template <class D>
HWY_INLINE int lanes(D d) {
  return static_cast<int>(hn::Lanes(d));
}

template <class Value>
HWY_INLINE Value* pixel_row(Value* pixels, int width_px, int v) {
  return pixels + std::ptrdiff_t{width_px} * v;
}

/// Room for one vector.
template <class Value>
using VectorArray = std::array<Value, HWY_MAX_BYTES / sizeof(Value)>;

/// Brings memory that is read or written soon into the second cache: a store that misses all caches would hold up those
/// behind it. There need not be anything.
HWY_INLINE void ask_for([[maybe_unused]] const void* memory, [[maybe_unused]] std::ptrdiff_t bytes_further) {
#if HWY_COMPILER_GCC || HWY_COMPILER_CLANG
  const auto address = reinterpret_cast<std::uintptr_t>(memory) + static_cast<std::uintptr_t>(bytes_further);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): a pointer may not point there
  __builtin_prefetch(reinterpret_cast<const void*>(address), 0, 2);
#endif
}

/// `count` values from memory that ends there, the rest filled.
template <class D>
HWY_INLINE hn::Vec<D> load_some(D d, const hn::TFromD<D>* from, int count, hn::TFromD<D> fill) {
  if (count >= lanes(d)) {
    return hn::LoadU(d, from);
  }
  HWY_ALIGN VectorArray<hn::TFromD<D>> values{};
  values.fill(fill);
  std::copy_n(from, std::max(count, 0), values.begin());
  return hn::Load(d, values.data());
}

template <class D>
HWY_INLINE void store_some(hn::Vec<D> v, D d, hn::TFromD<D>* to, int count) {
  if (count >= lanes(d)) {
    hn::StoreU(v, d, to);
    return;
  }
  HWY_ALIGN VectorArray<hn::TFromD<D>> values{};
  hn::Store(v, d, values.data());
  std::copy_n(values.begin(), std::max(count, 0), to);
}

/// Some of a row's values, or all of a vector.
struct Part {
  int count;
  template <class D>
  HWY_INLINE hn::Vec<D> load(D d, const hn::TFromD<D>* from, hn::TFromD<D> fill) const {
    return load_some(d, from, count, fill);
  }
  template <class D>
  HWY_INLINE void store(hn::Vec<D> v, D d, hn::TFromD<D>* to) const {
    store_some(v, d, to, count);
  }
  template <class D>
  HWY_INLINE void stream(hn::Vec<D> v, D d, hn::TFromD<D>* to) const {
    store_some(v, d, to, count);
  }
};

struct Whole {
  template <class D>
  HWY_INLINE hn::Vec<D> load(D d, const hn::TFromD<D>* from, hn::TFromD<D> /*fill*/) const {
    return hn::LoadU(d, from);
  }
  template <class D>
  HWY_INLINE void store(hn::Vec<D> v, D d, hn::TFromD<D>* to) const {
    hn::StoreU(v, d, to);
  }
  /// For what is not read again soon: leaves the caches to others where whole lines are written.
  template <class D>
  HWY_INLINE void stream(hn::Vec<D> v, D d, hn::TFromD<D>* to) const {
    if (reinterpret_cast<std::uintptr_t>(to) % (hn::Lanes(d) * sizeof(*to)) == 0) {
      hn::Stream(v, d, to);
    } else {
      hn::StoreU(v, d, to);
    }
  }
};

/// body(u, part) for vectors of n columns; the last one may be a part only. Whole vectors go in pairs, because a loop
/// with few instructions costs its branch.
template <class Body>
HWY_INLINE void for_columns(const PixelRange& columns, int n, const Body& body) {
  int u = columns.begin;
  for (; columns.end - u >= 2 * n; u += 2 * n) {
    body(u, Whole());
    body(u + n, Whole());
  }
  for (; columns.end - u >= n; u += n) {
    body(u, Whole());
  }
  if (u < columns.end) {
    body(u, Part{columns.end - u});
  }
}

struct Smaller {
  static constexpr float kNeutral = std::numeric_limits<float>::infinity();
  HWY_INLINE V operator()(V a, V b) const { return hn::Min(a, b); }
};

struct Larger {
  static constexpr float kNeutral = -std::numeric_limits<float>::infinity();
  HWY_INLINE V operator()(V a, V b) const { return hn::Max(a, b); }
};

/// The extremum of each column and the three to its right, as far as there are columns.
template <class Extremum>
HWY_INLINE void window_row(const Extremum& extremum, const float* row, int width, const PixelRange& columns,
                           float* HWY_RESTRICT result) {
  const Floats d;
  // Near the border the neighbours are fewer.
  const int whole = std::max(std::min(columns.end, width - 3 - lanes(d) + 1), columns.begin);
  int u = columns.begin;
  for (; u < whole; u += lanes(d)) {
    const V left = extremum(hn::LoadU(d, row + u), hn::LoadU(d, row + u + 1));
    const V right = extremum(hn::LoadU(d, row + u + 2), hn::LoadU(d, row + u + 3));
    store_some(extremum(left, right), d, result + u, columns.end - u);
  }
  for (; u < columns.end; u += lanes(d)) {
    V best = load_some(d, row + u, width - u, Extremum::kNeutral);
    for (int k = 1; k < 4; ++k) {
      best = extremum(best, load_some(d, row + u + k, width - u - k, Extremum::kNeutral));
    }
    store_some(best, d, result + u, columns.end - u);
  }
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
