// How many pixels of a PNG picture have a colour.
#pragma once

#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace depthgrid::test {

class PictureColours {
 public:
  /// Of the rows above `rows_px`, or all.
  explicit PictureColours(const std::filesystem::path& file, int rows_px = 1 << 20) {
    cairo_surface_t* const image = cairo_image_surface_create_from_png(file.c_str());
    EXPECT_EQ(cairo_surface_status(image), CAIRO_STATUS_SUCCESS) << file;
    const unsigned char* const data = cairo_image_surface_get_data(image);
    for (int v = 0; v < std::min(rows_px, cairo_image_surface_get_height(image)); ++v) {
      for (int u = 0; u < cairo_image_surface_get_width(image); ++u) {
        const unsigned char* const pixel = data + v * cairo_image_surface_get_stride(image) + 4 * u;  // blue first
        ++counts_[pixel[2] << 16 | pixel[1] << 8 | pixel[0]];
      }
    }
    cairo_surface_destroy(image);
  }

  /// Pixels within 12 of each part.
  [[nodiscard]] long of(int red, int green, int blue) const {
    constexpr int kNear = 12;
    long sum = 0;
    for (const auto& [colour, count] : counts_) {
      const bool near = std::abs((colour >> 16) - red) <= kNear && std::abs((colour >> 8 & 0xff) - green) <= kNear &&
                        std::abs((colour & 0xff) - blue) <= kNear;
      sum += near ? count : 0;
    }
    return sum;
  }

 private:
  std::map<int, long> counts_;
};

}  // namespace depthgrid::test
