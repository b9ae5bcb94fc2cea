#include "depthgrid/robot/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/mesh_formats.hpp"
#include "depthgrid/robot/robot_file.hpp"
#include "depthgrid/robot/words.hpp"

namespace depthgrid::robot {

namespace {

constexpr std::size_t kMaxMeshBytes = std::size_t{1} << 29;
constexpr std::size_t kMaxCorners = 15'000'000;
/// In the file's unit, which may be a micrometre; beyond, squares of lengths are no numbers any more.
constexpr double kMaxCoordinate = 1e9;

}  // namespace

void check_size(std::size_t corners, const std::string& context) {
  if (corners > kMaxCorners) {
    fail(context, "has more than ", kMaxCorners / 3, " triangles; reduce it, a tenth will do");
  }
}

void add_polygon(const Corners& polygon, Corners& corners) {
  if (polygon.empty()) {
    return;
  }
  for (std::size_t k = 2; k < std::max<std::size_t>(polygon.size(), 3); ++k) {
    corners.push_back(polygon.front());
    corners.push_back(polygon[std::min(k - 1, polygon.size() - 1)]);
    corners.push_back(polygon[std::min(k, polygon.size() - 1)]);
  }
}

bool has_area(const Corners& corners) noexcept {
  double area = 0;
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    area += 0.5 * (corners[i + 1] - corners[i]).cross(corners[i + 2] - corners[i]).norm();
    box.extend(corners[i]).extend(corners[i + 1]).extend(corners[i + 2]);
  }
  constexpr double kRounding = 1e-12;
  return !corners.empty() && area > kRounding * box.sizes().squaredNorm();
}

Corners mesh_corners(std::string_view bytes, std::string_view ending, const std::string& context) {
  const std::string format = lower_case(ending);
  Corners corners;
  if (format == ".stl") {
    corners = stl_corners(bytes, context);
  } else if (format == ".obj") {
    corners = obj_corners(bytes, context);
  } else if (format == ".dae") {
    corners = collada_corners(bytes, context);
  } else {
    fail(context, "meshes that end in '", shown(ending),
         "' are not read, only .stl, .obj and .dae: convert it to STL or OBJ");
  }
  if (corners.empty()) {
    fail(context, "the mesh has no face, so no corner");
  }
  for (const Eigen::Vector3d& corner : corners) {
    if (!(corner.cwiseAbs().maxCoeff() <= kMaxCoordinate) || !corner.allFinite()) {
      fail(context, "a corner is (", corner.transpose(), "), must be finite and within ", kMaxCoordinate);
    }
  }
  if (!has_area(corners)) {
    fail(context, "the ", corners.size() / 3, " triangles of the mesh have no area");
  }
  return corners;
}

std::vector<Eigen::Vector3d> mesh_points(const std::filesystem::path& file) {
  return mesh_corners(read_robot_file(file, kMaxMeshBytes), file.extension().string(), file.string() + ": ");
}

}  // namespace depthgrid::robot
