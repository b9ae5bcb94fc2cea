#include "depthgrid/memory/history.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace depthgrid::memory {
namespace {

constexpr std::size_t kVoxelsOfABlock = 64;

/// The voxels beside one, those that share a face first: of equal times the straightest way is told.
constexpr std::array<std::array<int, 3>, 26> make_neighbours() {
  std::array<std::array<int, 3>, 26> result{};
  std::size_t count = 0;
  for (int steps = 1; steps <= 3; ++steps) {
    for (int i = 0; i < 27; ++i) {
      const std::array<int, 3> to{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      if (to[0] * to[0] + to[1] * to[1] + to[2] * to[2] == steps) {
        result[count++] = to;
      }
    }
  }
  return result;
}
constexpr std::array<std::array<int, 3>, 26> kNeighbours = make_neighbours();

/// Which of the voxels of a block.
template <class Steps, class Step>
void stamp_all(Steps& steps, std::size_t block, Block voxels, Step step) noexcept {
  for (; voxels != 0; voxels &= voxels - 1) {
    steps[kVoxelsOfABlock * block + static_cast<std::size_t>(std::countr_zero(voxels))].store(
        step, std::memory_order_relaxed);
  }
}

}  // namespace

History::History(const VoxelSet& first)
    : count_(first.voxels()),
      blocks_(first.blocks(0)),
      low_world_(first.low_world()),
      voxel_m_(first.voxel_m()),
      newest_(first.voxel_blocks()),
      added_(kVoxelsOfABlock * newest_.size()),
      removed_(added_.size()) {
  for (std::size_t block = 0; block < newest_.size(); ++block) {
    stamp_all(removed_, block, ~newest_[block], kDeclared);
  }
}

void History::note(const VoxelSet& set, double time_s, bool grown) noexcept {
  if (!has_begun_) {
    begin_s_.store(time_s, std::memory_order_relaxed);
    has_begun_ = true;
  }
  double steps = 2 * std::floor((time_s - begin_s_.load(std::memory_order_relaxed)) / kStep_s);
  if (!(std::max(steps, static_cast<double>(last_)) < static_cast<double>(std::numeric_limits<Step>::max() - 8))) {
    forget_times();
    begin_s_.store(time_s, std::memory_order_relaxed);
    steps = 0;
  }
  last_ = std::max(last_ + 1, static_cast<Step>(std::max(steps, 0.0)) + kFirst);
  last_ += ((last_ & 1U) != 0) == grown ? 0 : 1;
  const std::vector<Block>& bits = set.voxel_blocks();
  for (std::size_t block = 0; block < bits.size(); ++block) {
    const Block changed = bits[block] ^ newest_[block];
    if (changed != 0) {
      stamp_all(added_, block, changed & bits[block], last_);
      stamp_all(removed_, block, changed & ~bits[block], last_);
      newest_[block] = bits[block];
    }
  }
}

/// After weeks steps cannot be counted any more.
void History::forget_times() noexcept {
  for (std::size_t n = 0; n < added_.size(); ++n) {
    if (removed_[n].load(std::memory_order_relaxed) != 0) {
      const bool is_set = ((newest_[n / kVoxelsOfABlock] >> (n % kVoxelsOfABlock)) & 1U) != 0;
      added_[n].store(is_set ? kLongAgo : 0, std::memory_order_relaxed);
      removed_[n].store(kDeclared, std::memory_order_relaxed);
    }
  }
  last_ = kLongAgo;
}

void History::begin_anew(double time_s) noexcept {
  for (std::size_t n = 0; n < added_.size(); ++n) {
    const bool is_set = ((newest_[n / kVoxelsOfABlock] >> (n % kVoxelsOfABlock)) & 1U) != 0;
    added_[n].store(0, std::memory_order_relaxed);
    removed_[n].store(is_set ? 0 : kDeclared, std::memory_order_relaxed);
  }
  last_ = kLongAgo;
  begin_s_.store(time_s, std::memory_order_relaxed);
}

History::Stamp History::stamp(const Voxel& v) const noexcept {
  const auto block =
      (static_cast<std::size_t>(v.z >> 2) * static_cast<std::size_t>(blocks_[1]) + static_cast<std::size_t>(v.y >> 2)) *
          static_cast<std::size_t>(blocks_[0]) +
      static_cast<std::size_t>(v.x >> 2);
  const std::size_t at = kVoxelsOfABlock * block + static_cast<std::size_t>(VoxelSet::bit(v.x, v.y, v.z));
  return {added_[at].load(std::memory_order_relaxed), removed_[at].load(std::memory_order_relaxed)};
}

double History::time_of(Step step) const noexcept {
  const auto whole = (std::max(step, kFirst) - kFirst) / 2;
  return begin_s_.load(std::memory_order_relaxed) + kStep_s * static_cast<double>(whole);
}

Past History::past(const Eigen::Vector3d& x_world, double reach_m) const noexcept {
  Past past;
  const Eigen::Vector3d x = (x_world - low_world_) / voxel_m_;  // in voxels
  const double reach = reach_m / voxel_m_;
  const Eigen::Vector3d size(count_[0], count_[1], count_[2]);
  if (!(x.allFinite() && reach >= 0 && std::isfinite(reach))) {
    return past;
  }
  double least = std::min(x.minCoeff(), (size - x).minCoeff());  // to what lies outside
  past.state = least <= reach ? PastState::not_kept : PastState::ruled_out;
  if (least <= 0) {
    return past;
  }
  least = std::min(least, reach);
  std::array<int, 3> first{};
  std::array<int, 3> last{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double along = x[static_cast<Eigen::Index>(axis)];
    first[axis] = std::max(static_cast<int>(std::floor(along - least)), 0);
    last[axis] = std::min(static_cast<int>(std::floor(along + least)), count_[axis] - 1);
  }
  Voxel nearest{};
  double square = least * least;
  bool found = false;
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int i = first[0]; i <= last[0]; ++i) {
        const Eigen::Vector3d low(i, j, k);
        const double away = (x - x.cwiseMax(low).cwiseMin(low + Eigen::Vector3d::Ones())).squaredNorm();
        if ((found ? away < square : away <= square) && stamp({i, j, k}).is_set()) {
          nearest = {i, j, k};
          square = away;
          found = true;
        }
      }
    }
  }
  if (!found) {
    return past;
  }
  const Stamp since = stamp(nearest);
  if (since.removed == 0) {
    past.state = PastState::never_ruled_out;
    return past;
  }
  past.state = PastState::possible_again;
  past.possible_since_s = time_of(since.added);
  past.seen_free_s = since.removed > kDeclared ? time_of(since.removed) : Past::kNaN;
  trace(nearest, past);
  past.from_m = (past.from_world - x_world).norm();  // NaN stays NaN
  return past;
}

