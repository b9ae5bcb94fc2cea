#include "depthgrid/grid/map/map_builder.hpp"

#include <chrono>
#include <cmath>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "depthgrid/grid/map/machine_memory.hpp"
#include "depthgrid/grid/map/map_calibration.hpp"
#include "depthgrid/grid/map/parallel_for.hpp"
#include "depthgrid/grid/map/pixel_list_rays.hpp"

namespace depthgrid::grid {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kListSafetyFactor = 1.25;
constexpr std::uint64_t kSampledRays = 1024;

std::uint64_t list_bytes(std::uint64_t rays, std::uint64_t cells, std::uint64_t rows) noexcept {
  return rays * sizeof(PixelListMap::RayHeader) + cells * sizeof(PixelListMap::Cell) +
         rows * sizeof(PixelListMap::RowSpan);
}

void refuse_if_too_large(const MapMemory& memory, const MapBuildSettings& settings) {
  const std::uint64_t limit = settings.memory_limit_bytes.value_or(available_memory_bytes());
  if (memory.bytes > limit) {
    fail("depth grid map: needs ", memory.safety_factor > 1 ? "an estimated " : "", memory.bytes,
         " bytes, more than the ", limit, " available; take fewer cells, a smaller image or the closed form");
  }
}

// Turns finished rows into progress over all passes of a build.
class Reporter {
 public:
  Reporter(const MapBuildSettings& settings, std::size_t total) : settings_(settings), total_(total) {}

  void pass(std::size_t rows, const std::function<void(std::size_t)>& work) {
    const bool complete =
        parallel_for(rows, settings_.threads, work, [this](std::size_t done) { return report(before_ + done); });
    if (!complete) {
      throw MapBuildCancelled("depth grid map: building was cancelled");
    }
    before_ += rows;
  }

 private:
  bool report(std::size_t done) {
    if (!settings_.progress) {
      return true;
    }
    MapBuildProgress progress{static_cast<std::int64_t>(done), static_cast<std::int64_t>(total_), std::nullopt};
    if (done > 0) {
      const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin_).count();
      progress.seconds_left = elapsed_s * static_cast<double>(total_ - done) / static_cast<double>(done);
    }
    return settings_.progress(progress);
  }

  const MapBuildSettings& settings_;
  std::size_t total_;
  std::size_t before_ = 0;
  Clock::time_point begin_ = Clock::now();
};

template <class Build>
auto or_out_of_memory(const Build& build) {
  try {
    return build();
  } catch (const std::bad_alloc&) {
    fail("depth grid map: the machine did not give the memory it announced; take fewer cells or the closed form");
  }
}

struct ListTables {
  std::vector<PixelListMap::RayHeader> rays;
  std::vector<PixelListMap::Cell> cells;
  std::vector<PixelListMap::RowSpan> rows;
};

}  // namespace

MapMemory estimate_map_memory(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries, MapStorage storage) {
  if (storage == MapStorage::closed_form) {
    return {};
  }
  const MapCalibration calibration = map_calibration(grid, secondaries);
  validate(calibration);
  const std::uint64_t rays = ray_count(calibration);
  if (storage == MapStorage::one_pixel) {
    return {cell_count(calibration) * secondaries.size() * sizeof(OnePixelMap::Cell), 1.0};
  }
  const ClosedFormMap closed_form(grid, secondaries);
  const std::uint64_t samples = std::min(rays, kSampledRays);
  std::uint64_t cells = 0;
  std::uint64_t rows = 0;
  for (std::size_t k = 0; k < secondaries.size(); ++k) {
    PixelListRays lists(grid, secondaries[k], closed_form, k);
    for (std::uint64_t i = 0; i < samples; ++i) {
      // Steps of the golden section visit rows and columns evenly whatever the image's size.
      const double place = std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0);
      const std::uint64_t ray = samples == rays ? i : static_cast<std::uint64_t>(place * static_cast<double>(rays));
      const auto width = static_cast<std::uint64_t>(grid.principal().width_px);
      const RayExtent extent = lists.count(static_cast<int>(ray % width), static_cast<int>(ray / width));
      cells += extent.n_count;
      rows += extent.row_count;
    }
  }
  const double factor = samples == rays ? 1.0 : kListSafetyFactor;
  const double share = static_cast<double>(rays) / static_cast<double>(samples) * factor;
  return {list_bytes(rays * secondaries.size(), 0, 0) +
              static_cast<std::uint64_t>(std::ceil(static_cast<double>(list_bytes(0, cells, rows)) * share)),
          factor};
}

