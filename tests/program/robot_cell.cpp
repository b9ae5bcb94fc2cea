#include "program/robot_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "depthgrid/files/recording.hpp"

namespace depthgrid::test::robot_cell {

using Eigen::Vector3d;

std::string after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  if (at == std::string::npos) {
    ADD_FAILURE() << "no '" << words << "' in: " << text;
    return "nan";
  }
  const std::size_t begin = at + words.size();
  const std::size_t end = text.find_first_not_of("0123456789.", begin);
  return text.substr(begin, end - begin);
}

std::vector<Capsule> links_at(const Position& q) {
  Pose T = Pose(Eigen::Translation3d(0.1, 0, 0.2)) * Eigen::AngleAxisd(0.5 + q.pan, Vector3d::UnitZ());
  const auto moved = [&T](const Vector3d& a, const Vector3d& b, double radius_m) {
    return Capsule{T * a, T * b, radius_m};
  };
  T.translation().z() += 0.3;
  std::vector<Capsule> result{moved({0, 0, 0}, {0.4, 0, 0}, 0.06)};
  T = T * Eigen::Translation3d(0.5, 0, 0) * Eigen::AngleAxisd(q.tilt, Vector3d::UnitY());
  result.push_back(moved({0, 0, 0}, {0.3, 0, 0}, 0.05));
  result.push_back(moved({0.4, 0.06, 0}, {0.4, 0.06, 0}, 0.05));
  result.push_back(moved({0.4, -0.06, 0}, {0.4, -0.06, 0}, 0.05));
  return result;
}

double distance_m(const std::vector<Capsule>& links, const Vector3d& p) {
  double least_m = 1e9;
  for (const Capsule& link : links) {
    least_m = std::min(least_m, distance_to_axis(link, p) - link.radius_m);
  }
  return least_m;
}

simulation::Scene scene(const std::vector<Capsule>& robot, bool obstacle) {
  simulation::Scene result;
  result.add(simulation::Plane{{0, -1, 0}, -2});
  result.add(simulation::Plane{{0, 0, 1}, -0.5});
  if (obstacle) {
    result.add(kObstacle);
  }
  for (const Capsule& capsule : robot) {
    result.add(capsule, simulation::Body::robot);
  }
  return result;
}

files::RigFile rig_file() {
  files::RigFile file;
  file.rig.name = "cell";
  for (const bool left : {true, false}) {
    RigCamera camera;
    camera.id = left ? "left" : "right";
    camera.intrinsics = {320, 240, 260.0, 260.0, 160.0, 120.0};
    camera.T_world_camera = look_at(left ? Vector3d(-0.6, -1.6, 0.8) : Vector3d(1.7, -1.2, 1.1), {0.5, 0.4, 0.6});
    file.rig.cameras.push_back(camera);
    file.depth_files.push_back(camera.id + "_%d.png");
  }
  file.first_frame = 3;
  file.frame_count = 2;
  file.rate_hz = 10.0;
  return file;
}

void write_cell(const TemporaryFolder& folder) {
  const files::RigFile file = rig_file();
  files::save_rig(file, folder / "rig.json");
  for (const auto& [frame, q] : kFrames) {
    for (std::size_t k = 0; k < 2; ++k) {
      const RigCamera& camera = file.rig.cameras[k];
      const DepthImage depth = scene(links_at(q), true).render(camera.intrinsics, camera.T_world_camera).depth_m;
      std::vector<std::uint16_t> pixels(depth.index(0, depth.height_px()));
      std::transform(depth.data(), depth.data() + pixels.size(), pixels.begin(),
                     [](float z) { return static_cast<std::uint16_t>(std::lround(1000 * z)); });
      files::write_png_gray16(folder / files::depth_file_name(file.depth_files[k], frame), 320, 240, pixels);
    }
  }
  (void)folder.write("arm.urdf", kUrdf);
  (void)folder.write("joints.csv", "frame,pan,tilt\n3,0.2,-0.3\n4,-0.6,0.4\n");
}

std::map<std::string, std::string> column(const CommandResult& result, const std::string& name) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string>& row = rows.emplace_back(1);
    for (const char c : line) {
      c == ',' ? (void)row.emplace_back() : row.back().push_back(c);
    }
  }
  std::map<std::string, std::string> cells;
  const auto at = std::find(rows.at(0).begin(), rows.at(0).end(), name) - rows.at(0).begin();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    cells[rows[i].at(0) + ' ' + rows[i].at(2)] = rows[i].at(static_cast<std::size_t>(at));
  }
  return cells;
}

}  // namespace depthgrid::test::robot_cell
