// What has been found out about the cubes of the lattice in one snapshot: shared by all questions to it. Internal.
//
// A verdict depends on the snapshot and the cube alone. What is remembered therefore decides how long a question takes,
// never what is answered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "depthgrid/core/aligned_vector.hpp"
#include "depthgrid/search/cube_query.hpp"
#include "depthgrid/search/search.hpp"

namespace depthgrid::search {

/// A cube whose children have been asked about. Bit i of the masks: child i.
struct alignas(64) VerdictNode {
  std::array<std::uint32_t, 8> child{};  ///< index of the child's node; 0: there is none
  Cube cube{};
  std::uint8_t open = 0;            ///< neither outside W nor known free by its box
  std::uint8_t tested = 0;          ///< its ball has been tested
  std::uint8_t free_ball = 0;       ///< and is known free
  std::uint8_t exhausted = 0;       ///< it is known that none of its leaves is left
  std::uint8_t asked_centre = 0;    ///< its centre has been looked at
  std::uint8_t blocked_centre = 0;  ///< and lies in the obstacle set
};

class VerdictTree {
 public:
  /// Room for so many nodes, at least one.
  explicit VerdictTree(std::size_t capacity);

  /// From here on about this snapshot and, unless it is null, this memory, which have to be held. True when one of
  /// them is another one than before.
  bool aim(const views::Snapshot& snapshot, const memory::MemorySnapshot* memory) noexcept;
  [[nodiscard]] const CubeQuery& query() const noexcept { return query_; }
  [[nodiscard]] std::size_t capacity() const noexcept { return nodes_.size() - 1; }
  /// Forgets everything unless there is room for so many more nodes.
  void make_room(std::size_t nodes) noexcept;

  [[nodiscard]] VerdictNode& root(Count& count) noexcept;
  [[nodiscard]] Cube child_cube(const VerdictNode& node, std::size_t lane) const noexcept;
  /// The node of a child. `spare` where there is no room for another, or nobody will ask again: its
  /// parent is told that there is nothing in it.
  [[nodiscard]] VerdictNode& child(VerdictNode& node, std::size_t lane, VerdictNode& spare, Count& count) noexcept;
  /// Whether the ball around a child is known free. Asked from the lattice's exact_level on.
  [[nodiscard]] bool has_free_ball(VerdictNode& node, std::size_t lane, Count& count) noexcept;
  /// Whether the centre of a child's part of W lies in the obstacle set.
  [[nodiscard]] bool has_blocked_centre(VerdictNode& node, std::size_t lane) noexcept;

 private:
  void ask(const Cube& cube, VerdictNode& node, Count& count) noexcept;

  CubeQuery query_;
  AlignedVector<VerdictNode> nodes_;  ///< number 0 stands for none, 1 is the root
  std::size_t used_ = 1;
  std::array<std::uint64_t, views::kMaxCameras> versions_{};
  std::size_t camera_count_ = 0;
  std::uint64_t memory_version_ = 0;  ///< 0: no memory
  std::uint32_t late_cameras_ = 0;
};

}  // namespace depthgrid::search
