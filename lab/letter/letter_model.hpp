// The letter's evaluation once more, slow and in double precision, with each of its errors mendable on its own: what
// one mend changes is what that error costs. The product's evaluation is GridEvaluator; the two are compared.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/core/pose.hpp"
#include "reference/random_problem.hpp"

namespace depthgrid::lab {

/// Nothing set: as printed.
struct Mends {
  bool window = false;        ///< the whole image instead of (8)-(9)
  bool order = false;         ///< (iii) takes the nearest confirmed cell instead of the first by |j|
  bool clamp = false;         ///< the exact distance to a cell instead of (5)-(7)
  bool shadow = false;        ///< (ii) looks at confirmed cells behind the surface too
  bool confirmation = false;  ///< a cell is free only if one camera sees all of it free
  bool blind_zone = false;    ///< nothing nearer than the principal camera's near limit is free by its own measurement
};

/// The mends in the order in which they are applied one after the other.
inline constexpr int kMendCount = 6;
Mends first_mends(int count);

class LetterModel {
 public:
  /// `problem` must outlive the model; without robot, margins and filter radius.
  explicit LetterModel(const reference::RandomProblem& problem);

  /// Distance in metres, rho where nothing was found.
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p_world, const Mends& mends) const;

 private:
  struct Secondary {
    PinholeCamera camera;
    Pose T_camera_principal;
    double near_m;
    std::vector<float> depth_m;
  };
  struct Query;

  void visit_pixel(Query& query, int u, int v) const;
  void take_cells(Query& query, int u, int v, int first, int last, double d_o) const;
  void take_blind_cells(Query& query, int u, int v) const;
  void take_first_by_index(Query& query, int u, int v, int first, int last, int point_cell) const;
  [[nodiscard]] bool confirmed(const Query& query, const PixelFrustum& cell, int u, int v, int n) const;
  [[nodiscard]] double cell_distance_m(const Query& query, int u, int v, double d1_m, double d2_m) const;
  [[nodiscard]] double boundary_m(int n) const { return problem_.d_min_m + problem_.step_m * n; }

  const reference::RandomProblem& problem_;
  PinholeCamera principal_;
  std::vector<float> principal_depth_m_;
  std::vector<Secondary> secondaries_;
};

}  // namespace depthgrid::lab
