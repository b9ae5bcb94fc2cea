// Random numbers for images: a function of seed, frame and pixel, so that an image can be made again, alone and in any
// order, on any machine.
#pragma once

#include <cstdint>

namespace depthgrid::simulation {

/// Bits that look random for each key; the same everywhere.
[[nodiscard]] constexpr std::uint64_t scrambled(std::uint64_t key) noexcept {
  // The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
  key += 0x9E3779B97F4A7C15ULL;
  key = (key ^ (key >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  key = (key ^ (key >> 27U)) * 0x94D049BB133111EBULL;
  return key ^ (key >> 31U);
}

/// One of 65536 equally likely values of the standard normal distribution: the quantiles (bits + 0.5) / 65536, so none
/// lies beyond 4.33.
[[nodiscard]] float normal_of(std::uint16_t bits) noexcept;

/// Uniform in [0, 1), in steps of 2^-32.
[[nodiscard]] constexpr double uniform_of(std::uint32_t bits) noexcept { return bits * 0x1p-32; }

/// The numbers of one frame: `stream` keeps what is drawn for different purposes apart.
class PixelRandom {
 public:
  constexpr PixelRandom(std::uint64_t seed, std::uint64_t frame, std::uint64_t stream) noexcept
      : key_(scrambled(scrambled(scrambled(seed) ^ frame) ^ stream)) {}

  [[nodiscard]] constexpr std::uint64_t bits(std::uint64_t pixel) const noexcept { return scrambled(key_ + pixel); }
  [[nodiscard]] constexpr double uniform(std::uint64_t pixel) const noexcept {
    return uniform_of(static_cast<std::uint32_t>(bits(pixel) >> 32U));
  }

 private:
  std::uint64_t key_;
};

/// The n-th of the four normal numbers, or of the two uniform ones, that 64 bits hold.
[[nodiscard]] inline float normal_of(std::uint64_t bits, unsigned n) noexcept {
  return normal_of(static_cast<std::uint16_t>(bits >> (16U * n)));
}
[[nodiscard]] constexpr double uniform_of(std::uint64_t bits, unsigned n) noexcept {
  return uniform_of(static_cast<std::uint32_t>(bits >> (32U * n)));
}

}  // namespace depthgrid::simulation
