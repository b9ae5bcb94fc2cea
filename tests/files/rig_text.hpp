// Small rig files as text, to be changed by the tests.
#pragma once

#include <string>
#include <string_view>

namespace depthgrid::test {

/// Two cameras of 8 x 6 pixels, ten frames.
inline std::string small_rig() {
  return R"({
  "name": "small",
  "convention": "free text",
  "depth": {"metres_per_unit": 0.001, "invalid_values": [0, 2047]},
  "frames": {"first": 3, "count": 10, "simultaneous": true, "pattern": "%03d", "rate_hz": 4},
  "cameras": [
    {"id": "left", "width": 8, "height": 6, "fx": 10, "fy": 11, "cx": 3.5, "cy": 2.25,
     "T_world_cam": [[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
     "depth_files": "left/depth_%03d.png"},
    {"id": "right", "width": 8, "height": 6, "fx": 10, "fy": 11, "cx": 3.5, "cy": 2.25,
     "distortion": {"model": "plumb_bob", "coeffs": [0, 0, 0, 0, 0]},
     "metres_per_unit": 0.0005, "invalid_values": [], "near_m": 0.25, "far_m": 4, "clamp_beyond_far": true,
     "T_world_cam": [[0, 0, 1, -2], [0, 1, 0, 0], [-1, 0, 0, 2], [0, 0, 0, 1]],
     "depth_files": "right/%03d.png", "note": "free text"}
  ]
}
)";
}

/// `text` with the first `from` replaced; `from` must be there.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  return text.replace(text.find(from), from.size(), to);
}

inline std::string small_rig_with(std::string_view from, std::string_view to) {
  return replaced(small_rig(), from, to);
}

}  // namespace depthgrid::test
