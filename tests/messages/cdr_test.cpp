// Messages as bytes: worked examples, either byte order beside a twin, and bytes that are no message.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/messages/cdr_writer.hpp"
#include "messages/random_message.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::messages {
namespace {

using test::RandomFields;
using test::thrown_message;
using test::TwinWriter;

std::vector<std::byte> raw(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) {
    bytes.push_back(static_cast<std::byte>(value));
  }
  return bytes;
}

template <class Message>
std::vector<std::byte> twin_bytes(const Message& message, bool big) {
  TwinWriter writer(big);
  fields(writer, message);
  return writer.bytes();
}

TEST(Cdr, ATextByHand) {
  const auto bytes = raw({0, 1, 0, 0, 3, 0, 0, 0, 'h', 'i', 0});
  EXPECT_EQ(to_bytes(Text{"hi"}), bytes);
  EXPECT_EQ(from_bytes<Text>(bytes).data, "hi");
  EXPECT_EQ(from_bytes<Text>(raw({0, 0, 0, 0, 0, 0, 0, 3, 'h', 'i', 0})).data, "hi");
  EXPECT_EQ(from_bytes<Text>(raw({0, 1, 0, 0, 2, 0, 0, 0, 'h', 'i'})).data, "hi") << "without the zero";
  EXPECT_EQ(from_bytes<Text>(raw({0, 1, 0, 0, 0, 0, 0, 0})).data, "") << "as some write an empty text";
}

/// A double begins at a multiple of 8, counted without the first four bytes; an empty list of them does not.
TEST(Cdr, NumbersAreAligned) {
  JointState state;
  state.name = {"a"};
  state.position = {1.0};
  const auto bytes = to_bytes(state);
  EXPECT_EQ(bytes, raw({0, 1, 0, 0,                   //
                        0, 0, 0, 0, 0,   0, 0,    0,  // stamp
                        1, 0, 0, 0, 0,                // frame_id
                        0, 0, 0, 1, 0,   0, 0,        // one name
                        2, 0, 0, 0, 'a', 0,           //
                        0, 0, 1, 0, 0,   0,           // one position
                        0, 0, 0, 0, 0,   0, 0xF0, 0x3F, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(from_bytes<JointState>(bytes).position, state.position);
}

template <class Message>
class EveryMessage : public ::testing::Test {};
using Messages =
    ::testing::Types<Image, CompressedImage, CameraInfo, JointState, Transforms, Text, Markers, Diagnostics, Distances>;
TYPED_TEST_SUITE(EveryMessage, Messages);

TYPED_TEST(EveryMessage, ComesBackFromEitherByteOrder) {
  const auto run = test::random_run(200);
  std::mt19937_64 random(run.seed);
  for (std::int64_t i = 0; i < run.count; ++i) {
    std::vector<std::vector<std::byte>> held;
    TypeParam message;
    RandomFields fill(random, held);
    fields(fill, message);
    const auto bytes = to_bytes(message);
    ASSERT_EQ(bytes, twin_bytes(message, false)) << run.reproduce();
    ASSERT_EQ(to_bytes(from_bytes<TypeParam>(bytes)), bytes) << run.reproduce();
    const auto big = twin_bytes(message, true);
    ASSERT_EQ(to_bytes(from_bytes<TypeParam>(big)), bytes) << run.reproduce();
  }
}

/// In memory of exactly their size, so that a sanitizer sees a byte that is read beyond.
TYPED_TEST(EveryMessage, IsRefusedWhereverItIsCut) {
  std::mt19937_64 random(7);
  std::vector<std::vector<std::byte>> held;
  TypeParam message;
  RandomFields fill(random, held);
  fields(fill, message);
  const auto bytes = to_bytes(message);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THAT(thrown_message([&] { static_cast<void>(from_bytes<TypeParam>(cut)); }),
                ::testing::StartsWith(std::string(type_of<TypeParam>().name) + ": "))
        << size << " of " << bytes.size();
  }
}

TYPED_TEST(EveryMessage, BrokenBytesAreReadOrRefused) {
  const auto run = test::random_run(500);
  std::mt19937_64 random(run.seed);
  for (std::int64_t i = 0; i < run.count; ++i) {
    std::vector<std::vector<std::byte>> held;
    TypeParam message;
    RandomFields fill(random, held);
    fields(fill, message);
    auto bytes = to_bytes(message);
    for (int k = 0; k < 4; ++k) {
      bytes[random() % bytes.size()] = static_cast<std::byte>(random() % 3 == 0 ? 0xFF : random());
    }
    const std::string why = thrown_message([&] { static_cast<void>(from_bytes<TypeParam>(bytes)); });
    EXPECT_TRUE(is_printable(why)) << why << '\n' << run.reproduce();
  }
}

struct Refusal {
  const char* name;
  std::vector<std::byte> bytes;
  const char* message;
};

TEST(Cdr, SaysWhatIsMissing) {
  const std::vector<Refusal> refusals{
      {"Empty", {}, "std_msgs/msg/String: has 0 bytes, must have at least the 4 that say how a message is written"},
      {"ParameterList", raw({0, 3, 0, 0}),
       "std_msgs/msg/String: begins with the bytes 0 3, must be 0 0 or 0 1: plain CDR (XCDR1), as ROS 2 writes it"},
      {"Xcdr2", raw({0, 7, 0, 0, 0, 0, 0, 0}),
       "std_msgs/msg/String: begins with the bytes 0 7, must be 0 0 or 0 1: plain CDR (XCDR1), as ROS 2 writes it"},
      {"NoLength", raw({0, 1, 0, 0, 1, 0}), "std_msgs/msg/String: 'data' needs 4 bytes at byte 4, the message has 6"},
      {"LongText", raw({0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 'a'}),
       "std_msgs/msg/String: 'data' needs 4294967295 bytes at byte 8, the message has 9"}};
  for (const Refusal& refusal : refusals) {
    EXPECT_EQ(thrown_message([&] { static_cast<void>(from_bytes<Text>(refusal.bytes)); }), refusal.message)
        << refusal.name;
  }
}

/// Four billion elements are promised: memory is taken for none that is not there.
TEST(Cdr, LongListsTakeNoMemory) {
  auto joints = to_bytes(JointState{});
  const auto grow = [](std::vector<std::byte>& bytes, std::size_t at) {
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), 4, std::byte{0xFF});
  };
  grow(joints, 4 + 8 + 8 + 4);  // position
  EXPECT_EQ(thrown_message([&] { static_cast<void>(from_bytes<JointState>(joints)); }),
            "sensor_msgs/msg/JointState: 'position' needs 34359738360 bytes at byte 28, the message has 36");
  auto names = to_bytes(JointState{});
  grow(names, 4 + 8 + 8);
  EXPECT_THAT(thrown_message([&] { static_cast<void>(from_bytes<JointState>(names)); }),
              ::testing::HasSubstr("'name' needs"));
  auto transforms = to_bytes(Transforms{});
  grow(transforms, 4);
  EXPECT_THAT(thrown_message([&] { static_cast<void>(from_bytes<Transforms>(transforms)); }),
              ::testing::HasSubstr("'sec' needs 4 bytes"));
}

