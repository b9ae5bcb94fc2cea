#include "program/map/map_command.hpp"

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/rectification.hpp"
#include "depthgrid/files/foreign_recording.hpp"
#include "depthgrid/files/rig_file.hpp"
#include "depthgrid/grid/map/machine_memory.hpp"
#include "depthgrid/grid/map/map_builder.hpp"
#include "depthgrid/grid/map/map_file.hpp"
#include "program/output_check.hpp"
#include "program/output_file.hpp"
#include "program/usage_error.hpp"
#include "report/number_text.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::program {

namespace {

struct BuildOptions {
  std::string rig;
  std::vector<std::string> cameras;
  std::string principal;
  std::string storage = "one-pixel";
  grid::DepthQuantisation cells;
  std::optional<double> memory_gib;
  int threads = 0;
  std::string output;
};

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

std::string size_text(std::uint64_t bytes) {
  std::ostringstream text;
  const auto size = static_cast<double>(bytes);
  if (size >= 0.1 * kGiB) {
    text << std::fixed << std::setprecision(2) << size / kGiB << " GiB";
  } else {
    text << std::fixed << std::setprecision(3) << size / 1e6 << " MB";
  }
  return text.str();
}

std::string storage_text(grid::MapStorage storage) {
  return storage == grid::MapStorage::one_pixel ? "one pixel a cell" : "full pixel lists";
}

/// The cameras of the rig that the map is for, in the order in which `depthgrid distances` takes them.
Rig chosen_cameras(const BuildOptions& options) {
  std::filesystem::path file = options.rig;
  files::refuse_foreign_recording(file);
  if (!files::mcap_recording(file).empty()) {
    fail(file.string(), ": is an MCAP file, and a map is built of a rig file");
  }
  if (std::filesystem::is_directory(file)) {
    file /= "rig.json";
  }
  refuse_overwriting({{"--output", options.output}}, {{"the rig file", file}});
  check_output_file(options.output);
  const files::RigFile rig_file = files::load_rig(file);
  for (std::size_t k = 0; k < rig_file.tracks.size(); ++k) {
    if (rig_file.tracks[k].moves()) {
      fail(file.string(), ": camera '", rig_file.rig.cameras[k].id,
           "' moves, and a map is for cameras that stand still; --method search needs none");
    }
  }
  Rig rig = rig_file.rig;
  for (RigCamera& camera : rig.cameras) {  // as a recording hands its images out
    camera.intrinsics = rectified_camera(camera.intrinsics, camera.distortion);
    camera.distortion = {};
  }
  if (!options.cameras.empty()) {
    as_usage([&] {
      std::vector<RigCamera> chosen;
      for (const std::string& id : options.cameras) {
        chosen.push_back(rig.cameras[camera_index(rig, id)]);
      }
      rig.cameras = std::move(chosen);
      validate(rig);
    });
  }
  return rig;
}

void print_line(const std::string& line) {
  OutputFile output("-");
  output.write(printable(line) + "\n");
  output.commit();
}

void check(const BuildOptions& options) {
  if (options.memory_gib && !(*options.memory_gib > 0 && *options.memory_gib < 1e6)) {
    fail_usage("--memory ", *options.memory_gib, " must be greater than 0 and less than 1e6 GiB");
  }
  if (options.threads < 0 || options.threads > 1024) {
    fail_usage("--threads ", options.threads, " must lie in 0 ... 1024");
  }
}

void build(const BuildOptions& options) {
  check(options);
  as_usage([&] { grid::validate(options.cells); });
  const Rig rig = chosen_cameras(options);
  const std::size_t principal =
      options.principal.empty() ? 0 : as_usage([&] { return camera_index(rig, options.principal); });
  const grid::DepthGrid depth_grid(rig.cameras[principal].intrinsics, options.cells);
  const std::vector<grid::SecondaryCamera> secondaries = grid::secondary_cameras(rig, principal);
  const auto storage = options.storage == "lists" ? grid::MapStorage::pixel_lists : grid::MapStorage::one_pixel;

  grid::MapBuildSettings settings;
  settings.threads = options.threads;
  settings.memory_limit_bytes =
      options.memory_gib ? static_cast<std::uint64_t>(*options.memory_gib * kGiB) : grid::available_memory_bytes();
  const grid::MapMemory memory = grid::estimate_map_memory(depth_grid, secondaries, storage);
  print_line(
      storage_text(storage) + " for " + std::to_string(secondaries.size()) +
      (secondaries.size() == 1 ? " secondary camera needs " : " secondary cameras needs ") +
      (memory.safety_factor > 1 ? "about " : "") + size_text(memory.bytes) + " of memory" +
      (memory.safety_factor > 1 ? " (from a sample, times " + report::exact_text(memory.safety_factor) + ")" : "") +
      "; " + size_text(*settings.memory_limit_bytes) + " allowed");

  const auto begin = std::chrono::steady_clock::now();
  std::optional<report::ProgressLine> line;
  settings.progress = [&line](const grid::MapBuildProgress& progress) {
    if (!line) {
      line.emplace("building, row", static_cast<std::size_t>(progress.total));
    }
    line->update(static_cast<std::size_t>(progress.done));
    return true;
  };
  const grid::DepthGridMap map = grid::build_map(depth_grid, secondaries, storage, settings);
  line.reset();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  grid::save_map(map, options.output);
  print_line(options.output + ": " + size_text(std::filesystem::file_size(options.output)) + ", built in " +
             report::duration_text(seconds));
}

std::string camera_text(const PinholeCamera& camera) {
  const Eigen::Vector2d principal_point = principal_point_opencv(camera);
  return std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px) + " px, fx " +
         report::exact_text(camera.fx_px) + ", fy " + report::exact_text(camera.fy_px) + ", cx " +
         report::micro_text(principal_point.x()) + ", cy " + report::micro_text(principal_point.y());
}

