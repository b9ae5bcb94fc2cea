// How far the links of a simulated cell's arm really are from what stands and walks there, and whether an answer says
// more.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "depthgrid/cell/cell.hpp"
#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/sensors/simulated_cell.hpp"

namespace depthgrid::lab {

/// An image that an answer stands on.
struct UsedImage {
  std::size_t camera = 0;
  double time_s = 0;  ///< of the cell
};

/// - Units: metres, seconds of the cell's time. - Threads: one.
class RunningTruth {
 public:
  RunningTruth(const cell::Cell& cell, const cell::CellSetup& setup,
               std::shared_ptr<const sensors::SimulatedCell> simulated);

  /// From a part's surface to the nearest solid within the space of interest; not below 0, infinite where there is
  /// none. Exact to 1e-6 m.
  [[nodiscard]] double distance_m(std::size_t part, double time_s);

  /// By how much an answer exceeds the distance to what it speaks of: not what stood within the blind layer around the
  /// robot when the images were exposed, and not what was hidden right behind the robot from one of them, within the
  /// pockets that the cell's policy ignores. Nothing where it does not.
  [[nodiscard]] std::optional<double> excess_m(std::size_t part, double time_s, double said_m, double blind_m,
                                               const std::vector<UsedImage>& images);

  /// Parts that were nearer to something than an answer said, and all of it within the layer or a pocket.
  [[nodiscard]] std::size_t unclaimed() const noexcept { return unclaimed_; }

 private:
  void go_to(double time_s);
  [[nodiscard]] std::vector<Capsule> robot_at(double time_s) const;

  views::BoxSpace space_;
  double pocket_m_;
  double v_max_m_s_;
  std::optional<robot::PlacedRobot> robot_;
  std::vector<robot::LinkCapsule> links_;
  std::vector<cell::AskedPart> parts_;
  std::vector<Eigen::Vector3d> cameras_world_;
  std::shared_ptr<const sensors::SimulatedCell> simulated_;
  double at_s_ = -1;
  simulation::Workcell bodies_;
  std::vector<Capsule> parts_world_;
  std::size_t unclaimed_ = 0;
};

}  // namespace depthgrid::lab
