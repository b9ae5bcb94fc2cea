// What the storages of the depth grid map cost: time to build, size, and time to look a cell up beside the closed form.
#include <CLI/CLI.hpp>
#include <array>
#include <iostream>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/grid/map/map_builder.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "report/machine.hpp"
#include "report/markdown_table.hpp"
#include "report/marked_page.hpp"
#include "report/number_text.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

/// A principal camera that looks at a point 2 m ahead, and up to four others around that point, as far from it.
struct Setting {
  grid::DepthGrid grid;
  std::vector<grid::SecondaryCamera> secondaries;
};

Setting setting(int width_px, int depths, int cameras) {
  const double f_px = 525.0 * width_px / 640;
  const int height_px = width_px * 3 / 4;
  const PinholeCamera camera{width_px, height_px, f_px, f_px, width_px / 2.0, height_px / 2.0};
  Setting result{grid::DepthGrid(camera, {0.2882, 0.01 * 343 / depths, 0.0, depths}), {}};
  constexpr std::array<double, 4> kAnglesDeg{90, 180, -60, 30};
  for (int k = 0; k < cameras; ++k) {
    const double angle = kAnglesDeg.at(static_cast<std::size_t>(k)) * std::numbers::pi / 180;
    const Eigen::Vector3d target(0, 0, 2);
    const Eigen::Vector3d place = target + 2 * Eigen::Vector3d(std::sin(angle), -0.2, -std::cos(angle));
    result.secondaries.push_back({camera, look_at(place, target, Eigen::Vector3d(0, -1, 0)).inverse()});
  }
  return result;
}

struct Lookup {
  double ns_a_cell = 0;
  std::int64_t confirmed = 0;
};

