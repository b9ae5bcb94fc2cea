// What other ROS 2 nodes read to learn the node's name.
#include "depthgrid/dds/discovery_info.hpp"

#include <gtest/gtest.h>

#include "depthgrid/messages/cdr_reader.hpp"

namespace depthgrid::dds {
namespace {

Guid filled(std::uint8_t first) {
  Guid guid{};
  for (std::size_t n = 0; n < guid.size(); ++n) {
    guid[n] = static_cast<std::uint8_t>(first + n);
  }
  return guid;
}

TEST(DiscoveryInfo, NamesTheNodeAndItsEnds) {
  DiscoveryInfo info;
  info.participant = filled(1);
  info.name_space = "/";
  info.name = "arm";
  info.readers = {filled(100)};
  info.writers = {filled(20), filled(40)};
  std::vector<std::byte> bytes;
  to_bytes(info, bytes);
  // By hand: 4 of the encoding, 16 of the participant, 1 node, "/" and its zero, filled up to 4, "arm" and its zero.
  const auto at = [&](std::size_t n) { return std::to_integer<int>(bytes.at(n)); };
  EXPECT_EQ(at(1), 1) << "little endian";
  EXPECT_EQ(at(4), 1);
  EXPECT_EQ(at(19), 16);
  EXPECT_EQ(at(20), 1);
  EXPECT_EQ(at(24), 2);
  EXPECT_EQ(at(28), '/');
  EXPECT_EQ(at(32), 4);
  EXPECT_EQ(at(36), 'a');
  EXPECT_EQ(at(39), 0);
  EXPECT_EQ(at(40), 1) << "readers";
  EXPECT_EQ(at(44), 100);
  EXPECT_EQ(at(60), 2) << "writers";
  EXPECT_EQ(at(64), 20);
  EXPECT_EQ(at(80), 40);
  EXPECT_EQ(bytes.size(), 96U);
}

}  // namespace
}  // namespace depthgrid::dds
