#include "program/run/run_text.hpp"

#include <array>
#include <optional>

#include "report/number_text.hpp"

namespace depthgrid::program {
namespace {

using monitor::TimeHistogram;
using report::fixed;

std::string ms(std::optional<double> seconds) { return seconds ? fixed(*seconds * 1e3, *seconds < 0.01 ? 2 : 1) : "-"; }

/// "median 1.20, 99.9 % 3.40, largest 5.10 ms".
std::string spread(const TimeHistogram& times) {
  if (times.count() == 0) {
    return "none";
  }
  return "median " + ms(times.quantile_s(0.5)) + ", 99.9 % " + ms(times.quantile_s(0.999)) + ", largest " +
         ms(times.largest_s()) + " ms";
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
  return report::percent_of(static_cast<double>(part), static_cast<double>(whole));
}

std::string counts(const monitor::SourceCounts& source, const char* what) {
  std::string text = std::to_string(source.taken) + " " + what;
  const auto add = [&](std::int64_t count, const char* words) {
    if (count > 0) {
      text += ", " + std::to_string(count) + " " + words;
    }
  };
  add(source.skipped, "passed over");
  add(source.refused, "refused");
  add(source.dropped, "dropped");
  add(source.failures, "failures");
  add(source.opened - 1, "times opened again");
  return text;
}

std::string recorded_text(const monitor::RecorderCounts& recorded) {
  std::string text;
  const auto add = [&](std::uint64_t count, std::uint64_t dropped, const char* what) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
    text += dropped > 0 ? " (" + std::to_string(dropped) + " dropped)" : "";
  };
  add(recorded.images, recorded.dropped_images, "images");
  add(recorded.joint_states, recorded.dropped_joint_states, "joint states");
  add(recorded.answers, recorded.dropped_answers, "answers");
  return text + (recorded.failed ? "; it failed" : "");
}

}  // namespace

std::string status_line(const monitor::CellAnswer& answer, const monitor::Names& names) {
  std::array<char, 640> buffer{};
  monitor::Reason reason = answer.reason;
  reason.camera.reset();  // told below, of every camera
  std::string why(monitor::sentence(reason, names, buffer));
  why = why.substr(0, why.find(';'));
  std::string line = answer.stop ? "stop  " : "go    ";
  line += why + ", blind layer " + fixed(answer.blind_m, 3) + " m";
  for (std::size_t k = 0; k < answer.camera_count; ++k) {
    const monitor::CameraBasis& camera = answer.cameras.at(k);
    line += " | " + names.cameras.at(k) + " " + fixed(1e3 * camera.age_s, 0) + " ms";
    if (camera.state != monitor::CameraState::live || camera.late) {
      line +=
          " (" +
          std::string(camera.late && camera.state == monitor::CameraState::live ? "late" : to_string(camera.state)) +
          ")";
    } else {
      line += ", " + fixed(100 * camera.without_reading, 0) + " % without reading";
    }
  }
  return line;
}

std::string summary(const monitor::Monitor& monitor, const std::vector<std::string>& outputs,
                    const std::vector<std::string>& stops) {
  const monitor::MonitorReport report = monitor.report();
  const monitor::Names& names = monitor.names();
  std::string text = fixed(report.seconds, 1) + " s, " + std::to_string(report.answers) + " answers, " +
                     percent(report.stopped, report.answers) + " of them stop; " + std::to_string(report.stops) +
                     (report.stops == 1 ? " stop\n" : " stops\n");
  text += "  from exposure to answer   " + spread(monitor.exposure_to_answer()) + "\n";
  text += "  one question              " + spread(monitor.asking()) + "\n";
  text += "  between two questions     " + spread(monitor.period()) + "; " + std::to_string(report.late_questions) +
          " late by more than a period\n";
  text += "  between the images        " + spread(monitor.skew()) + "\n";
  text += "  answers by state         ";
  for (std::size_t i = 0; i < report.by_state.size(); ++i) {
    if (report.by_state.at(i) > 0) {
      text += " " + std::string(avoidance::to_string(static_cast<avoidance::MotionLimit>(i))) + " " +
              percent(report.by_state.at(i), report.answers) + ";";
    }
  }
  text.back() = '\n';
  for (std::size_t k = 0; k < report.cameras.size(); ++k) {
    text += "  " + names.cameras[k] + ": " + counts(report.cameras[k], "images") + "\n";
    text += "    age of its image        " + spread(monitor.image_age(k)) + "\n";
    text += "    receipt                 " + spread(monitor.receipt(k)) + "\n";
    text += "    preparation             " + spread(monitor.preparation(k)) + "\n";
  }
  if (report.joints.opened > 0) {
    text += "  joints: " + counts(report.joints, "states") + "\n";
  }
  for (std::size_t i = 0; i < report.passed_over.size() && i < outputs.size(); ++i) {
    text += "  " + outputs[i] + ": " + std::to_string(report.passed_over[i]) + " answers passed over\n";
  }
  if (report.recorded) {
    text += "  recording: " + recorded_text(*report.recorded) + "\n";
  }
  if (!stops.empty()) {
    text += "  the last stops:\n";
    for (const std::string& stop : stops) {
      text += "    " + stop + "\n";
    }
  }
  return text;
}

}  // namespace depthgrid::program
