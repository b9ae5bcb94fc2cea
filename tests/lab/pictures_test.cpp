// The pictures that explain the pages: drawn again, they are the ones in docs/images, and each page shows its own.
#include "lab/pictures/pictures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "files/temporary_folder.hpp"
#include "lab/pictures/flat_world.hpp"

namespace depthgrid::lab {
namespace {

using test::read_bytes;
using test::TemporaryFolder;

constexpr std::size_t kLargestFile = 150'000;

/// A big-endian number of a PNG's header.
std::size_t number(const std::string& png, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = 256 * value + static_cast<unsigned char>(png.at(at + i));
  }
  return value;
}

/// Texts are those of another font, or roundings those of another processor: then bytes cannot be compared.
bool draws_as_committed() {
#if defined(__x86_64__)
  return std::abs(report::Canvas(1, 1).text_width_px("known free", 100) - 559) < 1;
#else
  return false;
#endif
}

class ExplainingPictures : public ::testing::TestWithParam<ExplainingPicture> {};

TEST_P(ExplainingPictures, IsDrawnAsCommittedAndShownOnItsPage) {
  const std::string docs = DEPTHGRID_DOCS;
  const std::string name = file_name(GetParam());
  const TemporaryFolder folder;
  GetParam().draw().save_png(folder / name);
  const std::string drawn = read_bytes(folder / name);
  const std::string committed = read_bytes(docs + "/images/" + name);
  ASSERT_GT(committed.size(), 24U) << name << " is not in docs/images";
  EXPECT_LT(committed.size(), kLargestFile);
  EXPECT_EQ(number(committed, 16), 2 * static_cast<std::size_t>(kSheetWidth));
  EXPECT_EQ(number(committed, 16), number(drawn, 16));
  EXPECT_EQ(number(committed, 20), number(drawn, 20));
  EXPECT_THAT(read_bytes(docs + "/" + GetParam().page + ".md"), ::testing::HasSubstr("](images/" + name + ")"));
  if (!draws_as_committed()) {
    GTEST_SKIP() << "another font or processor than the committed pictures were drawn with: bytes are not compared";
  }
  EXPECT_TRUE(drawn == committed) << "draw it anew: depthgrid-lab pictures";
}

INSTANTIATE_TEST_SUITE_P(Pages, ExplainingPictures, ::testing::ValuesIn(kExplainingPictures),
                         [](const auto& page) { return std::string(page.param.page); });

TEST(FlatWorld, FreesWhatDocsMethodDefines) {
  const FlatSolid disc{{2, 0}, {2, 0}, 0.5};
  const FlatCamera camera{{0, 0}, {1, 0}, 0.5, 101, 0.3, 4};
  const FlatView view(camera, std::span(&disc, 1), 0.1);
  EXPECT_TRUE(view.frees({1.35, 0}));
  EXPECT_FALSE(view.frees({1.45, 0})) << "within the margin";
  EXPECT_FALSE(view.frees({3, 0})) << "in the shadow";
  EXPECT_TRUE(view.frees({3, 1.2})) << "beside it";
  EXPECT_FALSE(view.frees({0.2, 0})) << "nearer than near";
  EXPECT_FALSE(view.frees({3, 2})) << "outside the image";
  EXPECT_TRUE(view.frees({1.35, 0}, 0.04));
  EXPECT_FALSE(view.frees({1.35, 0}, 0.06)) << "the ball reaches into the margin";
}

TEST(FlatWorld, ARobotPixelIsFreeUpToThePaddedExit) {
  const FlatSolid link{{2, 0}, {2, 0}, 0.5};
  const FlatSolid padded{{2, 0}, {2, 0}, 0.6};
  const FlatView view({{0, 0}, {1, 0}, 0.5, 101, 0.3, 4}, std::span(&link, 1), 0, 0, std::span(&padded, 1));
  EXPECT_TRUE(view.frees({2.55, 0}));
  EXPECT_FALSE(view.frees({2.65, 0}));
}

}  // namespace
}  // namespace depthgrid::lab