/// Backwards from neighbour to neighbour, to where something could be earliest: each was in the set right before the
/// next came into it.
void History::trace(Voxel at, Past& past) const noexcept {
  const int most = count_[0] * count_[1] * count_[2];
  Step step = stamp(at).added;
  for (int n = 0; n < most; ++n) {
    Voxel earliest{};
    Step of_earliest = step;
    bool never = false;
    bool outside = false;
    const bool grown = (step & 1U) != 0;
    for (const std::array<int, 3>& to : kNeighbours) {
      const Voxel beside{at.x + to[0], at.y + to[1], at.z + to[2]};
      if (!grown || never) {
        break;
      }
      if (!inside(beside)) {
        outside = true;
        continue;
      }
      const Stamp its = stamp(beside);
      if (its.was_set_before(step) && (its.removed == 0 || its.added < of_earliest)) {
        earliest = beside;
        of_earliest = its.added;
        never = its.removed == 0;
      }
    }
    if (!never && outside) {
      past.origin = PastOrigin::not_kept;
    } else if (never) {
      past.origin = PastOrigin::never_ruled_out;
      at = earliest;
    } else if (of_earliest < step) {
      at = earliest;
      step = of_earliest;
      continue;
    } else {
      past.origin = n > 0 ? PastOrigin::earlier : PastOrigin::not_told;
    }
    break;
  }
  if (past.origin != PastOrigin::not_told) {
    past.from_world = low_world_ + voxel_m_ * Eigen::Vector3d(at.x + 0.5, at.y + 0.5, at.z + 0.5);
  }
}

}  // namespace depthgrid::memory
