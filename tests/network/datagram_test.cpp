#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/network/datagram_writer.hpp"
#include "depthgrid/network/udp_sender.hpp"

namespace depthgrid::network {
namespace {

depthgrid_answer some_answer() {
  depthgrid_answer answer{};
  answer.sequence = 0x0123456789abcdefULL;
  answer.time_s = 1234.5;
  answer.exposure_s = 1234.25;
  answer.state = DEPTHGRID_OBSTACLE;
  answer.cameras = 2;
  answer.parts = 3;
  answer.late_cameras = 2;
  answer.distance_m = 0.25F;
  answer.clear_m = 0.125F;
  answer.blind_m = 0.0625F;
  answer.latency_s = 0.03125F;
  answer.image_age_s[1] = 0.5F;
  answer.without_reading[0] = 0.75F;
  answer.part[2] = {1.5F, {1, -2, 3}, DEPTHGRID_OCCLUDED};
  return answer;
}

TEST(Datagram, IsReadAsItWasWritten) {
  const Datagram bytes = write_datagram(some_answer());
  depthgrid_answer read{};
  ASSERT_EQ(depthgrid_read_datagram(bytes.data(), bytes.size(), &read), DEPTHGRID_DATAGRAM_OK);
  EXPECT_EQ(read.sequence, 0x0123456789abcdefULL);
  EXPECT_EQ(read.time_s, 1234.5);
  EXPECT_EQ(read.exposure_s, 1234.25);
  EXPECT_EQ(read.state, DEPTHGRID_OBSTACLE);
  EXPECT_EQ(read.late_cameras, 2U);
  EXPECT_EQ(read.clear_m, 0.125F);
  EXPECT_EQ(read.image_age_s[1], 0.5F);
  EXPECT_EQ(read.without_reading[0], 0.75F);
  EXPECT_TRUE(std::isnan(read.image_age_s[2])) << "there is no third camera";
  EXPECT_EQ(read.part[2].nearest_m[1], -2);
  EXPECT_EQ(read.part[2].state, DEPTHGRID_OCCLUDED);
  EXPECT_TRUE(std::isnan(read.part[3].distance_m));
}

TEST(Datagram, ItsBytesStandWhereTheHeaderSays) {
  const Datagram bytes = write_datagram(some_answer());
  EXPECT_EQ(std::memcmp(bytes.data(), "DGRD\x01\x00\x44\x03\xef\xcd\xab\x89\x67\x45\x23\x01", 16), 0);
  EXPECT_EQ(bytes[32], 1);
  EXPECT_EQ(bytes[34], 2);
  EXPECT_EQ(bytes[35], 3);
  EXPECT_EQ(bytes[36], 2);
  EXPECT_EQ(bytes[42], 0x80);  // 0.25F is 0x3e800000
  EXPECT_EQ(bytes[43], 0x3e);
  const std::uint32_t checksum = depthgrid_read_u32(bytes.data() + 832);
  EXPECT_EQ(checksum, ::crc32(0, bytes.data(), 832)) << "zlib's";
}

TEST(Datagram, EveryChangedBitIsFound) {
  const Datagram bytes = write_datagram(some_answer());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Datagram changed = bytes;
    changed[bit / 8] = static_cast<unsigned char>(changed[bit / 8] ^ (1U << (bit % 8)));
    depthgrid_answer read{};
    EXPECT_NE(depthgrid_read_datagram(changed.data(), changed.size(), &read), DEPTHGRID_DATAGRAM_OK) << "bit " << bit;
    EXPECT_EQ(read.sequence, 0U) << "nothing is written";
  }
}

TEST(Datagram, AnotherLengthOrVersionIsRefused) {
  const Datagram bytes = write_datagram(some_answer());
  depthgrid_answer read{};
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<unsigned char> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(depthgrid_read_datagram(cut.data(), size, &read), DEPTHGRID_DATAGRAM_SIZE_WRONG);
  }
  std::vector<unsigned char> longer(bytes.begin(), bytes.end());
  longer.push_back(0);
  EXPECT_EQ(depthgrid_read_datagram(longer.data(), longer.size(), &read), DEPTHGRID_DATAGRAM_SIZE_WRONG);
  Datagram next = bytes;
  next[4] = 2;
  EXPECT_EQ(depthgrid_read_datagram(next.data(), next.size(), &read), DEPTHGRID_DATAGRAM_VERSION_WRONG);
}

TEST(Datagram, WhatNobodyWritesIsRefusedWithAChecksumThatFits) {
  depthgrid_answer read{};
  const auto refused = [&](std::size_t at, unsigned char value) {
    Datagram bytes = write_datagram(some_answer());
    bytes[at] = value;
    const std::uint32_t checksum = depthgrid_crc32(bytes.data(), 832);
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[832 + i] = static_cast<unsigned char>(checksum >> (8 * i));
    }
    return depthgrid_read_datagram(bytes.data(), bytes.size(), &read) == DEPTHGRID_DATAGRAM_CONTENT_WRONG;
  };
  EXPECT_TRUE(refused(32, 8));
  EXPECT_TRUE(refused(33, 2));
  EXPECT_TRUE(refused(34, 17));
  EXPECT_TRUE(refused(35, 33));
  EXPECT_TRUE(refused(192 + 20 * 31 + 16, 7));
  EXPECT_FALSE(refused(34, 16));
}

TEST(Datagram, BoundsAreRoundedToTheirSide) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-3, 3);
  for (int i = 0; i < 10000; ++i) {
    const double value = number(random);
    EXPECT_LE(static_cast<double>(rounded_down(value)), value);
    EXPECT_GE(static_cast<double>(rounded_up(value)), value);
    EXPECT_NEAR(static_cast<double>(rounded_down(value)), value, 1e-6);
  }
  EXPECT_TRUE(std::isnan(rounded_down(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_EQ(rounded_down(0.5), 0.5F);
}

TEST(UdpSender, SendsAndCounts) {
  const int incoming = ::socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(incoming, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(incoming, reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
  socklen_t size = sizeof here;
  ASSERT_EQ(::getsockname(incoming, reinterpret_cast<sockaddr*>(&here), &size), 0);
  UdpSender sender("127.0.0.1", ntohs(here.sin_port));
  EXPECT_TRUE(sender.send(write_datagram(some_answer())));
  std::vector<unsigned char> bytes(2048);
  const ssize_t count = ::recv(incoming, bytes.data(), bytes.size(), 0);
  depthgrid_answer read{};
  ASSERT_GT(count, 0);
  EXPECT_EQ(depthgrid_read_datagram(bytes.data(), static_cast<std::size_t>(count), &read), DEPTHGRID_DATAGRAM_OK);
  EXPECT_EQ(sender.sent(), 1);
  (void)::close(incoming);
  // Nobody listens any more: what the system tells of that is counted, and nothing waits.
  for (int i = 0; i < 10; ++i) {
    (void)sender.send(write_datagram(some_answer()));
  }
  EXPECT_GT(sender.lost(), 0);
}

TEST(UdpSender, RefusesWhatIsNoAddress) {
  EXPECT_THROW(UdpSender("localhost", 47000), Error);
  EXPECT_THROW(UdpSender("127.0.0.1", 0), Error);
  EXPECT_THROW(UdpSender("127.0.0.1", 65536), Error);
}

}  // namespace
}  // namespace depthgrid::network
