// A running cell's answers as JSON lines in a file.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>

#include "depthgrid/monitor/monitor.hpp"

namespace depthgrid::program {

/// A line an answer; "-" is standard output. A line that cannot be written is told once, sets `failed`, and is counted
/// by the monitor as passed over; later ones are tried again. Throws Error where the file cannot be opened.
[[nodiscard]] std::unique_ptr<monitor::Output> json_lines(const std::filesystem::path& file, monitor::Names names,
                                                          std::shared_ptr<std::atomic<bool>> failed);

}  // namespace depthgrid::program
