// What stands at the nearest point of an answer. Internal.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "depthgrid/core/proximity.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::search {

struct Classification {
  ProximityState state = ProximityState::unobserved;
  std::optional<std::uint16_t> camera;
  Unmeasured unmeasured = Unmeasured::not_told;
};

/// measured: some camera has the point within its margin, the resolution and its pose error of a depth measured in one
/// of the pixels that the point's free depth was taken from, or, when these say nothing, in those beside them that keep
/// the ball of resolution and pose error around the point from being free (the nearest such camera is named); else
/// occluded: behind a measured pixel of a camera that looks there; else unmeasured: a camera looks there without
/// measurement, or so near the image's edge that the filter or the ball leaves the image, or the ball reaches its blind
/// zone; else unobserved. Which of them it is says Unmeasured, whose order is that of the reasons here.
[[nodiscard]] Classification classify(const views::Snapshot& snapshot, const Eigen::Vector3d& x_world) noexcept;

}  // namespace depthgrid::search
