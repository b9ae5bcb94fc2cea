// What a depth grid map was made for: the principal camera, its depth cells and the secondary cameras.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/depth_grid.hpp"

namespace depthgrid::grid {

/// All numbers that the content of a map depends on.
struct MapCalibration {
  PinholeCamera principal;
  DepthQuantisation quantisation;
  std::vector<SecondaryCamera> secondaries;
};

/// Two numbers of a calibration that differ by more than this share of max(1, their size) are different calibrations.
/// Far below what single precision resolves, far above how machines round differently.
inline constexpr double kCalibrationTolerance = 1e-9;

/// Largest number of secondary cameras of a stored map.
inline constexpr std::size_t kLargestCameraCount = 1024;

[[nodiscard]] MapCalibration map_calibration(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries);

/// Throws Error unless grid and cameras are valid, poses finite and rigid, and the number of cameras and of cells is
/// one that a stored map can index. `name` begins the messages.
void validate(const MapCalibration& calibration, const std::string& name = "depth grid map");

/// One number of a calibration and what it is, for instance "secondary camera 1: fx [px]".
struct CalibrationNumber {
  std::string name;
  double value = 0;
};

/// All numbers in the canonical order: principal camera, quantisation, then camera by camera intrinsics and the three
/// upper rows of T_secondary_principal. Integers are exact in double.
[[nodiscard]] std::vector<CalibrationNumber> numbers(const MapCalibration& calibration);

/// How many numbers a calibration with that many secondary cameras has.
[[nodiscard]] std::size_t number_count(std::size_t camera_count) noexcept;

/// Inverse of numbers(). Throws Error when an integer is not one, or as validate(). `name` begins the messages.
MapCalibration calibration_from_numbers(std::span<const double> values, const std::string& name);

/// FNV-1a hash over the bytes of the canonical numbers, least significant byte first; -0 counts as 0.
[[nodiscard]] std::uint64_t fingerprint(const MapCalibration& calibration);

/// One line that names the first number by which the calibrations differ and both values; empty when they agree.
[[nodiscard]] std::string difference(const MapCalibration& made_for, const MapCalibration& wanted);

/// Rays of the principal image, and cells: rays times depth cells (for one secondary camera).
[[nodiscard]] std::uint64_t ray_count(const MapCalibration& calibration) noexcept;
[[nodiscard]] std::uint64_t cell_count(const MapCalibration& calibration) noexcept;

}  // namespace depthgrid::grid
