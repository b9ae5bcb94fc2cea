// libFuzzer target: any bytes as a datagram. Either they are refused, or what was read gives the same bytes again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "depthgrid/network/datagram_writer.hpp"

namespace {

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

/// With a checksum that fits, which no mutation finds by itself.
void look(depthgrid::network::Datagram bytes) {
  const std::uint32_t checksum = depthgrid_crc32(bytes.data(), 832);
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[832 + i] = static_cast<unsigned char>(checksum >> (8 * i));
  }
  depthgrid_answer answer{};
  if (depthgrid_read_datagram(bytes.data(), bytes.size(), &answer) == DEPTHGRID_DATAGRAM_OK) {
    require(answer.cameras <= DEPTHGRID_MAX_CAMERAS && answer.parts <= DEPTHGRID_MAX_PARTS);
    const depthgrid::network::Datagram again = depthgrid::network::write_datagram(answer);
    depthgrid_answer second{};
    require(depthgrid_read_datagram(again.data(), again.size(), &second) == DEPTHGRID_DATAGRAM_OK);
    // The head is the same to the bit; of cameras and parts that are not there nothing is kept.
    require(std::memcmp(bytes.data(), again.data(), 36) == 0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  depthgrid_answer answer{};
  (void)depthgrid_read_datagram(data, size, &answer);
  depthgrid::network::Datagram bytes = depthgrid::network::write_datagram(answer);
  for (std::size_t i = 0; i + 1 < size; i += 2) {  // pairs of a place and a value
    bytes.at(8 + (data[i] * 256U + i) % 824U) = data[i + 1];
  }
  look(bytes);
  if (size == bytes.size()) {
    std::memcpy(bytes.data(), data, size);
    look(bytes);
  }
  return 0;
}
