// Draws the pictures of docs/simulation.md.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/simulation/arrangement.hpp"
#include "depthgrid/simulation/mocap_clip.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"
#include "lab/commands.hpp"
#include "lab/measure/recording_folder.hpp"
#include "lab/workcell/depth_caster.hpp"
#include "lab/workcell/workcell_scene.hpp"
#include "report/depth_picture.hpp"

namespace depthgrid::lab {
namespace {

using simulation::Motion;

constexpr report::DepthRange kRange{0.5, 5.3};
constexpr double kTile = 480;  ///< width of an image in a picture
constexpr double kTitle = 26;

struct Tile {
  std::string title;
  DepthImage depth_m;
};

void draw(const std::filesystem::path& file, const std::vector<Tile>& tiles, int columns) {
  const int rows = (static_cast<int>(tiles.size()) + columns - 1) / columns;
  const double tile_height = 0.75 * kTile + kTitle;
  report::Canvas canvas(static_cast<int>(columns * (kTile + 8) + 8), static_cast<int>(rows * tile_height + 44));
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const double x = 8 + (kTile + 8) * static_cast<double>(i % static_cast<std::size_t>(columns));
    const double y = tile_height * static_cast<double>(i / static_cast<std::size_t>(columns));
    canvas.text({x, y + 19}, tiles[i].title, 15);
    draw_depth(canvas, {x, y + kTitle, kTile, 0.75 * kTile}, tiles[i].depth_m, kRange);
  }
  draw_depth_legend(canvas, {8, rows * tile_height + 10, kTile, 14}, kRange);
  canvas.save_png(file);
  std::cout << file.string() << '\n';
}

/// What each motion looks like in the middle of it, from the letter's first camera.
std::vector<Tile> motions() {
  std::vector<Tile> tiles;
  const Rig rig = simulation::letter_arrangement("ideal").rig;
  for (const Motion motion : simulation::motions()) {
    WorkcellScene scene(motion, 3, ArmShape::capsules);
    const workcell::DepthCaster caster(scene.at(0.5 * scene.person().duration_s()));
    Tile& tile = tiles.emplace_back();
    tile.title = to_string(motion);
    caster.render(rig.cameras[0].intrinsics, rig.cameras[0].T_world_camera, tile.depth_m);
  }
  return tiles;
}

/// A recorded walk across the cell; nothing where the files are missing.
std::vector<Tile> recorded_walk() {
  const std::filesystem::path folder = recording_folder("mocap_cmu");
  if (!std::filesystem::is_directory(folder)) {
    std::cerr << "no motion capture in " << folder << '\n';
    return {};
  }
  const auto clip = simulation::MocapClip::load(folder / "02.asf", folder / "02_01.amc");
  Pose T_world_floor = Pose::Identity();
  T_world_floor.translation() = Eigen::Vector3d(0.7, -0.5, -0.5) - clip.middle_m();
  simulation::Workcell cell = simulation::empty_workcell();
  cell.bodies.push_back(capsule_body("arm", simulation::BodyKind::robot, WorkcellScene::arm_at(0).links));
  cell.bodies.push_back(
      capsule_body("walker", simulation::BodyKind::person, clip.at(0.55 * clip.duration_s(), T_world_floor)));
  const workcell::DepthCaster caster(cell);
  const RigCamera camera = simulation::letter_arrangement("ideal").rig.cameras[0];
  std::vector<Tile> tiles(1);
  tiles[0].title = "recorded walk";
  caster.render(camera.intrinsics, camera.T_world_camera, tiles[0].depth_m);
  return tiles;
}

/// One scene, one camera, every sensor.
std::vector<Tile> sensors() {
  struct Row {
    const char* title;
    const char* sensor;
    std::vector<bool> vibrating;
    std::size_t cameras;
  };
  const std::array<Row, 6> rows{{{"ideal", "ideal", {}, 1},
                                 {"kinect_v1 alone", "kinect_v1", {}, 1},
                                 {"kinect_v1, another one beside it", "kinect_v1", {}, 2},
                                 {"the same, the other one vibrates", "kinect_v1", {false, true}, 2},
                                 {"realsense_d435", "realsense_d435", {}, 1},
                                 {"azure_kinect_nfov", "azure_kinect_nfov", {}, 1}}};
  WorkcellScene scene(Motion::arm_between, 1, ArmShape::capsules);
  const workcell::DepthCaster caster(scene.at(0.5 * scene.person().duration_s()));
  std::vector<Tile> tiles;
  for (const Row& row : rows) {
    Rig rig = simulation::arrangement(8, row.sensor).rig;
    rig.cameras.resize(row.cameras);  // the second one stands beside the first, 1.8 m away
    std::vector<DepthImage> ideal(row.cameras);
    std::vector<DepthImage> measured(row.cameras);
    for (std::size_t k = 0; k < row.cameras; ++k) {
      caster.render(rig.cameras[k].intrinsics, rig.cameras[k].T_world_camera, ideal[k]);
    }
    simulation::SensorGroupSettings settings;
    settings.vibrating = row.vibrating;
    simulation::SimulatedSensors(rig, settings).measure(ideal, 0, measured);
    const auto pixels = static_cast<std::ptrdiff_t>(measured[0].index(0, 480));
    const auto invalid = std::count(measured[0].data(), measured[0].data() + pixels, 0.0F);
    std::cout << row.title << ": " << 100.0 * static_cast<double>(invalid) / static_cast<double>(pixels)
              << " % without measurement\n";
    tiles.push_back({row.title, std::move(measured[0])});
  }
  return tiles;
}

void draw_all(const std::filesystem::path& folder) {
  std::vector<Tile> people = motions();
  for (Tile& tile : recorded_walk()) {
    people.push_back(std::move(tile));
  }
  draw(folder / "simulation-motions.png", people, 3);
  draw(folder / "simulation-sensors.png", sensors(), 3);
}

}  // namespace

void add_workcell_pictures_command(CLI::App& workcell) {
  const auto folder = std::make_shared<std::string>("docs/images");
  CLI::App* const command =
      workcell.add_subcommand("pictures", "draws the pictures of docs/simulation.md: some seconds");
  command->add_option("FOLDER", *folder, "where to")->check(CLI::ExistingDirectory)->capture_default_str();
  command->callback([folder] { draw_all(*folder); });
}

}  // namespace depthgrid::lab
