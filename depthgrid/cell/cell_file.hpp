// The cell file: one YAML file that describes a robot cell (docs/run.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "depthgrid/cell/cell.hpp"

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

}  // namespace depthgrid::cell
