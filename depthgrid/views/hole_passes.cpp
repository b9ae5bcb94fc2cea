#include "depthgrid/views/hole_passes.hpp"

#include <algorithm>
#include <array>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/views/hole_passes.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: seen once for each target.
#include <hwy/highway.h>

#include "depthgrid/views/reading_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {

// Rows of 16-bit values are worked on in plain loops: the compiler makes vectors of the instruction set at hand of
// them, and integers have no roundings. Rows of bits are whole vectors long.
using Words = hn::CappedTag<std::uint64_t, HoleImage::kWordStep>;

/// One image's passes.
class HolePasses {
 public:
  explicit HolePasses(HoleImage& image) : image_(image), words_(image.words_per_row), height_(image.height_px) {}

  void run(const Reading& reading, const DepthView& depth) {
    read(reading, depth);
    find_missing();
    find_least();
    shrink();
    std::copy(image_.missing.begin(), image_.missing.end(), image_.left.begin());
    std::ranges::fill(image_.found_above, 0);
    std::ranges::fill(image_.level, 0);
    for (std::size_t n = image_.levels.size(); n-- > 1;) {
      const HoleLevel& level = image_.levels[n];
      if (stands(level)) {
        grow(level.around, static_cast<std::uint8_t>(n));
      }
    }
  }

 private:
  [[nodiscard]] std::uint64_t* row(BitRows& bits, int v) const {
    return bits.data() + words_ * static_cast<std::size_t>(v);
  }

  void read(const Reading& reading, const DepthView& depth) {
    for (int v = 0; v < height_; ++v) {
      const char* source = static_cast<const char*>(depth.data) + depth.stride_bytes * v;
      std::uint16_t* codes = pixel_row(image_.codes.data(), image_.width_px, v);
      if (depth.format == DepthFormat::uint16_units) {
        const Units d;
        const Decoder decode(reading);
        const auto* units = reinterpret_cast<const std::uint16_t*>(source);
        for_columns({0, image_.width_px}, lanes(d), [&](int u, const auto& part) HWY_ATTR {
          part.store(decode(part.load(d, units + u, std::uint16_t{0})), d, codes + u);
        });
      } else {
        const Floats d;
        const hn::Rebind<std::uint16_t, Floats> narrow;
        const MetreReader reader(reading);
        const V steps = hn::Set(d, static_cast<float>(1.0 / HoleImage::kFloatStep));
        const V zero = hn::Zero(d);
        const V most = hn::Set(d, 65534.0F);
        const auto* metres = reinterpret_cast<const float*>(source);
        for_columns({0, image_.width_px}, lanes(d), [&](int u, const auto& part) HWY_ATTR {
          const V x = reader(part.load(d, metres + u, 0.0F));
          // Rounded towards zero, and a power of two times x is exact.
          const V code = hn::Min(hn::Add(hn::Trunc(hn::Min(hn::Mul(x, steps), most)), hn::Set(d, 1.0F)), most);
          const V valid = hn::IfThenElseZero(hn::Gt(x, zero), code);
          part.store(hn::DemoteTo(narrow, hn::ConvertTo(Ints(), valid)), narrow, codes + u);
        });
      }
    }
  }

  void find_missing() {
    for (int v = 0; v < height_; ++v) {
      const std::uint16_t* codes = pixel_row(image_.codes.data(), image_.width_px, v);
      std::uint64_t* words = row(image_.missing, v);
      std::fill_n(words, words_, 0);
      const Units d;
      const auto none = hn::Zero(d);
      for (int u = 0; u < image_.width_px; u += lanes(d)) {
        const auto code = load_some(d, codes + u, image_.width_px - u, std::uint16_t{1});
        words[u / 64] |= bits_of_units(hn::Eq(code, none)) << static_cast<unsigned>(u % 64);
      }
    }
  }