OnePixelMap build_one_pixel_map(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries,
                                const MapBuildSettings& settings) {
  refuse_if_too_large(estimate_map_memory(grid, secondaries, MapStorage::one_pixel), settings);
  const MapCalibration calibration = map_calibration(grid, secondaries);
  const ClosedFormMap closed_form(grid, secondaries);
  return or_out_of_memory([&] {
    const auto cells = std::make_shared<std::vector<OnePixelMap::Cell>>(cell_count(calibration) * secondaries.size());
    const auto height = static_cast<std::size_t>(grid.principal().height_px);
    const auto depths = static_cast<std::size_t>(grid.count());
    const std::size_t row_cells = static_cast<std::size_t>(grid.principal().width_px) * depths;
    Reporter reporter(settings, height * secondaries.size());
    reporter.pass(height * secondaries.size(), [&](std::size_t piece) {
      OnePixelMap::Cell* cell = cells->data() + piece * row_cells;
      for (int u = 0; u < grid.principal().width_px; ++u) {
        const ClosedFormMap::Ray ray = closed_form.ray(u, static_cast<int>(piece % height), piece / height);
        for (int n = 0; n < grid.count(); ++n, ++cell) {
          CellPixel pixel;
          *cell = ray.pixel(n, pixel) ? OnePixelMap::Cell{static_cast<std::uint16_t>(pixel.u_px),
                                                          static_cast<std::uint16_t>(pixel.v_px), pixel.d_start_m}
                                      : OnePixelMap::Cell{OnePixelMap::kNotInvolved, OnePixelMap::kNotInvolved, 0};
        }
      }
    });
    return OnePixelMap(calibration, *cells, cells);
  });
}

PixelListMap build_pixel_list_map(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries,
                                  const MapBuildSettings& settings) {
  refuse_if_too_large(estimate_map_memory(grid, secondaries, MapStorage::pixel_lists), settings);
  const MapCalibration calibration = map_calibration(grid, secondaries);
  const ClosedFormMap closed_form(grid, secondaries);
  const auto width = static_cast<std::size_t>(grid.principal().width_px);
  const auto height = static_cast<std::size_t>(grid.principal().height_px);
  Reporter reporter(settings, 2 * height * secondaries.size());
  return or_out_of_memory([&] {
    const auto tables = std::make_shared<ListTables>();
    tables->rays.resize(width * height * secondaries.size());
    const auto each_ray = [&](std::size_t piece, const auto& visit) {
      PixelListRays lists(grid, secondaries[piece / height], closed_form, piece / height);
      for (std::size_t u = 0; u < width; ++u) {
        visit(lists, piece * width + u, static_cast<int>(u), static_cast<int>(piece % height));
      }
    };
    reporter.pass(height * secondaries.size(), [&](std::size_t piece) {
      each_ray(piece, [&](PixelListRays& lists, std::size_t ray, int u, int v) {
        const RayExtent extent = lists.count(u, v);
        tables->rays[ray] = {0, extent.row_count, extent.n_first, extent.n_count, 0};
      });
    });
    std::uint64_t cells = 0;
    std::uint64_t rows = 0;
    for (PixelListMap::RayHeader& header : tables->rays) {
      header.cell_begin = cells;
      cells += header.n_count;
      header.row_begin = std::exchange(rows, rows + header.row_begin);
    }
    refuse_if_too_large({list_bytes(tables->rays.size(), cells, rows), 1.0}, settings);
    tables->cells.resize(cells);
    tables->rows.resize(rows);
    reporter.pass(height * secondaries.size(), [&](std::size_t piece) {
      each_ray(piece, [&](PixelListRays& lists, std::size_t ray, int u, int v) {
        const PixelListMap::RayHeader& header = tables->rays[ray];
        lists.write(u, v, header, tables->cells.data() + header.cell_begin, tables->rows.data() + header.row_begin);
      });
    });
    return PixelListMap(calibration, {tables->rays, tables->cells, tables->rows}, tables);
  });
}

DepthGridMap build_map(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries, MapStorage storage,
                       const MapBuildSettings& settings) {
  switch (storage) {
    case MapStorage::one_pixel:
      return build_one_pixel_map(grid, secondaries, settings);
    case MapStorage::pixel_lists:
      return build_pixel_list_map(grid, secondaries, settings);
    case MapStorage::closed_form:
      break;
  }
  return ClosedFormMap(grid, secondaries);
}

std::uint64_t table_bytes(const DepthGridMap& map) noexcept {
  if (const auto* one_pixel = std::get_if<OnePixelMap>(&map)) {
    return one_pixel->cells().size_bytes();
  }
  if (const auto* lists = std::get_if<PixelListMap>(&map)) {
    return lists->tables().rays.size_bytes() + lists->tables().cells.size_bytes() + lists->tables().rows.size_bytes();
  }
  return 0;
}

}  // namespace depthgrid::grid
