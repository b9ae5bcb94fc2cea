#include "depthgrid/search/verdict_tree.hpp"

#include <algorithm>

#include "depthgrid/search/exact_tests.hpp"

namespace depthgrid::search {
namespace {

constexpr std::array<float, 2> kSigns{-1, 1};

std::uint8_t bit_of(std::size_t lane) noexcept { return static_cast<std::uint8_t>(1U << lane); }

}  // namespace

VerdictTree::VerdictTree(std::size_t capacity) : nodes_(std::max(capacity, std::size_t{1}) + 1) {}

bool VerdictTree::aim(const views::Snapshot& snapshot, const memory::MemorySnapshot* memory) noexcept {
  const std::uint64_t memory_version = memory != nullptr ? memory->version() : 0;
  bool same = camera_count_ == snapshot.camera_count() && memory_version_ == memory_version &&
              late_cameras_ == snapshot.late_cameras();
  for (std::size_t k = 0; same && k < camera_count_; ++k) {
    same = versions_[k] == snapshot.view(k).version();
  }
  if (same) {
    return false;
  }
  camera_count_ = snapshot.camera_count();
  memory_version_ = memory_version;
  late_cameras_ = snapshot.late_cameras();
  for (std::size_t k = 0; k < camera_count_; ++k) {
    versions_[k] = snapshot.view(k).version();
  }
  make_query(snapshot, memory, query_);
  used_ = 1;
  return true;
}

void VerdictTree::make_room(std::size_t nodes) noexcept {
  if (nodes_.size() - used_ < nodes) {
    used_ = 1;
  }
}

void VerdictTree::ask(const Cube& cube, VerdictNode& node, Count& count) noexcept {
  node = VerdictNode{};
  node.cube = cube;
  node.open = static_cast<std::uint8_t>(open_children(query_, cube));
  ++count.nodes;
}

VerdictNode& VerdictTree::root(Count& count) noexcept {
  if (used_ == 1) {
    ask({0, 0, 0, 0}, nodes_[used_++], count);
  }
  return nodes_[1];
}

Cube VerdictTree::child_cube(const VerdictNode& node, std::size_t lane) const noexcept {
  const float half_m = query_.lattice.half_side_m(node.cube.level + 1);
  return {node.cube.x + kSigns[lane & 1U] * half_m, node.cube.y + kSigns[(lane >> 1U) & 1U] * half_m,
          node.cube.z + kSigns[(lane >> 2U) & 1U] * half_m, node.cube.level + 1};
}

VerdictNode& VerdictTree::child(VerdictNode& node, std::size_t lane, VerdictNode& spare, Count& count) noexcept {
  if (node.child[lane] != 0) {
    return nodes_[node.child[lane]];
  }
  ask(child_cube(node, lane), spare, count);
  const bool returns = spare.open != 0 || spare.cube.level >= query_.lattice.leaf_level;
  if (!returns || used_ == nodes_.size()) {
    return spare;
  }
  node.child[lane] = static_cast<std::uint32_t>(used_);
  nodes_[used_] = spare;
  return nodes_[used_++];
}

bool VerdictTree::has_free_ball(VerdictNode& node, std::size_t lane, Count& count) noexcept {
  if ((node.tested & bit_of(lane)) == 0) {
    node.tested |= bit_of(lane);
    node.free_ball |= is_free(query_, child_cube(node, lane), count) ? bit_of(lane) : std::uint8_t{0};
  }
  return (node.free_ball & bit_of(lane)) != 0;
}

bool VerdictTree::has_blocked_centre(VerdictNode& node, std::size_t lane) noexcept {
  if ((node.asked_centre & bit_of(lane)) == 0) {
    const Box box = box_of(query_, child_cube(node, lane));
    node.asked_centre |= bit_of(lane);
    node.blocked_centre |= is_blocked(query_, 0.5 * (box.low + box.high), 0) ? bit_of(lane) : std::uint8_t{0};
  }
  return (node.blocked_centre & bit_of(lane)) != 0;
}

}  // namespace depthgrid::search
