// The oracle's linear programmes, by GLPK.
#include <glpk.h>

#include <limits>
#include <memory>
#include <stdexcept>

#include "control/saturation_problem.hpp"

namespace depthgrid::control::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// maximise objective . x, row by row
class LinearProgramme {
 public:
  explicit LinearProgramme(int variables) : problem_(glp_create_prob(), glp_delete_prob) {
    glp_term_out(GLP_OFF);
    glp_set_obj_dir(problem_.get(), GLP_MAX);
    glp_add_cols(problem_.get(), variables);
  }
  void bound(int variable, double low, double high) {
    glp_set_col_bnds(problem_.get(), variable + 1, kind(low, high), low, high);
  }
  void objective(int variable, double weight) { glp_set_obj_coef(problem_.get(), variable + 1, weight); }
  void row(const Eigen::VectorXd& factors, double low, double high) {
    const int index = glp_add_rows(problem_.get(), 1);
    std::vector<int> columns(1);
    std::vector<double> values(1);
    for (int i = 0; i < factors.size(); ++i) {
      columns.push_back(i + 1);
      values.push_back(factors[i]);
    }
    glp_set_mat_row(problem_.get(), index, static_cast<int>(factors.size()), columns.data(), values.data());
    glp_set_row_bnds(problem_.get(), index, kind(low, high), low, high);
  }
  /// Nothing when no x satisfies all rows.
  std::optional<double> solve() {
    glp_smcp settings;
    glp_init_smcp(&settings);
    settings.tol_bnd = 1e-9;
    settings.tol_dj = 1e-9;
    settings.msg_lev = GLP_MSG_OFF;
    glp_adv_basis(problem_.get(), 0);
    int error = glp_simplex(problem_.get(), &settings);
    if (error != 0 || glp_get_status(problem_.get()) == GLP_UNDEF) {
      error = glp_exact(problem_.get(), &settings);
    }
    if (error != 0) {
      throw std::runtime_error("GLPK gave up with error " + std::to_string(error));
    }
    if (glp_get_status(problem_.get()) != GLP_OPT) {
      return std::nullopt;
    }
    return glp_get_obj_val(problem_.get());
  }

 private:
  static int kind(double low, double high) {
    if (low == -kInfinity) {
      return high == kInfinity ? GLP_FR : GLP_UP;
    }
    return high == kInfinity ? GLP_LO : (low == high ? GLP_FX : GLP_DB);
  }
  std::unique_ptr<glp_prob, decltype(&glp_delete_prob)> problem_;
};

}  // namespace

std::optional<double> largest_scale(const ScaleProgramme& programme, const JointBox& box) {
  const int joints = box.joints();
  LinearProgramme lp(joints + 1);
  for (int i = 0; i < joints; ++i) {
    lp.bound(i, box.lower_rad_s[i], box.upper_rad_s[i]);
  }
  lp.bound(joints, 0, 1);
  lp.objective(joints, 1);
  Eigen::VectorXd factors = Eigen::VectorXd::Zero(joints + 1);
  for (int k = 0; k < programme.rows.rows(); ++k) {
    const double size = programme.rows.row(k).norm();  // of length one, as the tolerances assume
    factors << programme.rows.row(k).transpose() / size, -programme.slope[k] / size;
    lp.row(factors, programme.fixed[k] / size, programme.fixed[k] / size);
  }
  for (int k = 0; k < programme.taken.rows(); ++k) {
    factors << programme.taken.row(k).transpose(), 0;
    lp.row(factors, programme.taken_value[k], programme.taken_value[k]);
  }
  for (int k = 0; k < programme.gradients.rows(); ++k) {
    factors << programme.gradients.row(k).transpose(), 0;
    lp.row(factors, -kInfinity, programme.speeds[k]);
  }
  return lp.solve();
}

double optimality_residual(const JointVector& qd, const JointVector& preferred, const Eigen::MatrixXd& rows,
                           const JointBox& box, const Eigen::MatrixXd& gradients, const Eigen::VectorXd& speeds) {
  constexpr double kActive = 1e-8;
  const auto joints = static_cast<int>(qd.size());
  const auto lambdas = static_cast<int>(rows.rows());
  const auto limits = static_cast<int>(gradients.rows());
  // qd - preferred = rows^T lambda + mu - gradients^T nu, each component to within t
  const int variables = lambdas + joints + limits + 1;
  LinearProgramme lp(variables);
  for (int k = 0; k < lambdas; ++k) {
    lp.bound(k, -kInfinity, kInfinity);
  }
  for (int i = 0; i < joints; ++i) {
    const bool at_lower = qd[i] <= box.lower_rad_s[i] + kActive;
    const bool at_upper = qd[i] >= box.upper_rad_s[i] - kActive;
    lp.bound(lambdas + i, at_upper ? -kInfinity : 0, at_lower ? kInfinity : 0);
  }
  for (int k = 0; k < limits; ++k) {
    lp.bound(lambdas + joints + k, 0, gradients.row(k).dot(qd) >= speeds[k] - kActive ? kInfinity : 0);
  }
  lp.bound(variables - 1, 0, kInfinity);
  lp.objective(variables - 1, -1);
  for (int i = 0; i < joints; ++i) {
    Eigen::VectorXd factors = Eigen::VectorXd::Zero(variables);
    factors.head(lambdas) = rows.col(i);
    factors[lambdas + i] = 1;
    if (limits > 0) {
      factors.segment(lambdas + joints, limits) = -gradients.col(i);
    }
    factors[variables - 1] = 1;
    lp.row(factors, qd[i] - preferred[i], kInfinity);
    factors[variables - 1] = -1;
    lp.row(factors, -kInfinity, qd[i] - preferred[i]);
  }
  const std::optional<double> least = lp.solve();
  return least ? -*least : kInfinity;
}

}  // namespace depthgrid::control::test
