// What a running cell says, as messages of ROS 2. Internal.
#pragma once

#include <functional>
#include <string>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/messages/diagnostics.hpp"
#include "depthgrid/messages/distances.hpp"
#include "depthgrid/messages/markers.hpp"
#include "depthgrid/messages/transforms.hpp"
#include "depthgrid/monitor/cell_answer.hpp"

namespace depthgrid::monitor {

/// With the answer's own header: the time it is for.
[[nodiscard]] messages::Distances distances_message(const CellAnswer& answer, const Names& names,
                                                    const messages::Header& header);

/// What the answer stands on, but for the joint states of its images. `stamp` makes stamps of times; 0 of NaN.
void tell_basis(const CellAnswer& answer, const std::function<messages::Time(double)>& stamp,
                messages::Distances& message);

/// The parts as capsules, a line from each part's axis to its nearest point, and one sentence.
[[nodiscard]] messages::Markers markers_message(const CellAnswer& answer, const Names& names,
                                                const messages::Header& header);

/// `error` where the answer says stop or a camera is lost, `warn` where a camera's image is late.
[[nodiscard]] messages::Diagnostics diagnostics_message(const CellAnswer& answer, const Names& names,
                                                        const messages::Header& header);

/// From the world to each camera's frame, which is called as the camera is.
[[nodiscard]] messages::Transforms camera_frames(const Rig& rig, const messages::Header& header);

}  // namespace depthgrid::monitor
