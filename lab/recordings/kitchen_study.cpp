#include "lab/recordings/kitchen_study.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <sstream>
#include <vector>

#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/files/recording.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "lab/measure/recording_folder.hpp"
#include "lab/recordings/ball_track.hpp"
#include "lab/recordings/cameras.hpp"
#include "lab/recordings/gray_area.hpp"
#include "report/number_text.hpp"
#include "report/statistics.hpp"

namespace depthgrid::lab {

namespace {

constexpr double kTableTop_m = 0.73;
constexpr double kTableTolerance_m = 0.05;
constexpr double kKitchenRho_m = 0.5;

std::vector<Eigen::Vector3d> points_over_table() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 6; ++j) {
      for (const double height_m : {0.15, 0.30, 0.45}) {
        points.emplace_back(-1.8 + 0.25 * i, 1.3 + 0.28 * j, kTableTop_m + height_m);
      }
    }
  }
  return points;
}

grid::EvaluationSettings settings_of(int which) {
  grid::EvaluationSettings settings;
  settings.rho_m = kKitchenRho_m;
  settings.variant = which == 0 ? grid::Variant::letter : grid::Variant::corrected;
  if (which == 2) {
    settings.sensor = sensor_model("kinect_v1").margin;
  }
  return settings;
}

struct Row {
  std::size_t answers = 0, measured = 0, shadow = 0, nothing = 0, above = 0;
  std::vector<double> distances_m;
};

}  // namespace

std::string kitchen_tables() {
  files::RecordingOptions options;
  options.camera_ids = {"f000000", "f000160", "f000480", "f000580"};
  files::Recording recording(recording_folder("redkitchen_poses"), options);
  const Rig& rig = recording.rig();
  const auto images = recording.read(0);
  const Pose T_world_floor = rig.T_floor_world.value_or(Pose::Identity()).inverse();
  grid::DepthQuantisation cells;
  cells.count = 372;  // to 4.0082 m
  const Eigen::AlignedBox3d workspace(Eigen::Vector3d(-1.9, 1.2, 0.1), Eigen::Vector3d(1.2, 2.9, 1.8));
  const auto points = points_over_table();

  std::ostringstream out;
  out << "| setting | cameras | points in the grid | measured | shadow obstacle | nothing within rho | "
         "distance, median | D > height over the table + 5 cm |\n|---|---|---|---|---|---|---|---|\n";
  const char* const kNames[] = {"letter", "corrected, no margins", "corrected, Kinect margins"};
  for (int which = 0; which < 3; ++which) {
    std::vector<Row> rows(rig.cameras.size() + 1);
    for (std::size_t principal = 0; principal < rig.cameras.size(); ++principal) {
      for (const CameraSet& set : camera_sets(rig.cameras.size(), principal)) {
        grid::GridEvaluator evaluator(sub_rig(rig, set), 0, cells, settings_of(which));
        (void)update_all(evaluator, sub_frames(images, set));
        Row& row = rows[set.size()];
        for (const auto& p_floor : points) {
          const Proximity answer = evaluator.distance(Capsule::point(T_world_floor * p_floor)).nearest;
          if (!has_distance(answer)) {
            continue;
          }
          ++row.answers;
          row.measured += answer.state == ProximityState::measured ? 1 : 0;
          row.nothing += answer.state == ProximityState::beyond_rho ? 1 : 0;
          row.distances_m.push_back(answer.distance_m);
          row.above += answer.distance_m > p_floor.z() - kTableTop_m + kTableTolerance_m ? 1 : 0;
        }
        row.shadow = row.answers - row.measured - row.nothing;
      }
    }
    for (std::size_t n = 1; n < rows.size(); ++n) {
      const Row& row = rows[n];
      const auto all = static_cast<double>(row.answers);
      out << "| " << kNames[which] << " | " << n << " | " << row.answers << " | "
          << report::percent_of(static_cast<double>(row.measured), all) << " | "
          << report::percent_of(static_cast<double>(row.shadow), all) << " | "
          << report::percent_of(static_cast<double>(row.nothing), all) << " | "
          << report::fixed(1e3 * report::quantile(row.distances_m, 0.5)) << " mm | " << row.above << " ("
          << report::percent_of(static_cast<double>(row.above), all) << ") |\n";
    }
  }
  out << "\n| principal | other cameras | grid in the workspace | gray | known free, letter's test | known free, whole "
         "cell seen free |\n|---|---|---|---|---|---|\n";
  for (std::size_t principal = 0; principal < rig.cameras.size(); ++principal) {
    for (const CameraSet& set : camera_sets(rig.cameras.size(), principal)) {
      // In ascending order: one other camera (the first), then all others.
      if (set.size() != rig.cameras.size()) {
        continue;
      }
      GrayArea area;
      add_gray_area(rig, set, images, cells, workspace, area);
      out << "| " << rig.cameras[principal].id << " | all three | " << report::fixed(area.workspace_m3, 2) << " m^3 | "
          << report::percent_of(area.gray_m3, area.workspace_m3) << " | "
          << report::percent_of(area.known_free_letter_m3, area.gray_m3) << " | "
          << report::percent_of(area.known_free_corrected_m3, area.gray_m3) << " |\n";
    }
  }
  return out.str();
}

}  // namespace depthgrid::lab
