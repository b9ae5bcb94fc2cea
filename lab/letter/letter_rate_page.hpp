// The page about the grid evaluators' rate: table, plot and the ratios that CI holds.
#pragma once

#include <span>
#include <string>

#include "lab/letter/letter_rate_rows.hpp"

namespace depthgrid::lab {

[[nodiscard]] std::string rate_table_head();
[[nodiscard]] std::string rate_table_row(const RateRow& row);

/// Time against the number of cameras, logarithmic. Throws Error when the file cannot be written.
void draw_rate_plot(const std::string& file, std::span<const RateRow> rows);

/// Throws Error when the file cannot be written.
void write_rate_page(const std::string& file, std::span<const RateRow> rows, int frame_sets);

/// One line about the first claimed ratio that does not hold; empty when all do. Ratios of the cells that are checked,
/// which decide the time and, unlike it, are the same in every run.
[[nodiscard]] std::string broken_ratio(std::span<const RateRow> rows);

}  // namespace depthgrid::lab