/// Cells in the order in which an evaluation asks for them: windows of pixels row by row, along each ray the cells
/// outward from the surface, camera by camera.
template <class Map>
Lookup look_up(const Map& map, const Setting& s, int windows) {
  const PinholeCamera& camera = s.grid.principal();
  std::mt19937 random(1);
  std::vector<float> depth_m(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
  for (float& d : depth_m) {
    d = std::uniform_real_distribution<float>(0.5F, 4.0F)(random);
  }
  constexpr int kSide = 48;
  constexpr int kWalk = 40;
  Samples ns;
  Lookup result;
  for (int window = 0; window < windows; ++window) {
    const int u0 = static_cast<int>(random() % static_cast<unsigned>(camera.width_px - kSide));
    const int v0 = static_cast<int>(random() % static_cast<unsigned>(camera.height_px - kSide));
    const int n0 = static_cast<int>(random() % static_cast<unsigned>(s.grid.count() - kWalk));
    const double begin_s = processor_time_s();
    for (int v = v0; v < v0 + kSide; ++v) {
      for (int u = u0; u < u0 + kSide; ++u) {
        for (std::size_t k = 0; k < map.camera_count(); ++k) {
          const auto ray = map.ray(u, v, k);
          for (int n = n0; n < n0 + kWalk; ++n) {
            result.confirmed += ray.confirm(n, depth_m.data()) == grid::Confirmation::confirmed ? 1 : 0;
          }
        }
      }
    }
    const double cells = static_cast<double>(kSide) * kSide * kWalk * static_cast<double>(map.camera_count());
    ns.add(1e9 * (processor_time_s() - begin_s) / cells);
  }
  result.ns_a_cell = ns.median();
  return result;
}

/// What the lists would take with four bytes a pixel, written out one by one, and eight a cell.
struct ListCount {
  double pixels_a_cell = 0;
  double written_out_bytes = 0;
};

ListCount count_pixels(const grid::PixelListMap& lists) {
  double pixels = 0;
  double cells = 0;
  for (const grid::PixelListMap::RowSpan& span : lists.tables().rows) {
    pixels += span.u_last_px - span.u_first_px + 1;
  }
  for (const grid::PixelListMap::Cell& cell : lists.tables().cells) {
    cells += cell.row_count > 0 ? 1 : 0;
  }
  const double all_cells =
      static_cast<double>(grid::cell_count(lists.calibration())) * static_cast<double>(lists.camera_count());
  return {cells > 0 ? pixels / cells : 0, 4 * pixels + 8 * all_cells};
}

struct StoragesOptions {
  bool quick = false;
  std::string page;
};

std::string gib(double bytes, int digits) { return report::fixed(bytes / kGiB, digits); }

class Bench {
 public:
  explicit Bench(int windows) : windows_(windows) {}

  void run(grid::MapStorage storage, int width_px, int depths, int cameras) {
    progress_.update(done_++);
    const Setting s = setting(width_px, depths, cameras);
    const Stopwatch watch;
    const double begin_cpu_s = process_time_s();
    const grid::DepthGridMap map = grid::build_map(s.grid, s.secondaries, storage);
    const double cpu_s = process_time_s() - begin_cpu_s;
    const double built_s = watch.elapsed_s();
    const grid::ClosedFormMap closed_form(s.grid, s.secondaries);
    const Lookup computed = look_up(closed_form, s, windows_);
    const Lookup stored = std::visit([&](const auto& any) { return look_up(any, s, windows_); }, map);
    const auto* lists = std::get_if<grid::PixelListMap>(&map);
    if (lists == nullptr ? stored.confirmed != computed.confirmed : stored.confirmed < computed.confirmed) {
      fail("the storages do not confirm the same cells");
    }
    const ListCount count = lists != nullptr ? count_pixels(*lists) : ListCount{1, 0};
    table_.row({lists != nullptr ? "full lists" : "one pixel", size_text(width_px, depths), std::to_string(cameras),
                report::fixed(built_s, 2) + " (" + report::fixed(cpu_s, 2) + ")",
                gib(static_cast<double>(grid::table_bytes(map)), 3), report::fixed(count.pixels_a_cell, 2),
                report::fixed(stored.ns_a_cell, 1), report::fixed(computed.ns_a_cell, 1)});
    if (lists != nullptr) {
      notes_ += "- " + size_text(width_px, depths) + ", " + std::to_string(cameras) +
                " secondary: the same lists with every pixel written out would take " +
                gib(count.written_out_bytes, 3) + " GiB\n";
    }
  }

  /// What full lists of a larger image would take, from a sample of its rays.
  void project_size(int width_px, int depths, int cameras) {
    const Setting s = setting(width_px, depths, cameras);
    const grid::MapMemory memory = grid::estimate_map_memory(s.grid, s.secondaries, grid::MapStorage::pixel_lists);
    notes_ += "- full lists at " + size_text(width_px, depths) + ", " + std::to_string(cameras) +
              " secondary: " + gib(static_cast<double>(memory.bytes) / memory.safety_factor, 2) + " GiB (computed)\n";
  }

  [[nodiscard]] std::string text() const {
    return "Machine: " + report::machine_line() + "\nBuilding uses all cores, looking up one.\n\n" + table_.text() +
           "\n\n" + notes_;
  }

 private:
  static std::string size_text(int width_px, int depths) {
    return std::to_string(width_px) + " x " + std::to_string(width_px * 3 / 4) + " x " + std::to_string(depths);
  }

  int windows_;
  report::MarkdownTable table_{{"storage", "image x depths", "secondary cameras", "built in s (CPU s)", "size GiB",
                                "pixels a cell", "look-up ns a cell", "closed form ns a cell"}};
  std::string notes_;
  report::ProgressLine progress_{"map", 6};
  std::size_t done_ = 0;
};

void measure_all(const StoragesOptions& options) {
  using grid::MapStorage;
  const int large_px = options.quick ? 160 : 640;
  const int small_px = options.quick ? 80 : 160;
  const int depths = options.quick ? 100 : 343;
  Bench bench(options.quick ? 31 : 201);
  for (const int cameras : {1, 2, 4}) {
    bench.run(MapStorage::one_pixel, large_px, depths, cameras);
  }
  bench.run(MapStorage::pixel_lists, large_px, depths, 1);
  for (const int cameras : {2, 4}) {
    bench.run(MapStorage::pixel_lists, small_px, depths, cameras);
    bench.project_size(large_px, depths, cameras);
  }
  const std::string text = bench.text();
  std::cout << text;
  if (!options.page.empty()) {
    report::write_between(options.page, "<!-- measured: begin -->", "<!-- measured: end -->", text);
  }
}

}  // namespace

void add_map_storages_command(CLI::App& app) {
  const auto options = std::make_shared<StoragesOptions>();
  CLI::App* const command = app.add_subcommand(
      "map-storages", "build time, size and look-up cost of the depth grid map's storages: minutes, --quick seconds");
  command->add_flag("--quick", options->quick, "small images, less than 200 MB in all");
  command->add_option("--page", options->page, "page whose measured part is replaced, docs/depth-grid-map.md");
  command->callback([options] { measure_all(*options); });
}

}  // namespace depthgrid::lab
