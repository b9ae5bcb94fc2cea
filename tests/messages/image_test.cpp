// Depth in image messages: every layout that drivers send, in place where it can be, and the refusals.
#include "depthgrid/messages/image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "depthgrid/messages/compressed_image.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::messages {
namespace {

using test::thrown_message;

/// 2 x 2 pixels: 1, 256, 3, 1000.
struct SmallImage {
  alignas(8) std::array<std::byte, 64> bytes{};
  Image image;

  template <class Pixel>
  SmallImage(const char* encoding, std::size_t offset, std::uint32_t step, bool big, std::array<Pixel, 4> pixels) {
    image.encoding = encoding;
    image.width = image.height = 2;
    image.step = step;
    image.is_bigendian = big ? 1 : 0;
    for (std::size_t i = 0; i < 4; ++i) {
      std::byte* at = bytes.data() + offset + (i / 2) * step + (i % 2) * sizeof(Pixel);
      std::memcpy(at, &pixels[i], sizeof(Pixel));
      if (big) {
        std::reverse(at, at + sizeof(Pixel));
      }
    }
    image.data = std::span<const std::byte>(bytes).subspan(offset, step + 2 * sizeof(Pixel));
  }
  SmallImage(const SmallImage&) = delete;
  SmallImage& operator=(const SmallImage&) = delete;
};

const std::array<std::uint16_t, 4> kUnits{1, 256, 3, 1000};
const std::array<float, 4> kMetres{0.25F, 1.5F, -2.0F, 1e-3F};

std::array<float, 4> depths(const DepthView& view) {
  std::array<float, 4> all{};
  for (int i = 0; i < 4; ++i) {
    all[static_cast<std::size_t>(i)] = measured_depth_m(view, {}, i % 2, i / 2).value_or(0.0F);
  }
  return all;
}

TEST(DepthImageMessage, EveryLayoutGivesTheSameDepths) {
  for (const char* encoding : {"16UC1", "mono16"}) {
    for (const bool big : {false, true}) {
      for (const std::size_t offset : {0U, 1U, 2U}) {
        for (const std::uint32_t step : {4U, 5U, 8U}) {
          const SmallImage small(encoding, offset, step, big, kUnits);
          DepthPixels pixels;
          const DepthView view = depth_view(small.image, pixels);
          EXPECT_EQ(depths(view), (std::array<float, 4>{0.001F, 0.256F, 0.003F, 1.0F}));
          const bool in_place = !big && offset % 2 == 0 && step % 2 == 0;
          EXPECT_EQ(view.data == small.image.data.data(), in_place) << offset << ' ' << step;
        }
      }
    }
  }
}

TEST(DepthImageMessage, FloatsAreMetres) {
  for (const bool big : {false, true}) {
    for (const std::size_t offset : {0U, 2U}) {
      const SmallImage small("32FC1", offset, 12, big, kMetres);
      DepthPixels pixels;
      const DepthView view = depth_view(small.image, pixels);
      EXPECT_EQ(depths(view), (std::array<float, 4>{0.25F, 1.5F, 0.0F, 1e-3F})) << big << offset;
      EXPECT_EQ(view.data == small.image.data.data(), !big && offset == 0);
    }
  }
}

TEST(DepthImageMessage, UnitsOfAnotherCamera) {
  const SmallImage small("16UC1", 0, 4, false, kUnits);
  DepthPixels pixels;
  EXPECT_EQ(depths(depth_view(small.image, pixels, 0.0005))[3], 0.5F);
}

TEST(DepthImageMessage, RefusesWhatDoesNotFit) {
  const auto why = [](auto change) {
    SmallImage small("16UC1", 0, 4, false, kUnits);
    change(small.image);
    return thrown_message([&] {
      DepthPixels pixels;
      static_cast<void>(depth_view(small.image, pixels));
    });
  };
  EXPECT_EQ(why([](Image&) {}), "");
  EXPECT_EQ(why([](Image& i) { i.encoding = "rgb8"; }),
            "the image's encoding is 'rgb8', a depth image needs 16UC1, mono16 or 32FC1");
  EXPECT_EQ(why([](Image& i) { i.width = 0; }), "the image is 0 x 2 pixels, a side must be from 1 to 16384");
  EXPECT_EQ(why([](Image& i) { i.height = 4294967295U; }),
            "the image is 2 x 4294967295 pixels, a side must be from 1 to 16384");
  EXPECT_EQ(why([](Image& i) { i.step = 3; }), "the image's step is 3 bytes, 2 pixels of 16UC1 need 4");
  EXPECT_EQ(why([](Image& i) { i.data = i.data.first(7); }),
            "the image has 7 bytes, 2 x 2 pixels of 16UC1 with a step of 4 need 8");
  EXPECT_EQ(why([](Image& i) { i.step = 4294967295U; }),
            "the image has 8 bytes, 2 x 2 pixels of 16UC1 with a step of 4294967295 need 4294967299");
}

std::vector<std::byte> as_bytes_of(std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

TEST(CompressedDepthMessage, ThePngComesAfterTwelveBytes) {
  const std::string data("\0\0\0\0\0\0\xC8\x42\0\0\x80\xBF\x89PNG\r\n\x1A\nrest", 24);
  const auto bytes = as_bytes_of(data);
  CompressedImage image;
  image.data = bytes;
  for (const char* format : {"16UC1; compressedDepth png", "16UC1; compressedDepth"}) {
    image.format = format;
    const CompressedDepth depth = compressed_depth(image);
    EXPECT_EQ(depth.quantisation_a, 100.0F);
    EXPECT_EQ(depth.quantisation_b, -1.0F);
    EXPECT_EQ(depth.png.data(), bytes.data() + 12);
    EXPECT_EQ(depth.png.size(), 12U);
    const auto again = as_bytes_of(compressed_depth_data(depth.png));
    image.data = again;
    EXPECT_TRUE(std::equal(depth.png.begin(), depth.png.end(), compressed_depth(image).png.begin()));
    image.data = bytes;
  }
}

TEST(CompressedDepthMessage, OtherPicturesAreRefused) {
  const auto bytes = as_bytes_of("0123456789012345678901234567890");
  const auto why = [&](const char* format) {
    CompressedImage image;
    image.format = format;
    image.data = bytes;
    return thrown_message([&] { static_cast<void>(compressed_depth(image)); });
  };
  EXPECT_EQ(why("rgb8; jpeg compressed bgr8"),
            "the image's format is 'rgb8; jpeg compressed bgr8', depth needs '16UC1; compressedDepth': other pictures "
            "have lost the depths");
  EXPECT_EQ(why("32FC1; compressedDepth png"),
            "the image's format is '32FC1; compressedDepth png': its inverse depths are rounded, so a reading may be "
            "farther than it was; record the raw topic");
  EXPECT_EQ(
      why("16UC1; compressedDepth rvl"),
      "the image's format is '16UC1; compressedDepth rvl', only 'png' is read; set the publisher's format to png, "
      "or record the raw topic");
  EXPECT_EQ(why("16UC1; compressedDepth png"),
            "the image's format is '16UC1; compressedDepth png', but its 31 bytes hold no PNG after the first 12");
  EXPECT_EQ(why("8UC1; compressedDepth png"),
            "the image's format is '8UC1; compressedDepth png', must begin with 16UC1");
}

}  // namespace
}  // namespace depthgrid::messages
