// Text on a machine without any font.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "report/canvas.hpp"

namespace depthgrid::report {
namespace {

TEST(NoFont, TextFallsBackAndDrawingGoesOn) {
  const auto folder = std::filesystem::temp_directory_path() / "depthgrid_no_font";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "fonts.conf") << "<?xml version=\"1.0\"?><fontconfig></fontconfig>\n";
  // Before anything has asked for a font in this process.
  ASSERT_EQ(setenv("FONTCONFIG_FILE", (folder / "fonts.conf").c_str(), 1), 0);
  Canvas canvas(100, 40);
  canvas.text({2, 20}, "distance (m) \xc2\xb5", 14);
  canvas.fill({50, 30, 5, 5}, {1, 0, 0});
  EXPECT_GT(canvas.text_width_px("distance", 14), 10);
  canvas.save_png(folder / "picture.png");
  EXPECT_GT(std::filesystem::file_size(folder / "picture.png"), 100U);
  canvas.save_svg(folder / "picture.svg");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace depthgrid::report
