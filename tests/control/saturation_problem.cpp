#include "control/saturation_problem.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

namespace depthgrid::control::test {
namespace {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed * 0x9E3779B97F4A7C15U + 1) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double share) { return uniform(0, 1) < share; }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double gauss() { return std::normal_distribution<double>()(engine_); }
  Eigen::MatrixXd orthogonal(int size) {
    Eigen::MatrixXd random = Eigen::MatrixXd::NullaryExpr(size, size, [this] { return gauss(); });
    return Eigen::HouseholderQR<Eigen::MatrixXd>(random).householderQ();
  }

 private:
  std::mt19937_64 engine_;
};

TaskJacobian random_jacobian(Dice& dice, int rows, int joints) {
  const int rank = std::min(rows, joints);
  const bool regular = dice.chance(0.6);
  Eigen::MatrixXd singular = Eigen::MatrixXd::Zero(rows, joints);
  for (int i = 0; i < rank; ++i) {
    singular(i, i) = regular || dice.chance(0.5) ? dice.uniform(0.1, 1.5)
                     : dice.chance(0.4)          ? 0.0
                                                 : dice.log_uniform(1e-3, 0.1);
  }
  return dice.orthogonal(rows) * singular * dice.orthogonal(joints).transpose();
}

}  // namespace

SaturationProblem make_saturation_problem(std::uint64_t seed, bool rest) {
  Dice dice(seed);
  SaturationProblem problem;
  problem.seed = seed;
  const int joints = dice.chance(0.6) ? 7 : dice.whole(1, 10);
  const int tasks = dice.chance(0.5) ? 1 : dice.whole(2, 3);
  for (int k = 0; k < tasks; ++k) {
    Task task;
    const int rows = dice.chance(0.5) ? 3 : dice.whole(1, 6);
    task.jacobian = random_jacobian(dice, rows, joints);
    if (k > 0 && dice.chance(0.2)) {
      task.jacobian.row(0) = problem.tasks[0].jacobian.row(0);  // what the first task decides already
    }
    const double size = dice.log_uniform(0.01, 10);
    task.velocity = TaskVector::NullaryExpr(rows, [&] { return size * dice.gauss(); });
    if (dice.chance(0.03)) {
      task.velocity.setZero();
    }
    problem.tasks.push_back(task);
  }
  problem.box = {JointVector(joints), JointVector(joints)};
  const double width = rest ? 1.0 : dice.log_uniform(0.01, 1.0);
  for (int i = 0; i < joints; ++i) {
    const double middle = rest ? 0.0 : dice.uniform(-1, 1);
    double low = middle - width * dice.uniform(0, 2);
    double high = middle + width * dice.uniform(0, 2);
    low = dice.chance(0.05) ? middle : low;
    high = dice.chance(0.05) ? middle : high;
    problem.box.lower_rad_s[i] = low;
    problem.box.upper_rad_s[i] = high;
  }
  problem.preferred = JointVector::Zero(joints);
  if (dice.chance(0.5)) {
    problem.preferred = JointVector::NullaryExpr(joints, [&] { return dice.gauss(); });
  }
  return problem;
}

std::string paste(const SaturationProblem& problem, bool rest) {
  std::ostringstream text;
  text << "make_saturation_problem(" << problem.seed << ", " << (rest ? "true" : "false")
       << "), alone: DEPTHGRID_TEST_SEED=" << problem.seed << " DEPTHGRID_TEST_COUNT=1";
  return text.str();
}

ReferenceRows reference_rows(const Task& task, const Eigen::MatrixXd& taken, double floor) {
  const int joints = static_cast<int>(task.jacobian.cols());
  Eigen::MatrixXd null_space = Eigen::MatrixXd::Identity(joints, joints);
  if (taken.rows() > 0) {
    null_space -= taken.transpose() * taken;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(task.jacobian) * null_space,
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  ReferenceRows result;
  int kept = 0;
  while (kept < svd.singularValues().size() && svd.singularValues()[kept] > 1e-3 * floor) {
    ++kept;
  }
  const Eigen::VectorXd s = svd.singularValues().head(kept);
  const Eigen::VectorXd phi =
      s.unaryExpr([floor](double x) { return x >= floor ? 1.0 : x * x / (x * x + 0.25 * (floor * floor - x * x)); });
  result.units = svd.matrixV().leftCols(kept).transpose();
  result.rows = s.asDiagonal() * result.units;
  result.left = phi.asDiagonal() * svd.matrixU().leftCols(kept).transpose();
  return result;
}

}  // namespace depthgrid::control::test