TEST(Cdr, ImagesAreViews) {
  const std::vector<std::byte> pixels(12, std::byte{7});
  Image image;
  image.data = pixels;
  const auto bytes = to_bytes(image);
  const Image read = from_bytes<Image>(bytes);
  EXPECT_EQ(read.data.data() + read.data.size(), bytes.data() + bytes.size());
  EXPECT_EQ(read.data.size(), 12U);
}

TEST(Cdr, MemoryIsUsedAgain) {
  std::vector<std::byte> bytes;
  to_bytes(Text{std::string(100, 'a')}, bytes);
  const auto* before = bytes.data();
  to_bytes(Text{"b"}, bytes);
  EXPECT_EQ(bytes.data(), before);
  EXPECT_EQ(from_bytes<Text>(bytes).data, "b");
}

TEST(Cdr, BytesAfterTheMessageArePassedOver) {
  auto bytes = to_bytes(Text{"hi"});
  bytes.resize(bytes.size() + 5);
  EXPECT_EQ(from_bytes<Text>(bytes).data, "hi");
}

TEST(Time, ComesBackFromSeconds) {
  const auto run = test::random_run(100000);
  std::mt19937_64 random(run.seed);
  for (std::int64_t i = 0; i < run.count; ++i) {
    const double time_s = std::uniform_real_distribution<>(0, i % 2 == 0 ? 2e9 : 4e6)(random);
    const Time time = time_of(time_s);
    ASSERT_LT(time.nanosec, 1'000'000'000U);
    if (time_s > 1e8) {
      ASSERT_EQ(seconds(time), time_s) << run.reproduce();  // stamps of our days: nothing is lost
    }
    ASSERT_NEAR(seconds(time), time_s, 1e-9);
  }
  EXPECT_EQ(nanoseconds({.sec = -1, .nanosec = 999'999'999}), -1);
  EXPECT_EQ(seconds(time_of(-0.25)), -0.25);
  EXPECT_EQ(time_of(2 - 1e-10).sec, 2);
  for (const double bad : {1e10, -1e10, std::nan(""), HUGE_VAL}) {
    EXPECT_THAT(thrown_message([&] { static_cast<void>(time_of(bad)); }),
                ::testing::StartsWith("a message cannot hold the time"));
  }
}

}  // namespace
}  // namespace depthgrid::messages
