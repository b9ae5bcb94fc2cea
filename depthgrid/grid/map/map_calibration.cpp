#include "depthgrid/grid/map/map_calibration.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "depthgrid/core/error.hpp"

namespace depthgrid::grid {
namespace {

constexpr std::size_t kPrincipalNumbers = 6 + 4;
constexpr std::size_t kSecondaryNumbers = 6 + 12;
/// 2^46 cells: a table of any storage then has less than 2^63 bytes.
constexpr std::uint64_t kLargestCellCount = std::uint64_t{1} << 46U;

void append(std::vector<CalibrationNumber>& list, const std::string& of, const PinholeCamera& camera) {
  list.push_back({of + ": width [px]", static_cast<double>(camera.width_px)});
  list.push_back({of + ": height [px]", static_cast<double>(camera.height_px)});
  list.push_back({of + ": fx [px]", camera.fx_px});
  list.push_back({of + ": fy [px]", camera.fy_px});
  list.push_back({of + ": cx [px]", camera.cx_px});
  list.push_back({of + ": cy [px]", camera.cy_px});
}

int whole(double value, const std::string& name, const char* what) {
  if (!(value >= 0 && value <= std::numeric_limits<int>::max() && value == std::floor(value))) {
    fail(name, ": ", what, " is ", value, ", must be a whole number that is not negative");
  }
  return static_cast<int>(value);
}

PinholeCamera camera_from(std::span<const double> v, const std::string& name) {
  return {whole(v[0], name, "a width"), whole(v[1], name, "a height"), v[2], v[3], v[4], v[5]};
}

}  // namespace

MapCalibration map_calibration(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries) {
  return {grid.principal(), grid.quantisation(), {secondaries.begin(), secondaries.end()}};
}

void validate(const MapCalibration& calibration, const std::string& name) {
  depthgrid::validate(calibration.principal, (name + ": principal camera").c_str());
  const DepthGrid grid(calibration.principal, calibration.quantisation);
  if (calibration.secondaries.empty() || calibration.secondaries.size() > kLargestCameraCount) {
    fail(name, ": has ", calibration.secondaries.size(), " secondary cameras, a stored map needs between 1 and ",
         kLargestCameraCount);
  }
  for (std::size_t k = 0; k < calibration.secondaries.size(); ++k) {
    const std::string of = name + ": secondary camera " + std::to_string(k);
    depthgrid::validate(calibration.secondaries[k].camera, of.c_str());
    pose_from_matrix(calibration.secondaries[k].T_secondary_principal.matrix(), (of + ": pose").c_str());
  }
  if (cell_count(calibration) > kLargestCellCount / calibration.secondaries.size()) {
    fail(name, ": has ", cell_count(calibration), " cells, too many for a stored map; lower the count");
  }
}

std::size_t number_count(std::size_t camera_count) noexcept {
  return kPrincipalNumbers + camera_count * kSecondaryNumbers;
}

std::vector<CalibrationNumber> numbers(const MapCalibration& calibration) {
  std::vector<CalibrationNumber> list;
  list.reserve(number_count(calibration.secondaries.size()));
  append(list, "principal camera", calibration.principal);
  const DepthQuantisation& q = calibration.quantisation;
  list.push_back({"depth grid: d_min [m]", q.d_min_m});
  list.push_back({"depth grid: step [m]", q.step_m});
  list.push_back({"depth grid: growth", q.growth});
  list.push_back({"depth grid: count", static_cast<double>(q.count)});
  for (std::size_t k = 0; k < calibration.secondaries.size(); ++k) {
    const SecondaryCamera& secondary = calibration.secondaries[k];
    const std::string of = "secondary camera " + std::to_string(k);
    append(list, of, secondary.camera);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        list.push_back({of + ": T_secondary_principal(" + std::to_string(row) + ", " + std::to_string(column) + ")",
                        secondary.T_secondary_principal.matrix()(row, column)});
      }
    }
  }
  return list;
}

MapCalibration calibration_from_numbers(std::span<const double> values, const std::string& name) {
  if (values.size() < kPrincipalNumbers || (values.size() - kPrincipalNumbers) % kSecondaryNumbers != 0) {
    fail(name, ": calibration has ", values.size(), " numbers, must be ", kPrincipalNumbers, " and ", kSecondaryNumbers,
         " more for each secondary camera");
  }
  MapCalibration calibration;
  calibration.principal = camera_from(values, name);
  calibration.quantisation = {values[6], values[7], values[8], whole(values[9], name, "the depth grid's count")};
  for (auto rest = values.subspan(kPrincipalNumbers); !rest.empty(); rest = rest.subspan(kSecondaryNumbers)) {
    SecondaryCamera secondary;
    secondary.camera = camera_from(rest, name);
    auto entry = rest.begin() + 6;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        secondary.T_secondary_principal.matrix()(row, column) = *entry++;
      }
    }
    calibration.secondaries.push_back(secondary);
  }
  validate(calibration, name);
  return calibration;
}

std::uint64_t fingerprint(const MapCalibration& calibration) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const CalibrationNumber& number : numbers(calibration)) {
    const auto bits = std::bit_cast<std::uint64_t>(number.value == 0 ? 0.0 : number.value);
    for (unsigned shift = 0; shift < 64; shift += 8) {
      hash = (hash ^ ((bits >> shift) & 0xFFU)) * 0x100000001B3U;
    }
  }
  return hash;
}

std::string difference(const MapCalibration& made_for, const MapCalibration& wanted) {
  std::ostringstream text;
  text.precision(12);
  if (made_for.secondaries.size() != wanted.secondaries.size()) {
    text << "made for " << made_for.secondaries.size() << " secondary cameras, wanted are "
         << wanted.secondaries.size();
    return text.str();
  }
  const std::vector<CalibrationNumber> a = numbers(made_for);
  const std::vector<CalibrationNumber> b = numbers(wanted);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(std::abs(a[i].value - b[i].value) <= kCalibrationTolerance * std::max(1.0, std::abs(b[i].value)))) {
      text << a[i].name << " is " << a[i].value << " in the map, wanted is " << b[i].value;
      return text.str();
    }
  }
  return {};
}

std::uint64_t ray_count(const MapCalibration& calibration) noexcept {
  return static_cast<std::uint64_t>(calibration.principal.width_px) *
         static_cast<std::uint64_t>(calibration.principal.height_px);
}

std::uint64_t cell_count(const MapCalibration& calibration) noexcept {
  return ray_count(calibration) * static_cast<std::uint64_t>(calibration.quantisation.count);
}

}  // namespace depthgrid::grid
