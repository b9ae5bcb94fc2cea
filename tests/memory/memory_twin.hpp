// The memory, slow and obvious: every voxel against every pixel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/memory/voxel_set.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::memory {

/// How far a point in the camera's frame is from what one image does not show free: from the frustum of every pixel
/// beyond its free depth, from the blind zone, the robot taken out of both, and from what lies outside of the image.
double distance_to_not_free_m(const views::View& view, const RigCamera& camera, const Eigen::Vector3d& p_camera);

/// What the memory was, and how it became so.
struct TwinStep {
  double time_s;
  bool grown;  ///< from the step before by one voxel to all sides; else voxels were taken out or put back
  std::vector<std::uint8_t> bits;
};

/// Fed with the same images as a MemoryStore, one at a time. Where a voxel is on the brink, within what the exact test
/// may err, it does as the other did.
class MemoryTwin {
 public:
  MemoryTwin(const views::Settings& settings, const MemorySettings& memory, const VoxelSet& first);

  /// The camera's image; `other`: what the store made of it.
  void take(const views::Snapshot& snapshot, std::size_t camera, const VoxelSet& other);

  [[nodiscard]] bool contains(int x, int y, int z) const { return bits_[index(x, y, z)] != 0; }
  [[nodiscard]] double pending_m() const { return pending_m_; }
  /// Since the beginning, or since time began anew.
  [[nodiscard]] const std::vector<TwinStep>& steps() const { return steps_; }
  [[nodiscard]] std::size_t index(int x, int y, int z) const;
  [[nodiscard]] int brinks() const { return brinks_; }
  [[nodiscard]] int carved() const { return carved_; }
  [[nodiscard]] int put_back() const { return put_back_; }
  [[nodiscard]] int robots() const { return robots_; }

 private:
  [[nodiscard]] bool before(const std::vector<std::uint8_t>& bits, int x, int y, int z) const;
  void grow(double motion_m, double until_s);
  void carve(const views::Snapshot& snapshot, std::size_t camera, double late_s, const VoxelSet& other);
  void clear_robot(const views::Snapshot& snapshot, std::size_t camera, double late_s, const VoxelSet& other);
  void seed(const views::Snapshot& snapshot, std::size_t camera, const VoxelSet& other);
  [[nodiscard]] bool is_freed(const views::Snapshot& snapshot, std::size_t camera,
                              const Eigen::Vector3d& centre_world) const;

  const views::Settings& settings_;
  MemorySettings memory_;
  Eigen::Vector3d low_;
  int nx_, ny_, nz_;
  std::vector<std::uint8_t> bits_;
  std::vector<TwinStep> steps_;
  double pending_m_ = 0;
  double time_s_;
  bool everything_ = true;
  int brinks_ = 0, carved_ = 0, put_back_ = 0, robots_ = 0;
};

}  // namespace depthgrid::memory
