#include "depthgrid/memory/settings.hpp"

#include <cmath>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::memory {
namespace {

constexpr const char* kName = "memory settings: ";
constexpr double kSmallestVoxel = 0.005;
constexpr double kLargestVoxel = 0.5;
/// 16 MiB for each copy.
constexpr double kMostVoxels = 1 << 27;

void check_region(const MemorySettings& settings) {
  double voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = settings.low_world[axis];
    const double high = settings.high_world[axis];
    const char name = "xyz"[axis];
    if (!(std::abs(low) <= kLargestTranslation && std::abs(high) <= kLargestTranslation)) {
      fail(kName, "region reaches from ", low, " to ", high, " m in ", name, ", must be set and stay within ",
           kLargestTranslation, " m of the world's origin: the robot's reach and rho around it are enough");
    }
    if (!(low < high)) {
      fail(kName, "region reaches from ", low, " to ", high, " m in ", name,
           ", the low corner must lie below the high one");
    }
    voxels *= (high - low) / settings.voxel_m + 4;
  }
  if (!(voxels <= kMostVoxels)) {
    fail(kName, "region has ", voxels, " voxels of ", settings.voxel_m, " m, must have at most ", kMostVoxels,
         ": keep the robot's surroundings only, or take larger voxels");
  }
}

void check_start(const StartEmptyAroundRobot& start) {
  if (start.robot_world.empty()) {
    fail(kName, "start: empty around the robot, but no capsules of the robot are given");
  }
  for (const Capsule& capsule : start.robot_world) {
    if (!(capsule.a.allFinite() && capsule.b.allFinite() && std::isfinite(capsule.radius_m) && capsule.radius_m >= 0)) {
      fail(kName, "start: a capsule of the robot is not finite or has a negative radius (", capsule.radius_m, " m)");
    }
  }
  if (!(std::isfinite(start.distance_m) && start.distance_m >= 0)) {
    fail(kName, "start: distance around the robot is ", start.distance_m, " m, must be finite and not negative");
  }
}

}  // namespace

void validate(const MemorySettings& settings) {
  if (!(settings.voxel_m >= kSmallestVoxel && settings.voxel_m <= kLargestVoxel)) {
    fail(kName, "voxel is ", settings.voxel_m, " m, must be between ", kSmallestVoxel, " and ", kLargestVoxel,
         " m: 0.025 m suits a robot's cell");
  }
  check_region(settings);
  if (std::holds_alternative<std::monostate>(settings.start)) {
    fail(kName, "the start is not declared: choose StartUnknown, StartEmptyAroundRobot or StartEmpty");
  }
  if (const auto* start = std::get_if<StartEmptyAroundRobot>(&settings.start)) {
    check_start(*start);
  }
  if (!(settings.thinnest_hidden_m >= 0 && settings.thinnest_hidden_m <= 1)) {
    fail(kName, "thinnest hidden thing is ", settings.thinnest_hidden_m,
         " m, must be between 0 and 1 m; 0 claims nothing about what is hidden");
  }
}

}  // namespace depthgrid::memory
