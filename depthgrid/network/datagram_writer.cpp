#include "depthgrid/network/datagram_writer.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace depthgrid::network {
namespace {

template <class Integer>
void put(Datagram& bytes, std::size_t at, Integer value) noexcept {
  for (std::size_t i = 0; i < sizeof(Integer); ++i) {
    bytes[at + i] = static_cast<unsigned char>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
}

void put_float(Datagram& bytes, std::size_t at, float value) noexcept {
  put(bytes, at, std::bit_cast<std::uint32_t>(value));
}

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

}  // namespace

float rounded_down(double value) noexcept {
  const auto nearest = static_cast<float>(value);
  return static_cast<double>(nearest) > value ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
                                              : nearest;
}

float rounded_up(double value) noexcept { return -rounded_down(-value); }

Datagram write_datagram(const depthgrid_answer& answer) noexcept {
  Datagram bytes{};
  bytes[0] = 'D';
  bytes[1] = 'G';
  bytes[2] = 'R';
  bytes[3] = 'D';
  put(bytes, 4, std::uint16_t{DEPTHGRID_DATAGRAM_VERSION});
  put(bytes, 6, std::uint16_t{DEPTHGRID_DATAGRAM_SIZE});
  put(bytes, 8, answer.sequence);
  put(bytes, 16, std::bit_cast<std::uint64_t>(answer.time_s));
  put(bytes, 24, std::bit_cast<std::uint64_t>(answer.exposure_s));
  bytes[32] = answer.state;
  bytes[33] = answer.stop;
  bytes[34] = answer.cameras;
  bytes[35] = answer.parts;
  put(bytes, 36, answer.late_cameras);
  put_float(bytes, 40, answer.distance_m);
  put_float(bytes, 44, answer.clear_m);
  put_float(bytes, 48, answer.blind_m);
  put_float(bytes, 52, answer.skew_s);
  put_float(bytes, 56, answer.joints_age_s);
  put_float(bytes, 60, answer.latency_s);
  for (std::size_t k = 0; k < DEPTHGRID_MAX_CAMERAS; ++k) {
    const bool is_there = k < answer.cameras;
    put_float(bytes, 64 + 4 * k, is_there ? answer.image_age_s[k] : kUnknown);
    put_float(bytes, 128 + 4 * k, is_there ? answer.without_reading[k] : kUnknown);
  }
  for (std::size_t i = 0; i < DEPTHGRID_MAX_PARTS; ++i) {
    const bool is_there = i < answer.parts;
    const std::size_t at = 192 + 20 * i;
    put_float(bytes, at, is_there ? answer.part[i].distance_m : kUnknown);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put_float(bytes, at + 4 + 4 * axis, is_there ? answer.part[i].nearest_m[axis] : kUnknown);
    }
    bytes[at + 16] = is_there ? answer.part[i].state : std::uint8_t{DEPTHGRID_NOT_EVALUATED};
  }
  put(bytes, 832, depthgrid_crc32(bytes.data(), 832));
  return bytes;
}

}  // namespace depthgrid::network
