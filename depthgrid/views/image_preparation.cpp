#include "depthgrid/views/image_preparation.hpp"

#include <array>
#include <cstring>

#include "depthgrid/views/pyramid_rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/views/image_preparation.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: seen once for each target.
#include <hwy/highway.h>

#include "depthgrid/views/code_rows-inl.hpp"
#include "depthgrid/views/depth_rows-inl.hpp"
#include "depthgrid/views/reading_rows-inl.hpp"
#include "depthgrid/views/robot_rows-inl.hpp"
#include "depthgrid/views/vector_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::views::HWY_NAMESPACE {

/// The passes over one image. Rows are taken in as soon as the next ones need them. kRadius is w, or 0 where it is not
/// known here.
template <bool kUnits, int kRadius>
class Passes {
 public:
  HWY_INLINE Passes(const Reading& reading, const NewImage& image, PreparationRows& rows, PreparedImage& result)
      : reading_(reading),
        image_(image),
        rows_(rows),
        result_(result),
        width_px_(image.depth.width_px),
        height_px_(image.depth.height_px),
        narrow_(kUnits && reading.ascending && image.radius_px > 0) {}

  HWY_INLINE PixelRange run() {
    rows_.columns().begin(!narrow_);
    PixelRange island_rows;
    int next = 0;
    int searched = 0;
    // Level 0 lags behind by three rows, whose texels cover the rows below them.
    for (int v = 0; v < height_px_ + 3; v += 2) {
      const int end = std::min(v + 2 + image_.radius_px, height_px_);
      for (; image_.robot.near_m != nullptr && searched < std::min(end + rows_.columns().lookahead(), height_px_);
           ++searched) {
        rows_.columns().add_robot(searched, robot_columns(image_, searched));
      }
      take(next, end);
      next = end;
      if (v < height_px_) {
        island_rows = joined(island_rows, free_rows(v));
      }
      first_level(v - 3);
    }
    return island_rows;
  }

