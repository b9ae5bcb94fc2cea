#include "lab/speed/stage.hpp"

#include <algorithm>
#include <random>

namespace depthgrid::lab {
namespace {

constexpr double kSubStepRate = kWorkloadRate * kSubSteps;
constexpr std::size_t kCandidates = 60;  ///< special points to choose nine neighbours from

/// The 26 directions to the neighbours of a cube.
std::vector<Eigen::Vector3d> directions() {
  std::vector<Eigen::Vector3d> result;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (d.squaredNorm() > 0) {
      result.push_back(d.normalized());
    }
  }
  return result;
}

/// Up to nine of the candidates: the one with the nearest ninth neighbour, and its neighbours.
std::vector<Eigen::Vector3d> nine_neighbours(const std::vector<Eigen::Vector3d>& candidates) {
  std::vector<Eigen::Vector3d> best;
  double best_reach_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& centre : candidates) {
    std::vector<Eigen::Vector3d> sorted = candidates;
    std::sort(sorted.begin(), sorted.end(), [&centre](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return (a - centre).squaredNorm() < (b - centre).squaredNorm();
    });
    sorted.resize(std::min(sorted.size(), kWorkloadControlPoints));
    const double reach_m = (sorted.back() - centre).norm();
    if (reach_m < best_reach_m) {
      best_reach_m = reach_m;
      best = sorted;
    }
  }
  return best;
}

/// Nine neighbours among random points of the cell that `accept` takes; its margin keeps them off the border.
template <class Accept>
std::vector<Eigen::Vector3d> special_points(double margin_m, Accept accept) {
  std::mt19937_64 generator(7);
  const auto uniform = [&generator] { return static_cast<double>(generator() >> 11U) * 0x1p-53; };
  const Region cell = workload_cell();
  const Eigen::Vector3d low = cell.low_world.array() + margin_m;
  const Eigen::Vector3d size = (cell.high_world - low).array() - margin_m;
  std::vector<Eigen::Vector3d> candidates;
  for (int i = 0; i < 20000 && candidates.size() < kCandidates; ++i) {
    const double x = uniform();
    const double y = uniform();
    const Eigen::Vector3d p = low + Eigen::Vector3d(x, y, uniform()).cwiseProduct(size);
    if (accept(p)) {
      candidates.push_back(p);
    }
  }
  return nine_neighbours(candidates);
}

}  // namespace

Region workload_cell() { return {{-1.5, -1.5, 0.0}, {1.5, 1.5, 2.0}}; }

Region region_of(std::span<const Eigen::Vector3d> points_world) {
  Region region{points_world.front(), points_world.front()};
  for (const Eigen::Vector3d& p : points_world) {
    region.low_world = region.low_world.cwiseMin(p);
    region.high_world = region.high_world.cwiseMax(p);
  }
  region.low_world.array() -= kRho;
  region.high_world.array() += kRho;
  return region;
}

Stage::Stage(const Workload& clean, const NoisyWorkload* noisy, int cameras)
    : clean_(clean), noisy_(noisy), cameras_(cameras), rig_(clean.rig()) {
  rig_.cameras.resize(static_cast<std::size_t>(cameras));
  std::vector<Eigen::Vector3d> everywhere;
  for (int set = 0; set < frame_sets(); ++set) {
    for (int sub_step = 0; sub_step < kSubSteps; ++sub_step) {
      for (const Eigen::Vector3d& p : points(set, sub_step)) {
        everywhere.push_back(p);
      }
    }
  }
  arm_region_ = region_of(everywhere);
  // random_workload_points() moves its points by up to 2 cm to any side.
  arm_region_.low_world.array() -= 0.021;
  arm_region_.high_world.array() += 0.021;
}

std::span<const Frame> Stage::frames(int set) const {
  return (noisy_ != nullptr ? noisy_->frames(set) : clean_.frames(set)).first(static_cast<std::size_t>(cameras_));
}

PeerSetting Stage::setting() const {
  PeerSetting setting;
  setting.rig = rig_;
  setting.cell = workload_cell();
  setting.rho_m = kRho;
  setting.sensor.lateral_px = 0;
  setting.people_world = workload_people;
  return setting;
}

std::vector<Eigen::Vector3d> Stage::points(int set, int sub_step) const {
  return workload_points(Workload::time_s(set) + sub_step / kSubStepRate);
}

std::unique_ptr<reference::Reference> Stage::oracle(int set, const SensorMargin& sensor, const PoseMargin& pose,
                                                    bool clean) const {
  reference::Problem problem;
  const std::span<const Frame> frames = clean ? clean_.frames(set) : this->frames(set);
  for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
    const RigCamera& camera = rig_.cameras[k];
    problem.cameras.push_back({camera.intrinsics, camera.T_world_camera, camera.rule, frames[k], sensor, pose});
  }
  problem.space = reference::WorldBox{workload_cell().low_world, workload_cell().high_world};
  problem.rho_m = kRho;
  return std::make_unique<reference::Reference>(problem);
}

const reference::Reference& Stage::truth_oracle(int set) {
  if (oracle_.first != set) {
    SensorMargin ideal;
    ideal.lateral_px = 0;
    oracle_ = {set, oracle(set, ideal, {}, true)};
  }
  return *oracle_.second;
}

const std::vector<Stage::Truth>& Stage::truths(int set, int sub_step) {
  std::vector<Truth>& truths = truths_[{set, sub_step}];
  if (truths.empty()) {
    for (const Eigen::Vector3d& p : points(set, sub_step)) {
      const reference::Interval interval = truth_oracle(set).distance(p);
      truths.push_back({interval.lo_m, interval.hi_m.value_or(kRho)});
    }
  }
  return truths;
}

const std::vector<Eigen::Vector3d>& Stage::far_points(int set) {
  const auto [found, is_new] = far_points_.try_emplace(set);
  if (is_new) {
    const reference::Reference& oracle = truth_oracle(set);
    found->second = special_points(kRho, [&oracle](const Eigen::Vector3d& p) {
      for (const double reach_m : {0.0, 0.2, 0.39}) {
        for (const Eigen::Vector3d& direction : directions()) {
          if (oracle.is_obstacle(p + reach_m * direction)) {
            return false;
          }
        }
      }
      return oracle.distance(p).beyond(kRho);
    });
  }
  return found->second;
}

const std::vector<Eigen::Vector3d>& Stage::deep_points(int set) {
  const auto [found, is_new] = deep_points_.try_emplace(set);
  if (is_new) {
    const reference::Reference& oracle = truth_oracle(set);
    found->second = special_points(0.1, [&oracle](const Eigen::Vector3d& p) {
      for (const double reach_m : {0.0, 0.05, 0.1}) {
        for (const Eigen::Vector3d& direction : directions()) {
          if (!oracle.is_obstacle(p + reach_m * direction)) {
            return false;
          }
        }
      }
      return true;
    });
  }
  return found->second;
}

}  // namespace depthgrid::lab
