#include "lab/letter/letter_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace depthgrid::lab {
namespace {

std::vector<float> measured(const RigCamera& camera, const Frame& frame) {
  std::vector<float> depth_m;
  for (int v = 0; v < camera.intrinsics.height_px; ++v) {
    for (int u = 0; u < camera.intrinsics.width_px; ++u) {
      depth_m.push_back(measured_depth_m(frame.depth, camera.rule, u, v).value_or(0.0F));
    }
  }
  return depth_m;
}

float at(const std::vector<float>& depth_m, const PinholeCamera& camera, int u, int v) {
  return depth_m[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width_px) + static_cast<std::size_t>(u)];
}

std::array<Eigen::Vector3d, 8> corners_of(const PixelFrustum& cell) {
  std::array<Eigen::Vector3d, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const double z = (i & 4U) != 0 ? cell.d2_m : cell.d1_m;
    corners[i] = {((i & 1U) != 0 ? cell.a1 : cell.a0) * z, ((i & 2U) != 0 ? cell.b1 : cell.b0) * z, z};
  }
  return corners;
}

}  // namespace

Mends first_mends(int count) { return {count > 0, count > 1, count > 2, count > 3, count > 4, count > 5}; }

struct LetterModel::Query {
  Eigen::Vector3d p_camera;
  DepthPoint p;
  Mends mends;
  double best_m;

  void take(double distance_m) { best_m = std::min(best_m, distance_m); }
};

LetterModel::LetterModel(const reference::RandomProblem& problem)
    : problem_(problem),
      principal_(problem.rig.cameras[problem.principal].intrinsics),
      principal_depth_m_(measured(problem.rig.cameras[problem.principal], problem.frames[problem.principal])) {
  const Pose& T_world_principal = problem.rig.cameras[problem.principal].T_world_camera;
  for (std::size_t k = 0; k < problem.rig.cameras.size(); ++k) {
    const RigCamera& camera = problem.rig.cameras[k];
    if (k != problem.principal) {
      secondaries_.push_back({camera.intrinsics, camera.T_world_camera.inverse(Eigen::Isometry) * T_world_principal,
                              camera.rule.near_m, measured(camera, problem.frames[k])});
    }
  }
}

double LetterModel::distance_m(const Eigen::Vector3d& p_world, const Mends& mends) const {
  Query query;
  query.p_camera = problem_.rig.cameras[problem_.principal].T_world_camera.inverse(Eigen::Isometry) * p_world;
  query.p = project(principal_, query.p_camera);
  query.mends = mends;
  query.best_m = problem_.rho_m;
  int u_first = 0;
  int v_first = 0;
  int u_last = principal_.width_px - 1;
  int v_last = principal_.height_px - 1;
  const double rho_m = problem_.rho_m;
  if (!mends.window && query.p.depth_m > rho_m) {
    const double half_x_px = 0.5 * rho_m * principal_.fx_px / (query.p.depth_m - rho_m);  // (8)
    const double half_y_px = 0.5 * rho_m * principal_.fy_px / (query.p.depth_m - rho_m);
    u_first = std::max(u_first, static_cast<int>(std::floor(query.p.x_px - half_x_px)));
    u_last = std::min(u_last, static_cast<int>(std::floor(query.p.x_px + half_x_px)));
    v_first = std::max(v_first, static_cast<int>(std::floor(query.p.y_px - half_y_px)));
    v_last = std::min(v_last, static_cast<int>(std::floor(query.p.y_px + half_y_px)));
  }
  for (int v = v_first; v <= v_last; ++v) {
    for (int u = u_first; u <= u_last; ++u) {
      visit_pixel(query, u, v);
    }
  }
  return query.best_m;
}

void LetterModel::visit_pixel(Query& query, int u, int v) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Nothing on this ray can be nearer than its pyramid, by whichever formula.
  const PixelFrustum pyramid = pixel_frustum(principal_, u, v, problem_.d_min_m, kInfinity);
  if (squared_distance(pyramid, query.p_camera) >= query.best_m * query.best_m) {
    return;
  }
  if (query.mends.blind_zone) {
    take_blind_cells(query, u, v);
  }
  const double d_o = at(principal_depth_m_, principal_, u, v);
  const double d_p = query.p.depth_m;
  const int within_rho = static_cast<int>(std::floor(problem_.rho_m / problem_.step_m * (1 + 1e-12)));
  const int point_cell = static_cast<int>(std::floor((d_p - problem_.d_min_m) / problem_.step_m));
  if (d_o > d_p + problem_.rho_m || d_o >= boundary_m(problem_.cell_count)) {
    return;  // (i)
  }
  const int surface_cell = static_cast<int>(std::floor((d_o - problem_.d_min_m) / problem_.step_m));
  if (d_o >= d_p) {
    query.take(cell_distance_m(query, u, v, d_o, d_o));  // (ii)
    if (query.mends.shadow) {
      take_cells(query, u, v, std::max(surface_cell, 0), problem_.cell_count - 1, d_o);
    }
    return;
  }
  const int last = std::min(point_cell + within_rho, problem_.cell_count - 1);  // (iii)
  const int first_printed = point_cell + static_cast<int>(std::floor((d_o - d_p) / problem_.step_m));
  const int first = std::max({first_printed, point_cell - within_rho - 1, 0});
  if (query.mends.order) {
    take_cells(query, u, v, query.mends.confirmation ? std::max(surface_cell, 0) : first,
               query.mends.confirmation ? problem_.cell_count - 1 : last, query.mends.confirmation ? d_o : 0.0);
  } else {
    take_first_by_index(query, u, v, first, last, point_cell);
  }
}