  /// Bit i of the result: lane i.
  static std::uint64_t bits_of_units(hn::Mask<Units> mask) {
    std::array<std::uint8_t, 8> bytes{};
    hn::StoreMaskBits(Units(), mask, bytes.data());
    std::uint64_t bits = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) {
      bits = bits << 8U | bytes[i];
    }
    return bits;
  }

  void find_least() {
    const int width = image_.width_px;
    LeastLevel& first = image_.least.front();
    for (int v = 0; v < height_; ++v) {
      const auto codes = [&](int r) { return pixel_row(image_.codes.data(), width, std::min(v + r, height_ - 1)); };
      least_row(codes(0), codes(1), codes(2), codes(3), width, image_.row.data(),
                pixel_row(first.texels.data(), width, v));
    }
    for (std::size_t n = 1; n < image_.least.size(); ++n) {
      const LeastLevel& below = image_.least[n - 1];
      LeastLevel& now = image_.least[n];
      for (int j = 0; j < now.height; ++j) {
        const std::uint16_t* upper = pixel_row(below.texels.data(), below.width, 2 * j);
        const std::uint16_t* lower = pixel_row(below.texels.data(), below.width, std::min(2 * j + 4, below.height - 1));
        least_row_above(upper, lower, below.width, now.width, pixel_row(now.texels.data(), now.width, j));
      }
    }
  }

  /// Minima of four columns of four rows, of codes less one: then no reading is the largest.
  static void least_row(const std::uint16_t* a, const std::uint16_t* b, const std::uint16_t* c, const std::uint16_t* d,
                        int width, std::uint16_t* HWY_RESTRICT scratch, std::uint16_t* HWY_RESTRICT result) {
    const auto less = [](std::uint16_t code) HWY_ATTR { return static_cast<std::uint16_t>(code - 1); };
    for (int u = 0; u < width; ++u) {
      scratch[u] = std::min(std::min(less(a[u]), less(b[u])), std::min(less(c[u]), less(d[u])));
    }
    std::fill_n(scratch + width, 3, std::uint16_t{65535});
    for (int u = 0; u < width; ++u) {
      result[u] = std::min(std::min(scratch[u], scratch[u + 1]), std::min(scratch[u + 2], scratch[u + 3]));
    }
  }

  /// Minima of the columns 2 i and 2 i + 4 of two rows of the level below.
  static void least_row_above(const std::uint16_t* upper, const std::uint16_t* lower, int width_below, int width,
                              std::uint16_t* HWY_RESTRICT result) {
    const int whole = std::max((width_below - 4 + 1) / 2, 0);
    for (int i = 0; i < whole; ++i) {
      const std::ptrdiff_t u = std::ptrdiff_t{2} * i;
      result[i] = std::min(std::min(upper[u], upper[u + 4]), std::min(lower[u], lower[u + 4]));
    }
    for (int i = whole; i < width; ++i) {
      const std::ptrdiff_t u = std::ptrdiff_t{2} * i;
      result[i] = std::min(upper[u], lower[u]);
    }
  }

  void shrink() {
    std::copy(image_.missing.begin(), image_.missing.end(), image_.shrunk.front().begin());
    for (std::size_t h = 1; h < image_.shrunk.size(); ++h) {
      for (int v = 0; v < height_; ++v) {
        shrink_row(row(image_.shrunk[h - 1], v), row(image_.missing, v), words_, row(image_.shrunk[h], v));
      }
    }
  }

  /// One more column to both sides; outside the image nothing is missing. (The columns themselves are not in the two
  /// shifted ones when there was none before.)
  static void shrink_row(const std::uint64_t* HWY_RESTRICT from, const std::uint64_t* HWY_RESTRICT centre,
                         std::size_t words, std::uint64_t* HWY_RESTRICT result) {
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < words; ++i) {
      const std::uint64_t after = i + 1 < words ? from[i + 1] << 63U : 0;
      result[i] = centre[i] & ((from[i] << 1U) | before) & ((from[i] >> 1U) | after);
      before = from[i] >> 63U;
    }
  }

  /// Where the level's shape is missing, to `found`; false: nowhere.
  bool stands(const HoleLevel& level) {
    bool any = false;
    for (int v = 0; v < height_; ++v) {
      std::uint64_t* found = row(image_.found, v);
      const bool some =
          level.shape == HoleShape::disc ? disc_row(level.core, v, found) : small_row(level.shape, v, found);
      any = any || some;
    }
    return any;
  }

  bool disc_row(const DiscRows& core, int v, std::uint64_t* HWY_RESTRICT found) {
    const Words d;
    const int reach = core.height();
    if (v < reach || v + reach >= height_) {
      std::fill_n(found, words_, 0);
      return false;
    }
    auto some = hn::Zero(d);
    for (std::size_t i = 0; i < words_; i += hn::Lanes(d)) {
      const auto shrunk = [&](int dv, int r) {
        return hn::LoadU(
            d, row(image_.shrunk[static_cast<std::size_t>(core.half_px[static_cast<std::size_t>(dv)])], r) + i);
      };
      auto all = shrunk(0, v);
      for (int dv = 1; dv <= reach && any_of(all); ++dv) {
        all = hn::And(all, hn::And(shrunk(dv, v - dv), shrunk(dv, v + dv)));
      }
      hn::StoreU(all, d, found + i);
      some = hn::Or(some, all);
    }
    return any_of(some);
  }

  static HWY_INLINE bool any_of(hn::Vec<Words> words) {
    const Words d;
    return !hn::AllTrue(d, hn::Eq(words, hn::Zero(d)));
  }

  bool small_row(HoleShape shape, int v, std::uint64_t* HWY_RESTRICT found) {
    const std::uint64_t* here = row(image_.missing, v);
    const bool last = v + 1 == height_;
    const std::uint64_t* below = row(image_.missing, last ? v : v + 1);
    std::uint64_t some = 0;
    for (std::size_t i = 0; i < words_; ++i) {
      const auto next = [&](const std::uint64_t* words) {
        return (words[i] >> 1U) | (i + 1 < words_ ? words[i + 1] << 63U : 0);
      };
      const std::uint64_t a = here[i];
      const std::uint64_t b = next(here);
      const std::uint64_t c = last ? 0 : below[i];
      const std::uint64_t d = last ? 0 : next(below);
      found[i] = shape == HoleShape::pair ? (a & b) | (a & c) : (a & b & (c | d)) | (c & d & (a | b));
      some |= found[i];
    }
    return some != 0;
  }

  /// Gives level n to the pixels without one that lie `disc` around what was found. What was found for the level above,
  /// too, has done so, and so need not what has only pixels with a level around: it is inside of large holes.
  void grow(const DiscRows& disc, std::uint8_t n) {
    find_left_around(disc);
    for (int v = 0; v < height_; ++v) {
      if (!find_fresh(v)) {
        continue;
      }
      for (std::size_t i = 0; i < words_; ++i) {
        if (image_.fresh[i] != 0) {
          grow_word(disc, v, i, image_.fresh[i], n);
        }
      }
    }
  }

  /// Around which places, at most, pixels without a level are left, kLeftRows rows joined to one.
  void find_left_around(const DiscRows& disc) {
    const int count = (height_ + HoleImage::kLeftRows - 1) / HoleImage::kLeftRows;
    for (int j = 0; j < count; ++j) {
      std::uint64_t* joined = row(image_.left_rows, j);
      std::fill_n(joined, words_, 0);
      for (int v = HoleImage::kLeftRows * j; v < std::min(HoleImage::kLeftRows * (j + 1), height_); ++v) {
        join(row(image_.left, v), joined);
      }
    }
    const int reach = disc.height() / HoleImage::kLeftRows + 1;
    for (int j = 0; j < count; ++j) {
      std::uint64_t* around = row(image_.left_around, j);
      std::fill_n(around, words_, 0);
      for (int other = std::max(j - reach, 0); other <= std::min(j + reach, count - 1); ++other) {
        join(row(image_.left_rows, other), around);
      }
      widen_row(around, disc.half_px[0]);
    }
  }

  void join(const std::uint64_t* from, std::uint64_t* to) const {
    const Words d;
    for (std::size_t i = 0; i < words_; i += hn::Lanes(d)) {
      hn::StoreU(hn::Or(hn::LoadU(d, to + i), hn::LoadU(d, from + i)), d, to + i);
    }
  }

  /// Sets bits up to so many columns beside set ones.
  void widen_row(std::uint64_t* bits, int columns) const {
    for (int done = 0; done < columns;) {
      const int step = std::min(columns - done, 2 * done + 1);  // what is set so far has no gaps
      const auto by = static_cast<unsigned>(step);
      std::uint64_t before = 0;
      for (std::size_t i = 0; i < words_; ++i) {
        const std::uint64_t here = bits[i];
        const std::uint64_t after = i + 1 < words_ ? bits[i + 1] : 0;
        bits[i] = here | (here << by) | (before >> (64U - by)) | (here >> by) | (after << (64U - by));
        before = here;
      }
      done += step;
    }
  }

  /// Of row v: what was not found above and has pixels left around, to `fresh`; false: nothing. Above then becomes what
  /// was found.
  bool find_fresh(int v) {
    const Words d;
    const std::uint64_t* found = row(image_.found, v);
    std::uint64_t* above = row(image_.found_above, v);
    const std::uint64_t* around = row(image_.left_around, v / HoleImage::kLeftRows);
    auto some = hn::Zero(d);
    for (std::size_t i = 0; i < words_; i += hn::Lanes(d)) {
      const auto now = hn::LoadU(d, found + i);
      const auto first = hn::And(hn::AndNot(hn::LoadU(d, above + i), now), hn::LoadU(d, around + i));
      hn::StoreU(now, d, above + i);
      hn::StoreU(first, d, image_.fresh.data() + i);
      some = hn::Or(some, first);
    }
    return any_of(some);
  }

  /// For one word. No disc reaches farther than a word.
  void grow_word(const DiscRows& disc, int v, std::size_t i, std::uint64_t word, std::uint8_t n) {
    std::uint64_t before = 0;
    std::uint64_t here = word;
    std::uint64_t after = 0;
    int columns = 0;
    for (int dv = disc.height(); dv >= 0; --dv) {
      for (; columns < disc.half_px[static_cast<std::size_t>(dv)]; ++columns) {
        before |= (before >> 1U) | (here << 63U);
        after |= (after << 1U) | (here >> 63U);
        here |= (here << 1U) | (here >> 1U);
      }
      for (const int r : {v - dv, v + dv}) {
        if (r < 0 || r >= height_) {
          continue;
        }
        if (i > 0) {
          take(r, i - 1, before, n);
        }
        take(r, i, here, n);
        if (i + 1 < words_) {
          take(r, i + 1, after, n);
        }
      }
    }
  }

  void take(int v, std::size_t i, std::uint64_t bits, std::uint8_t n) {
    std::uint64_t& left = row(image_.left, v)[i];
    std::uint64_t now = left & bits;
    if (now == 0) {
      return;
    }
    left &= ~now;
    std::uint8_t* level = pixel_row(image_.level.data(), image_.width_px, v) + 64 * i;
    for (; now != 0; now &= now - 1) {
      level[std::countr_zero(now)] = n;
    }
  }

  HoleImage& image_;
  std::size_t words_;
  int height_;
};