void info(const std::string& file) {
  const grid::MapFileHeader header = grid::read_map_info(file);
  const grid::MapCalibration& calibration = header.calibration;
  const grid::DepthGrid depth_grid(calibration.principal, calibration.quantisation);
  std::ostringstream fingerprint;
  fingerprint << std::hex << std::setw(16) << std::setfill('0') << header.fingerprint;
  std::string text = "file         " + printable(file) + ", version " + std::to_string(header.version) + ", " +
                     size_text(header.file_bytes) + "\nstorage      " + storage_text(header.storage) + ", " +
                     std::to_string(header.cells) + " cells";
  if (header.storage == grid::MapStorage::pixel_lists) {
    text += ", " + std::to_string(header.rows) + " row spans";
  }
  text += "\ncalibration  " + std::string(fingerprint.str()) + "\nprincipal    " + camera_text(calibration.principal) +
          "\ndepth cells  " + std::to_string(depth_grid.count()) + " from " + report::exact_text(depth_grid.d_min_m()) +
          " to " + report::micro_text(depth_grid.d_max_m()) + " m, step " +
          report::exact_text(calibration.quantisation.step_m) + " m, growth " +
          report::exact_text(calibration.quantisation.growth) + "\n";
  for (std::size_t k = 0; k < calibration.secondaries.size(); ++k) {
    const Eigen::Vector3d centre = calibration.secondaries[k].T_secondary_principal.inverse().translation();
    text += "secondary " + std::to_string(k) + "  " + camera_text(calibration.secondaries[k].camera) + ", at (" +
            report::micro_text(centre.x()) + ", " + report::micro_text(centre.y()) + ", " +
            report::micro_text(centre.z()) + ") m in the principal camera's frame\n";
  }
  OutputFile output("-");
  output.write(text);
  output.commit();
}

void add_build_command(CLI::App& map) {
  auto options = std::make_shared<BuildOptions>();
  CLI::App* command = map.add_subcommand("build", "build the map of a rig and write it to a file");
  command->add_option("RIG", options->rig, "rig file, or folder of a recording with a rig.json")->required();
  command->add_option("--cameras", options->cameras, "ids of the cameras to use, in order (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--principal", options->principal, "id of the principal camera (default: the first)");
  command
      ->add_option("--storage", options->storage,
                   "one-pixel: the pixel of a cell's centre; lists: all pixels it touches")
      ->check(CLI::IsMember({"one-pixel", "lists"}))
      ->capture_default_str();
  command->add_option("--d-min", options->cells.d_min_m, "depth at which the grid begins, metres")
      ->capture_default_str();
  command->add_option("--step", options->cells.step_m, "depth of a cell, metres")->capture_default_str();
  command->add_option("--growth", options->cells.growth, "growth of a cell's depth with depth")->capture_default_str();
  command->add_option("--count", options->cells.count, "number of depth cells")->capture_default_str();
  command->add_option("--memory", options->memory_gib,
                      "refuse to take more memory than this, GiB (default: what is free)");
  command->add_option("--threads", options->threads, "threads to build with, 0 = one a core")->capture_default_str();
  command->add_option("--output", options->output, "map file to write")->required();
  command->footer(
      "Example:\n  depthgrid map build ../shared/data/kinect3_ball --count 300 --output ball.map\n"
      "It says first how much memory it needs. What a map costs and saves stands in docs/depth-grid-map.md.");
  command->callback([options] { build(*options); });
}

}  // namespace

void add_map_command(CLI::App& app) {
  CLI::App* map = app.add_subcommand("map", "build or describe a depth grid map");
  map->require_subcommand(1);
  add_build_command(*map);
  auto file = std::make_shared<std::string>();
  CLI::App* command = map->add_subcommand("info", "what a map file holds; its checksum is not compared");
  command->add_option("FILE", *file, "map file")->required();
  command->footer("Example:\n  depthgrid map info ball.map");
  command->callback([file] { info(*file); });
  map->footer(
      "Examples:\n"
      "  depthgrid map build ../shared/data/kinect3_ball --count 300 --output ball.map\n"
      "  depthgrid map info ball.map\n"
      "  depthgrid distances ../shared/data/kinect3_ball --variant letter --map ball.map --point hand=0.1,2.6,1.2 --in "
      "floor");
}

}  // namespace depthgrid::program
