// The parts of the pages that no number changes.
#pragma once

namespace depthgrid::lab {

inline constexpr const char* kSummaryIntroduction = R"(# Benchmark

The search on a simulated cell: an arm, two people, depth cameras of 640 x 480 pixels, nine control points, rho = 0.4 m, resolution
5 mm, one core. Everything else is in [docs/benchmark-search.md](docs/benchmark-search.md): how it was measured, all peers,
errors, frames made to be slow; the grid alone in [docs/benchmark.md](docs/benchmark.md).

Made by `./scripts/benchmark` from one run; all numbers: [lab/results/benchmark.json](lab/results/benchmark.json).

)";

inline constexpr const char* kSummaryGoals =
    "Which goals were set before, which are reached and which are missed: [docs/goals.md](docs/goals.md).\n";

inline constexpr const char* kSummaryCycle = R"(## Beside what would be used instead

The cycle is everything from the 16-bit images to nine distances. Each row was measured in turns with ours, so compare ratios,
not times of different rows or tables.

)";

inline constexpr const char* kSummaryPeers =
    R"(Over-estimates are against a proven interval of the distance to space that no camera has seen free. Who does not count occluded
space answers another question, and a tree answers it quickly once it is built.

)";

inline constexpr const char* kDetailsIntroduction = R"(# Benchmark of the search

Made by `./scripts/benchmark` from one run; all numbers: [lab/results/benchmark.json](../lab/results/benchmark.json). One screen of
it: [BENCHMARK.md](../BENCHMARK.md). The goals and what is missed of them: [goals.md](goals.md). The grid evaluators alone:
[benchmark.md](benchmark.md).

)";

inline constexpr const char* kMethod = R"(## How it was measured

- Workload W: a room of 6.6 x 6.6 m with a table, five boxes, an arm of 7 capsules and two people of 17 capsules each, all
  moving; up to eight cameras of 640 x 480 pixels around it at 30 Hz, nine control points along the arm at 480 Hz, rho =
  0.4 m. The space of interest is a box of 3 x 3 x 2 m. Masked: the cameras see the arm, and its depth interval tells which
  pixels; the shadow that it casts is occluded like any other. Removed: they see through it as if it were not there.

- The noisy variant has axial noise of 0.5 mm + 1.5 mm/m² z² (10 mm at 2.5 m), quantisation of 11 mm at
  2 m, one invalid pixel in a hundred and robot intervals padded by 10 cm; there ours runs with margins that cover the noise
  (three standard deviations and half a step) and a calibration error of 5 mm and 1 mrad, on W with an ideal sensor and a
  filter radius of one pixel.

- Everybody gets the same frames. Pixels that show the robot are left out of clouds, and looked through up to the robot's
  exit where shadows count. Points lie in the robot, so where something hides the robot, its volume behind counts as
  occluded for all but ours and the oracle, which know that it is the robot.

- Prepare: from the 16-bit images to ready to answer. Nine: one call with nine points. Cycle: prepare, then the first nine
  points. Times are CPU time of the one thread that is used; peers run single-threaded.

- Ours runs a whole cycle after every frame set of every peer, so each ratio has both its times from the same seconds.

- Too far and too near: against a reference that proves an interval of the distance to space that no camera has seen free
  (ideal sensor, clean images, errors below its interval count as none), cut off at rho. Too far is the dangerous side.

- Memory: growth of the process's peak while the peer was made and answered its first frame set; below 2 MB it is noise.

- Nothing near, nothing within rho: nine points in free space. Deep: nine points at least 0.1 m deep in space that no camera
  sees free. Both are chosen in the clean images, the noisy variant's too: there holes put obstacles near the former.

- Peers that need over a second for a frame set ran on three of them; a row stops after its share of the time.
)";

inline constexpr const char* kSetups = R"(## How the peers are set up

All from Debian 12 packages, built like this project for any x86-64; scans choose AVX2 or AVX-512 at run time as ours does.

- nanoflann: single-index tree, leaves of 10 points (its default) or 32, search bounded by rho. The tree is built anew for
  every frame set. Arm box: only points within rho of the box that contains all control points.

- PCL: `KdTreeFLANN`, `VoxelGrid` before it where it says so.

- OctoMap: `computeDiscreteUpdate` (one ray a voxel) with lazy evaluation, rays of at most 4 m, no bounding box: with
  one, OctoMap carves nothing along rays that end outside. Rays to the robot carve up to its exit. With unknown space free
  the map is kept between frame sets, as OctoMap is meant, and lags behind people; with unknown space occupied every frame
  set gets an empty map. dynamicEDT3D covers the arm's box, answers by voxel, and follows the changes of a kept map.

- FCL: distance of a sphere of 1 mm to the occupied voxels of the same octree.

- Scan of the cloud: every point, with vector instructions. Scan of the window: every pixel that may lie within rho, a
  pixel's ray counts from its depth on. The maximum over the cameras counts what lies outside an image too, without which it
  would be no bound.

- Lattice: points around the control point in order of distance, each tested against every camera; about 30 lines.

- `letter` and `corrected`: this project's grid evaluators with cells of 1 cm; their space of interest is the first camera's
  view.
)";

}  // namespace depthgrid::lab
