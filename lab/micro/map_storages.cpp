// What the storages of the depth grid map cost: time to build, size, and time to look a cell up beside the closed form.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/grid/map/map_builder.hpp"
#include "lab/machine.hpp"

namespace {

using namespace depthgrid;

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

/// CPU time in seconds: what other programs take of the cores does not count.
double cpu_time_s(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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
  std::vector<double> ns;
  Lookup result;
  for (int window = 0; window < windows; ++window) {
    const int u0 = static_cast<int>(random() % static_cast<unsigned>(camera.width_px - kSide));
    const int v0 = static_cast<int>(random() % static_cast<unsigned>(camera.height_px - kSide));
    const int n0 = static_cast<int>(random() % static_cast<unsigned>(s.grid.count() - kWalk));
    const double begin_s = cpu_time_s(CLOCK_THREAD_CPUTIME_ID);
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
    ns.push_back(1e9 * (cpu_time_s(CLOCK_THREAD_CPUTIME_ID) - begin_s) / cells);
  }
  std::nth_element(ns.begin(), ns.begin() + windows / 2, ns.end());
  result.ns_a_cell = ns[static_cast<std::size_t>(windows) / 2];
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

struct Options {
  bool quick = false;
  std::string page;
};

class Bench {
 public:
  explicit Bench(const Options& options) : windows_(options.quick ? 31 : 201) {
    add("| storage | image x depths | secondary cameras | built in s (CPU s) | size GiB | pixels a cell | look-up ns a "
        "cell | closed form ns a cell |");
    add("|---|---|---|---|---|---|---|---|");
  }

  void run(grid::MapStorage storage, int width_px, int depths, int cameras) {
    const Setting s = setting(width_px, depths, cameras);
    const auto begin = std::chrono::steady_clock::now();
    const double begin_cpu_s = cpu_time_s(CLOCK_PROCESS_CPUTIME_ID);
    const grid::DepthGridMap map = grid::build_map(s.grid, s.secondaries, storage);
    const double cpu_s = cpu_time_s(CLOCK_PROCESS_CPUTIME_ID) - begin_cpu_s;
    const double built_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const grid::ClosedFormMap closed_form(s.grid, s.secondaries);
    const Lookup computed = look_up(closed_form, s, windows_);
    const Lookup stored = std::visit([&](const auto& any) { return look_up(any, s, windows_); }, map);
    const auto* lists = std::get_if<grid::PixelListMap>(&map);
    if (lists == nullptr ? stored.confirmed != computed.confirmed : stored.confirmed < computed.confirmed) {
      throw std::runtime_error("the storages do not confirm the same cells");
    }
    const ListCount count = lists != nullptr ? count_pixels(*lists) : ListCount{1, 0};
    std::array<char, 256> line{};
    (void)std::snprintf(
        line.data(), line.size(), "| %s | %d x %d x %d | %d | %.2f (%.2f) | %.3f | %.2f | %.1f | %.1f |",
        lists != nullptr ? "full lists" : "one pixel", width_px, width_px * 3 / 4, depths, cameras, built_s, cpu_s,
        static_cast<double>(grid::table_bytes(map)) / kGiB, count.pixels_a_cell, stored.ns_a_cell, computed.ns_a_cell);
    add(line.data());
    if (lists != nullptr) {
      (void)std::snprintf(
          line.data(), line.size(),
          "- %d x %d x %d, %d secondary: the same lists with every pixel written out would take %.3f GiB", width_px,
          width_px * 3 / 4, depths, cameras, count.written_out_bytes / kGiB);
      notes_.push_back(line.data());
    }
  }

  /// What full lists of a larger image would take, from a sample of its rays.
  void project_size(int width_px, int depths, int cameras) {
    const Setting s = setting(width_px, depths, cameras);
    const grid::MapMemory memory = grid::estimate_map_memory(s.grid, s.secondaries, grid::MapStorage::pixel_lists);
    std::array<char, 256> line{};
    (void)std::snprintf(line.data(), line.size(), "- full lists at %d x %d x %d, %d secondary: %.2f GiB (computed)",
                        width_px, width_px * 3 / 4, depths, cameras,
                        static_cast<double>(memory.bytes) / memory.safety_factor / kGiB);
    notes_.push_back(line.data());
  }

  [[nodiscard]] std::string text() const {
    std::string all = "Machine: " + lab::machine_line() + "\nBuilding uses all cores, looking up one.\n\n";
    for (const std::string& line : table_) {
      all += line + "\n";
    }
    all += "\n";
    for (const std::string& line : notes_) {
      all += line + "\n";
    }
    return all;
  }

 private:
  void add(std::string line) {
    std::printf("%s\n", line.c_str());
    (void)std::fflush(stdout);
    table_.push_back(std::move(line));
  }

  int windows_;
  std::vector<std::string> table_;
  std::vector<std::string> notes_;
};

/// Puts the text between the page's two markers.
void write_page(const std::string& file, const std::string& text) {
  const std::string begin = "<!-- measured: begin -->\n";
  const std::string end = "<!-- measured: end -->";
  std::ifstream in(file, std::ios::binary);
  std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::size_t from = page.find(begin);
  const std::size_t to = page.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    throw std::runtime_error(file + ": has no lines <!-- measured: begin --> and <!-- measured: end -->");
  }
  page.replace(from + begin.size(), to - from - begin.size(), text);
  std::ofstream out(file, std::ios::binary);
  out << page;
  if (!out.flush()) {
    throw std::runtime_error(file + ": cannot be written");
  }
}

void run(const Options& options) {
  using grid::MapStorage;
  const int large_px = options.quick ? 160 : 640;
  const int small_px = options.quick ? 80 : 160;
  const int depths = options.quick ? 100 : 343;
  Bench bench(options);
  for (const int cameras : {1, 2, 4}) {
    bench.run(MapStorage::one_pixel, large_px, depths, cameras);
  }
  bench.run(MapStorage::pixel_lists, large_px, depths, 1);
  for (const int cameras : {2, 4}) {
    bench.run(MapStorage::pixel_lists, small_px, depths, cameras);
    bench.project_size(large_px, depths, cameras);
  }
  const std::string text = bench.text();
  std::printf("\n%s", text.c_str());
  if (!options.page.empty()) {
    write_page(options.page, text);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Build time, size and look-up cost of the depth grid map's storages.");
  Options options;
  app.add_flag("--quick", options.quick, "small images, less than 200 MB in all");
  app.add_option("--page", options.page, "page whose measured part is replaced, docs/depth-grid-map.md");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    (void)std::fprintf(stderr, "depthgrid_map_storages: %s\n", error.what());
    return 1;
  }
  return 0;
}
