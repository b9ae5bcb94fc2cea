// Random rigs for the tests of the depth grid map: small, and of every kind that is easy to get wrong.
#pragma once

#include <cstdint>
#include <iomanip>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/map/map_calibration.hpp"

namespace depthgrid::grid {

inline PinholeCamera random_camera(std::mt19937_64& random, int largest_width_px) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  PinholeCamera camera;
  camera.width_px = std::uniform_int_distribution<int>(1, largest_width_px)(random);
  camera.height_px = std::uniform_int_distribution<int>(1, largest_width_px)(random);
  camera.fx_px = camera.width_px * between(0.4, 1.5);
  camera.fy_px = camera.fx_px * between(0.9, 1.1);
  camera.cx_px = camera.width_px * between(0.3, 0.7);
  camera.cy_px = camera.height_px * between(0.3, 0.7);
  return camera;
}

/// A principal camera in the world's frame that looks along z, with one to three secondary cameras: beside it, facing
/// it, in its own place, inside its frustum (so that cells reach behind the secondary camera), or turned away.
inline MapCalibration random_map_rig(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto pick = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
  MapCalibration rig;
  rig.principal = random_camera(random, 14);
  rig.quantisation.d_min_m = pick(4) == 0 ? 0.0 : between(0.05, 1.0);
  rig.quantisation.step_m = between(0.005, 0.2);
  rig.quantisation.growth = pick(2) == 0 ? 0.0 : between(0.0, 0.1);
  rig.quantisation.count = 1 + pick(40);
  for (int k = pick(3); k >= 0; --k) {
    SecondaryCamera secondary;
    secondary.camera = random_camera(random, pick(2) == 0 ? 12 : 80);
    const Eigen::Vector3d middle(between(-0.3, 0.3), between(-0.3, 0.3), between(0.3, 2.0));
    Eigen::Vector3d place(between(-3, 3), between(-2, 2), between(-0.5, 3));
    Pose T_world_secondary = Pose::Identity();
    switch (pick(5)) {
      case 0:  // in the principal camera's place, turned a little or not at all
        T_world_secondary.linear() =
            Eigen::AngleAxisd(pick(2) * between(-0.5, 0.5), Eigen::Vector3d::UnitY()).toRotationMatrix();
        break;
      case 1:  // inside the frustum, looking any way
        place = Eigen::Vector3d(between(-0.1, 0.1), between(-0.1, 0.1), between(0.1, 2));
        T_world_secondary = look_at(place, place + Eigen::Vector3d(between(-1, 1), between(-1, 1), between(-1, 1)),
                                    Eigen::Vector3d(0.1, -1, 0.3));
        break;
      case 2:  // facing
        place = Eigen::Vector3d(between(-0.5, 0.5), between(-0.5, 0.5), between(2, 4));
        T_world_secondary = look_at(place, middle, Eigen::Vector3d(0, -1, 0));
        break;
      case 3:  // turned away
        T_world_secondary = look_at(place, 2 * place - middle, Eigen::Vector3d(0, -1, 0.1));
        break;
      default:  // beside
        T_world_secondary = look_at(place, middle, Eigen::Vector3d(0, -1, 0.1));
    }
    secondary.T_secondary_principal = T_world_secondary.inverse();
    rig.secondaries.push_back(secondary);
  }
  return rig;
}

inline DepthGrid grid_of(const MapCalibration& rig) { return DepthGrid(rig.principal, rig.quantisation); }

/// All numbers in full precision, in the order that calibration_from_numbers() takes.
inline std::string describe(const MapCalibration& rig) {
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10) << "calibration_from_numbers({";
  for (const CalibrationNumber& number : numbers(rig)) {
    text << number.value << ", ";
  }
  text << "})";
  return text.str();
}

}  // namespace depthgrid::grid