void LetterModel::take_cells(Query& query, int u, int v, int first, int last, double d_o) const {
  for (int n = first; n <= last; ++n) {
    // The part of the cell that lies in the shadow; as printed, the whole cell.
    const PixelFrustum cell = pixel_frustum(principal_, u, v, std::max(boundary_m(n), d_o), boundary_m(n + 1));
    const double distance_m = cell_distance_m(query, u, v, cell.d1_m, cell.d2_m);
    if (cell.d1_m < cell.d2_m && distance_m < query.best_m && confirmed(query, cell, u, v, n)) {
      query.take(distance_m);
    }
  }
}

void LetterModel::take_blind_cells(Query& query, int u, int v) const {
  const double near_m = problem_.rig.cameras[problem_.principal].rule.near_m;
  for (int n = 0; n < problem_.cell_count && boundary_m(n) < near_m; ++n) {
    const PixelFrustum cell = pixel_frustum(principal_, u, v, boundary_m(n), std::min(boundary_m(n + 1), near_m));
    const double distance_m = cell_distance_m(query, u, v, cell.d1_m, cell.d2_m);
    if (distance_m < query.best_m && confirmed(query, cell, u, v, n)) {
      query.take(distance_m);
    }
  }
}

void LetterModel::take_first_by_index(Query& query, int u, int v, int first, int last, int point_cell) const {
  for (int j = 0; point_cell + j <= last || point_cell - j >= first; ++j) {
    bool found = false;
    for (const int n : {point_cell + j, point_cell - j}) {
      if (n < first || n > last) {
        continue;
      }
      const PixelFrustum cell = pixel_frustum(principal_, u, v, boundary_m(n), boundary_m(n + 1));
      if (confirmed(query, cell, u, v, n)) {
        query.take(cell_distance_m(query, u, v, cell.d1_m, cell.d2_m));
        found = true;
      }
    }
    if (found) {
      return;
    }
  }
}

bool LetterModel::confirmed(const Query& query, const PixelFrustum& cell, int u, int v, int n) const {
  const PixelFrustum whole = pixel_frustum(principal_, u, v, boundary_m(n), boundary_m(n + 1));
  for (const Secondary& secondary : secondaries_) {
    double z_low = std::numeric_limits<double>::infinity();
    double z_high = 0;
    double u_low = z_low;
    double u_high = -z_low;
    double v_low = z_low;
    double v_high = -z_low;
    for (const Eigen::Vector3d& corner : corners_of(query.mends.confirmation ? cell : whole)) {
      const DepthPoint q = project(secondary.camera, secondary.T_camera_principal * corner);
      z_low = std::min(z_low, q.depth_m);
      z_high = std::max(z_high, q.depth_m);
      u_low = std::min(u_low, q.x_px);
      u_high = std::max(u_high, q.x_px);
      v_low = std::min(v_low, q.y_px);
      v_high = std::max(v_high, q.y_px);
    }
    if (!(z_low > 0)) {
      continue;
    }
    if (!query.mends.confirmation) {
      const double centre_z = 0.5 * (whole.d1_m + whole.d2_m);
      const Eigen::Vector3d centre = deproject(principal_, {u + 0.5, v + 0.5, centre_z});
      const DepthPoint q = project(secondary.camera, secondary.T_camera_principal * centre);
      if (!(q.x_px >= 0 && q.y_px >= 0 && q.x_px < secondary.camera.width_px && q.y_px < secondary.camera.height_px)) {
        continue;  // not involved
      }
      if (!(at(secondary.depth_m, secondary.camera, static_cast<int>(q.x_px), static_cast<int>(q.y_px)) < z_low)) {
        return false;
      }
      continue;
    }
    if (!(z_low > secondary.near_m && u_low >= 0 && v_low >= 0 && u_high < secondary.camera.width_px &&
          v_high < secondary.camera.height_px)) {
      continue;
    }
    bool free = true;
    for (int y = static_cast<int>(v_low); free && y <= static_cast<int>(v_high); ++y) {
      for (int x = static_cast<int>(u_low); free && x <= static_cast<int>(u_high); ++x) {
        free = at(secondary.depth_m, secondary.camera, x, y) > z_high;
      }
    }
    if (free) {
      return false;
    }
  }
  return true;
}

double LetterModel::cell_distance_m(const Query& query, int u, int v, double d1_m, double d2_m) const {
  if (query.mends.clamp) {
    return nearest_point(pixel_frustum(principal_, u, v, d1_m, d2_m), query.p_camera).distance_m;
  }
  return nearest_point_letter(principal_, u, v, d1_m, d2_m, query.p).distance_m;
}

}  // namespace depthgrid::lab