void find_holes(const Reading& reading, const DepthView& depth, HoleImage& image) {
  HolePasses(image).run(reading, depth);
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::views {
namespace {

int widest_half(const std::vector<HoleLevel>& levels) {
  int half = 0;
  for (const HoleLevel& level : levels) {
    half = std::max(half, level.core.half_px.front());
  }
  return half;
}

}  // namespace

int least_level(int window_px) noexcept {
  int level = 0;
  while (2 * window_px > 7 << level) {
    ++level;
  }
  return level;
}

HoleImage::HoleImage(int width_px_in, int height_px_in, std::vector<HoleLevel> levels_in)
    : width_px(width_px_in),
      height_px(height_px_in),
      words_per_row((static_cast<std::size_t>(width_px) + 64 * kWordStep - 1) / (64 * kWordStep) * kWordStep),
      levels(std::move(levels_in)) {
  const auto rows = static_cast<std::size_t>(height_px);
  const std::size_t pixels = static_cast<std::size_t>(width_px) * rows;
  const BitRows bits(words_per_row * rows);
  missing = left = found = found_above = left_rows = left_around = bits;
  fresh.resize(words_per_row);
  shrunk.assign(static_cast<std::size_t>(widest_half(levels)) + 1, bits);
  level.resize(pixels);
  codes.resize(pixels);
  row.resize(static_cast<std::size_t>(width_px) + 3);
  for (int n = 0; n <= least_level(levels[levels.size() - 2].window_px); ++n) {
    const int width = ((width_px - 1) >> n) + 1;
    const int height = ((height_px - 1) >> n) + 1;
    least.push_back({width, height,
                     AlignedVector<std::uint16_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))});
  }
}

HWY_EXPORT(find_holes);

void find_holes(const Reading& reading, const DepthView& depth, HoleImage& image) noexcept {
  HWY_DYNAMIC_DISPATCH(find_holes)(reading, depth, image);
}

}  // namespace depthgrid::views
#endif
