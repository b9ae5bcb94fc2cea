// What `depthgrid run` keeps beside its answers: the log of stops, and the numbers for Prometheus.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/core/whole_file.hpp"
#include "depthgrid/monitor/monitor.hpp"
#include "depthgrid/monitor/stop_log.hpp"

namespace depthgrid::program {

/// Files of cell.outputs. One that cannot be written later on is told once, and the cell runs on.
class Records {
 public:
  /// Throws Error where a file cannot be written. The monitor outlives it.
  Records(const cell::Cell& cell, const cell::CellSetup& setup, const monitor::Monitor& monitor);

  void event(const monitor::Event& event);
  /// Now and then: once a second the numbers are written.
  void look(const monitor::CellAnswer& newest);
  /// The numbers as they are at the end: nobody answers any more.
  void end(const monitor::CellAnswer& newest);
  /// A file could not be written, and its user was told.
  [[nodiscard]] bool has_failed() const noexcept { return has_failed_; }

 private:
  void write_numbers(const monitor::CellAnswer& newest, bool has_ended);

  const monitor::Monitor& monitor_;
  monitor::StopLogSettings settings_;
  std::filesystem::path log_name_;
  std::unique_ptr<std::FILE, CloseStream> log_;  ///< null: none, or it failed
  std::filesystem::path numbers_;                ///< empty: none, or they failed
  double next_s_ = 0;
  bool has_failed_ = false;
};

}  // namespace depthgrid::program
