// Four experiments that isolate one error of the letter each, at 640x480 pixels, f = 525 px, rho = 0.4 m, 1 cm cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace depthgrid::lab {

/// Equations (8)-(9): a single near pixel is moved sideways, at the point's own depth, until it is no longer found.
struct WindowMiss {
  double depth_m = 0;
  double first_missed_m = 0;  ///< distance of the nearest obstacle that the printed window misses
  double last_whole_m = 0;    ///< distance of the farthest one that the whole image finds; rho at most
};
std::vector<WindowMiss> measure_window();

/// Over-estimates of a formula over random cases, metres.
struct Excess {
  std::string name;
  std::int64_t cases = 0;
  double median_m = 0, q99_m = 0, largest_m = 0;
};

/// Equations (5)-(7) against the exact distance, for cells and for the surface of case (ii), by depth of the point.
std::vector<Excess> measure_clamp(std::uint64_t seed, std::int64_t cases);

/// Case (iii): two cells on a ray are obstacles, one on either side of the point's depth; the first by |j| against the
/// nearer one. By angle off the optical axis; `capped` at rho, as an evaluation answers, and uncapped.
std::vector<Excess> measure_order(std::uint64_t seed, std::int64_t cases);

/// A small object in front of a far background; the point is beside or behind it.
struct Vanishing {
  std::string object;
  int secondaries = 0;
  bool point_behind = false;  ///< the point is deeper than the object in the principal camera
  int trials = 0;
  int letter = 0;     ///< trials in which the letter's answer misses the object
  int corrected = 0;  ///< the same for the corrected evaluation
};
std::vector<Vanishing> measure_vanishing(std::uint64_t seed, int trials, int threads,
                                         const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace depthgrid::lab