 private:
  /// Rows [begin, end) of the image. One pass over all of them after the other: a pass that reads what the one before
  /// has just written, but at other columns, waits until it has reached the cache.
  HWY_INLINE void take(int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const char* source = static_cast<const char*>(image_.depth.data) + image_.depth.stride_bytes * v;
      if constexpr (kUnits) {
        decode_row(reading_, reinterpret_cast<const std::uint16_t*>(source), 2 * image_.depth.stride_bytes, width_px_,
                   pixel_row(reinterpret_cast<std::uint16_t*>(result_.kept.data()), width_px_, v), rows_.codes(v));
      } else {
        std::memcpy(pixel_row(reinterpret_cast<float*>(result_.kept.data()), width_px_, v), source,
                    static_cast<std::size_t>(width_px_) * sizeof(float));
      }
    }
    for (; begin < end; begin += 2) {
      const int pair_end = std::min(begin + 2, end);
      for (int v = begin; v < pair_end; ++v) {
        reduce(v, rows_.columns().reduced(v));
      }
      for (int v = begin; v < pair_end; ++v) {
        filter_row<kRadius>(rows_.reduced_m(v), rows_.columns().filtered(v), image_.radius_px, rows_.minimum_m(v));
      }
    }
  }

  /// A row in single precision.
  HWY_INLINE void reduce(int v, const PixelRange& columns) {
    if (columns.empty()) {
      return;
    }
    if constexpr (kUnits) {
      reduce_row(FewUnits(), UnitReader<true>(reading_), reading_.of_units, image_, v, rows_.codes(v), columns, rows_,
                 pixel_row(result_.free_m.data(), width_px_, v));
    } else {
      reduce_row(Floats(), MetreReader(reading_), reading_.of_metres, image_, v,
                 pixel_row(reinterpret_cast<const float*>(result_.kept.data()), width_px_, v), columns, rows_,
                 pixel_row(result_.free_m.data(), width_px_, v));
    }
  }

  /// Columns that are not worked out in single precision.
  template <class Body>
  HWY_INLINE void in_codes(const PixelRange& in_floats, const Body& body) {
    if (in_floats.empty()) {
      body(PixelRange{0, width_px_});
    } else {
      body(PixelRange{0, in_floats.begin});
      body(PixelRange{in_floats.end, width_px_});
    }
  }

  /// body(converter) with the converter that this camera's reading needs.
  template <class Body>
  HWY_INLINE void with_converter(const Body& body) {
    reading_.has_beyond ? body(CodeConverter<true>(reading_)) : body(CodeConverter<false>(reading_));
  }

  /// g of the rows v and v + 1 where codes give it.
  template <class Converter>
  HWY_INLINE void free_rows_of_codes(int v, const Converter& convert) {
    std::array<const std::uint16_t*, 2 * (kRadius > 0 ? kRadius : kMaxFilterRadius) + 2> rows{};
    for (int i = 0; i < 2 * image_.radius_px + 2; ++i) {
      rows[i] = rows_.codes(v - image_.radius_px + i);
    }
    narrow_minima<kRadius>(rows.data(), width_px_, image_.radius_px, rows_.narrow_minimum(v),
                           rows_.narrow_minimum(v + 1));
    for (int row = v; row < std::min(v + 2, height_px_); ++row) {
      float* free_m = pixel_row(result_.free_m.data(), width_px_, row);
      in_codes(rows_.columns().free(row), [&](const PixelRange& columns) HWY_ATTR {
        free_of_codes<kRadius>(convert, rows_.narrow_minimum(row), image_.radius_px, columns, width_px_,
                               rows_.narrow_free(row), free_m);
      });
    }
  }

  /// The rows v and v + 1; returns those with islands.
  HWY_INLINE PixelRange free_rows(int v) {
    PixelRange island_rows;
    if (narrow_) {
      with_converter([&](const auto& convert) HWY_ATTR { free_rows_of_codes(v, convert); });
    }
    const int end = std::min(v + 2, height_px_);
    for (int row = v; row < end; ++row) {
      filter_columns<kRadius>(rows_, rows_.columns().free(row), image_.radius_px, row, has_own_limits(image_),
                              pixel_row(result_.free_m.data(), width_px_, row));
    }
    for (int row = v; row < end; ++row) {
      float* free_m = pixel_row(result_.free_m.data(), width_px_, row);
      const PixelRange robot = image_.robot.near_m != nullptr ? rows_.columns().robot(row) : PixelRange{};
      if (!robot.empty() && join_robot(image_, row, robot, result_, free_m)) {
        island_rows = joined(island_rows, {row, row + 1});
      }
    }
    for (int row = v; row < end; ++row) {
      const float* free_m = pixel_row(result_.free_m.data(), width_px_, row);
      window_row(Smaller(), free_m, width_px_, rows_.columns().windows(row), rows_.window_m(row));
    }
    return island_rows;
  }

  /// The rows j and j + 1 of level 0, and what can be made of them.
  HWY_INLINE void first_level(int j) {
    float* level = result_.minima_m.data() + result_.levels[0].offset;
    for (int row = std::max(j, 0); row < std::min(j + 2, height_px_); ++row) {
      float* texels = pixel_row(level, width_px_, row);
      if (narrow_) {
        with_converter([&](const auto& convert) HWY_ATTR {
          in_codes(rows_.columns().texels(row), [&](const PixelRange& columns) HWY_ATTR {
            texels_of_codes(convert, rows_.narrow_free(row), rows_.narrow_free(row + 3), columns, width_px_, texels);
          });
        });
      }
      first_level_row(rows_, rows_.columns().texels(row), row, texels);
      minimum_rows_above(result_.levels, row, result_.minima_m.data());
    }
  }

  const Reading& reading_;
  const NewImage& image_;
  PreparationRows& rows_;
  PreparedImage& result_;
  int width_px_;
  int height_px_;
  bool narrow_;  ///< filter codes, and single precision only where the robot asks for it
};

template <bool kUnits>
HWY_INLINE PixelRange prepare_as(const Reading& reading, const NewImage& image, PreparationRows& rows,
                                 PreparedImage& result) {
  return image.radius_px == 1 ? Passes<kUnits, 1>(reading, image, rows, result).run()
                              : Passes<kUnits, 0>(reading, image, rows, result).run();
}

PixelRange prepare(const Reading& reading, const NewImage& image, PreparationRows& rows, PreparedImage& result) {
  return image.depth.format == DepthFormat::uint16_units ? prepare_as<true>(reading, image, rows, result)
                                                         : prepare_as<false>(reading, image, rows, result);
}

}  // namespace depthgrid::views::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::views {

HWY_EXPORT(prepare);

PixelRange prepare(const Reading& reading, const NewImage& image, PreparationRows& rows,
                   PreparedImage& result) noexcept {
  return HWY_DYNAMIC_DISPATCH(prepare)(reading, image, rows, result);
}

}  // namespace depthgrid::views
#endif
