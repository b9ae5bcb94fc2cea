// Writes the datagram of datagram.h.
#pragma once

#include <array>
#include <cstddef>

#include "depthgrid/network/datagram.h"

namespace depthgrid::network {

using Datagram = std::array<unsigned char, DEPTHGRID_DATAGRAM_SIZE>;

/// The bytes of an answer; cameras and parts beyond its counts are NaN and not_evaluated. Distances are rounded down,
/// so that they stay lower bounds. Allocates and throws nothing.
[[nodiscard]] Datagram write_datagram(const depthgrid_answer& answer) noexcept;

/// The nearest float that is not above the number; NaN stays.
[[nodiscard]] float rounded_down(double value) noexcept;
/// And not below.
[[nodiscard]] float rounded_up(double value) noexcept;

}  // namespace depthgrid::network
