// What a device says of itself against what the cell states. Internal.
#pragma once

#include "depthgrid/core/rig.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::monitor {

/// Of a source that is open. Throws Error where its images have another size than the cell's, its intrinsics are
/// others, or those of the cell are far from usual ones of such a device: points would lie elsewhere.
void refuse_other_images(const sensors::SourceInfo& told, const PinholeCamera& wanted);

/// Of its first image. Throws Error where its numbers are in another unit than the cell's.
void refuse_other_unit(const DepthView& depth, const RigCamera& wanted);

}  // namespace depthgrid::monitor
