// The cell file: one YAML file that describes a robot cell (docs/run.md).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "depthgrid/cell/cell.hpp"
#include "depthgrid/core/camera.hpp"

namespace depthgrid::cell {

/// Reads a cell file. Relative paths in it are relative to its folder. Throws Error with one line:
/// "FILE:LINE:COLUMN: KEY: value, rule, hint". Refused are unknown keys (the nearest known one is named), keys that
/// stand twice, missing values of what decides what counts as an obstacle, and numbers out of range. No other file is
/// looked at: setup() does that.
[[nodiscard]] Cell load_cell(const std::filesystem::path& file);

/// The same from text. `file` stands for the file in messages, and relative paths begin in its folder.
[[nodiscard]] Cell parse_cell(std::string_view text, const std::filesystem::path& file);

/// A commented cell file with two RealSense D435 and a Franka Panda, to be edited: what `depthgrid cell new` writes.
[[nodiscard]] std::string_view example_cell() noexcept;

/// A camera that was found, for such a file.
struct ExampleCamera {
  std::string name;
  std::string source;
  std::string serial{};                       ///< empty: it does not say one
  std::optional<PinholeCamera> intrinsics{};  ///< none: left open in the file
  double metres_per_unit = 0.001;             ///< of its images
  bool is_calibrated = false;                 ///< the intrinsics are its own
  std::string sensor{};                       ///< a sensor model; empty: left open in the file
  std::string comment{};                      ///< what it is
};

/// The same file with these cameras, if there are any. Poses are yours to fill in.
[[nodiscard]] std::string example_cell(std::span<const ExampleCamera> cameras);

}  // namespace depthgrid::cell
