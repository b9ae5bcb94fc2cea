// Writes the seeds of map_fuzzer: small good maps of either storage. Usage: map_seeds FOLDER
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/grid/map/map_builder.hpp"
#include "depthgrid/grid/map/map_file.hpp"

namespace {

namespace grid = depthgrid::grid;
namespace fs = std::filesystem;

constexpr char kFitEverything = 7;  // map_fuzzer's first byte

void write_seed(const fs::path& file, const grid::DepthGridMap& map) {
  const fs::path plain = file.string() + ".map";
  grid::save_map(map, plain.string());
  std::ofstream seed(file, std::ios::binary);
  seed.put(kFitEverything) << std::ifstream(plain, std::ios::binary).rdbuf();
  seed.close();
  fs::remove(plain);
}

void write_seeds(const fs::path& folder) {
  fs::create_directories(folder);
  const grid::DepthGrid depth_grid({3, 2, 3, 3, 1.5, 1}, {0.3, 0.2, 0.05, 4});
  const depthgrid::Pose beside = depthgrid::look_at({1, 0, 1}, {0, 0, 0.8}, {0, -1, 0});
  const depthgrid::Pose facing = depthgrid::look_at({0.1, 0, 2}, {0, 0, 0.8}, {0, -1, 0});
  const std::vector<grid::SecondaryCamera> cameras{{{6, 4, 5, 5, 3, 2}, beside.inverse()},
                                                   {{3, 5, 3, 3, 1.5, 2.5}, facing.inverse()}};
  const std::span<const grid::SecondaryCamera> one(cameras.data(), 1);
  write_seed(folder / "one_pixel_1", grid::build_one_pixel_map(depth_grid, one));
  write_seed(folder / "one_pixel_2", grid::build_one_pixel_map(depth_grid, cameras));
  write_seed(folder / "lists_1", grid::build_pixel_list_map(depth_grid, one));
  write_seed(folder / "lists_2", grid::build_pixel_list_map(depth_grid, cameras));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    (void)std::fprintf(stderr, "usage: map_seeds FOLDER\n");
    return 2;
  }
  try {
    write_seeds(argv[1]);
  } catch (const std::exception& error) {
    (void)std::fprintf(stderr, "map_seeds: %s\n", error.what());
    return 1;
  }
  return 0;
}
