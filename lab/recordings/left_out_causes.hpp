// Why a surface that one camera measures lies in space that another reports free.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "lab/recordings/leave_one_out.hpp"

namespace depthgrid::lab {

/// What is found at a violating reading, the first that applies.
enum class LeftOutCause : std::uint8_t {
  moved,     ///< it is at least 10 cm off its pixel's median over the recording: the person, the ball, or a wild value
  own_edge,  ///< within 3 px of a hole or a step in the left-out camera's image
  freeing_edge,     ///< the same in the image of the camera that frees it
  background_seen,  ///< the freeing camera measures at least 0.3 m behind it: it sees through the surface
  offset,           ///< both images are smooth there and their surfaces lie apart: calibration or depth bias
};
inline constexpr std::size_t kLeftOutCauses = 5;

[[nodiscard]] std::string_view to_string(LeftOutCause cause);

/// Median of every pixel's measured depths; 0 where none was measured. Images of equal size.
[[nodiscard]] DepthImage median_image(std::span<const DepthImage> images);

/// A hole, a step of more than 4 % of the depth or the image's border within 3 px.
[[nodiscard]] bool at_edge(const DepthImage& depth, int u, int v);

/// `median` is empty where the left-out camera itself moves.
[[nodiscard]] LeftOutCause cause_of(const LeftOutReading& reading, const DepthImage& left_out, const DepthImage& median,
                                    const DepthImage& freeing);

/// Sums over readings.
struct LeftOutFigures {
  std::size_t readings = 0;
  std::size_t violations = 0;
  std::size_t far_violations = 0;  ///< by more than 5 cm beyond the allowance
  std::size_t free_before = 0;     ///< readings before which the others report free space: the question is not idle
  std::size_t on_floor = 0;        ///< of the violations, those within 10 cm of the floor's height
  std::size_t edge_readings = 0;   ///< all readings at an edge of their own image, to compare shares with
  std::array<std::size_t, kLeftOutCauses> causes{};
  std::map<std::string, std::size_t> known_free_by;  ///< violations by the id of the camera that frees them by most
  std::vector<double> excesses_m;                    ///< answer - allowance of the violations
};

}  // namespace depthgrid::lab
