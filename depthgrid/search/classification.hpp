// What stands at the nearest point of an answer.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "depthgrid/core/proximity.hpp"
#include "depthgrid/search/view_store.hpp"

namespace depthgrid::search {

struct Classification {
  ProximityState state = ProximityState::unobserved;
  std::optional<std::uint16_t> camera;
};

/// measured: some camera has the point between the free depth and D + m of one of the pixels that the free depth was
/// taken from, within the resolution and that camera's reach (the nearest such camera is named); else occluded: behind a
/// measured pixel of some camera; else unmeasured: a camera looks there without measurement, or so near the image's edge
/// that the filter leaves the image, or the point lies in its blind zone; else unobserved.
[[nodiscard]] Classification classify(const Snapshot& snapshot, const Eigen::Vector3d& x_world) noexcept;

}  // namespace depthgrid::search
