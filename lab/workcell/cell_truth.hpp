// What the distances in a workcell really are: between bodies, from their shapes and not from any image (FCL). The
// collision library is not visible from here.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>

#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::workcell {

/// The nearest points of two bodies, world frame, metres.
struct BodyDistance {
  std::size_t first = 0;                                         ///< index in Workcell::bodies
  std::size_t second = 0;                                        ///< index in Workcell::bodies
  double distance_m = std::numeric_limits<double>::quiet_NaN();  ///< 0 when they touch or overlap
  /// NaN when they touch or overlap.
  Eigen::Vector3d on_first_world = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d on_second_world = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// Distances between the bodies of a cell, exact to 1e-5 m. A body's mesh counts as a surface: what is wholly inside it
/// is at a distance from it. Planes are half spaces; two of them have no distance.
///
/// One thread; objects are independent of each other.
class CellTruth {
 public:
  /// Throws Error when the cell is invalid.
  explicit CellTruth(const simulation::Workcell& cell);
  ~CellTruth();
  CellTruth(const CellTruth& other) = delete;
  CellTruth& operator=(const CellTruth& other) = delete;
  CellTruth(CellTruth&& other) noexcept;
  CellTruth& operator=(CellTruth&& other) noexcept;

  /// Takes over poses and measures. Throws Error as simulation::validate_same_bodies.
  void update(const simulation::Workcell& cell);

  /// Between two different bodies; nothing when both consist of planes. Throws Error on an index that is none.
  [[nodiscard]] std::optional<BodyDistance> between(std::size_t first, std::size_t second) const;

  /// The nearest pair of a body of one kind and another body of one of the other kinds; nothing when there is none.
  [[nodiscard]] std::optional<BodyDistance> nearest(simulation::BodyKind of,
                                                    std::initializer_list<simulation::BodyKind> to) const;

  /// The nearest other body of one of these kinds; nothing when there is none.
  [[nodiscard]] std::optional<BodyDistance> nearest(std::size_t body,
                                                    std::initializer_list<simulation::BodyKind> to) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace depthgrid::workcell
