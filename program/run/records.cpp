#include "program/run/records.hpp"

#include <cerrno>
#include <string>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/monitor/prometheus_text.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "program/output_file.hpp"
#include "program/warning.hpp"

namespace depthgrid::program {

Records::Records(const cell::Cell& cell, const cell::CellSetup& setup, const monitor::Monitor& monitor)
    : monitor_(monitor),
      settings_{.names = monitor.names(), .rig = setup.rig, .moves = {}, .stopping_s = cell.ask.stopping_s},
      log_name_(cell.outputs.log),
      numbers_(cell.outputs.prometheus) {
  for (const cell::CameraEntry& camera : cell.cameras) {
    settings_.moves.push_back(!camera.frame.empty());
  }
  if (!log_name_.empty()) {
    log_.reset(std::fopen(log_name_.c_str(), "ae"));
    if (log_ == nullptr) {
      fail(log_name_.string(), ": cannot be written: ", std::generic_category().message(errno));
    }
  }
  if (!numbers_.empty()) {
    OutputFile(numbers_.string()).commit();  // as it can be written
  }
}

void Records::event(const monitor::Event& event) {
  const bool is_told = event.kind == monitor::EventKind::stop || event.kind == monitor::EventKind::go;
  if (log_ == nullptr || !is_told) {
    return;
  }
  const std::string line = monitor::stop_log_line(event, settings_) + "\n";
  if (std::fputs(line.c_str(), log_.get()) < 0 || std::fflush(log_.get()) != 0) {
    warn(log_name_.string() + ": cannot be written: " + std::generic_category().message(errno) + "; the log ends here");
    log_.reset();
    has_failed_ = true;
  }
}

void Records::write_numbers(const monitor::CellAnswer& newest, bool has_ended) {
  if (numbers_.empty()) {
    return;
  }
  try {
    OutputFile file(numbers_.string());
    file.write(monitor::prometheus_text(monitor_, newest, has_ended));
    file.commit();
  } catch (const Error& error) {
    std::error_code ignored;
    std::filesystem::remove(numbers_, ignored);  // old ones would say for ever what was
    warn(std::string(error.what()) + "; no numbers for Prometheus any more");
    numbers_.clear();
    has_failed_ = true;
  }
}

void Records::look(const monitor::CellAnswer& newest) {
  const double now_s = sensors::clock_now_s();
  if (now_s >= next_s_) {
    next_s_ = now_s + 1;
    write_numbers(newest, false);
  }
}

void Records::end(const monitor::CellAnswer& newest) { write_numbers(newest, true); }

}  // namespace depthgrid::program
