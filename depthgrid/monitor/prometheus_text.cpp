#include "depthgrid/monitor/prometheus_text.hpp"

#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/sensors/ros2_clock.hpp"

namespace depthgrid::monitor {
namespace {

/// One label; none where the name is empty.
struct Label {
  std::string_view name;
  std::string_view value;
};

class MetricText {
 public:
  void metric(std::string_view name, std::string_view type, std::string_view help) {
    name_ = "depthgrid_" + std::string(name);
    text_ += "# HELP " + name_ + " " + std::string(help) + "\n# TYPE " + name_ + " " + std::string(type) + "\n";
  }
  void value(double value, const Label& first = {}, const Label& second = {}, std::string_view suffix = {}) {
    text_ += name_;
    text_ += suffix;
    std::string labels;
    for (const Label& label : {first, second}) {
      if (!label.name.empty()) {
        labels += (labels.empty() ? "" : ",") + std::string(label.name) + "=\"" + escaped(label.value) + "\"";
      }
    }
    text_ += (labels.empty() ? "" : "{" + labels + "}") + " " + number(value) + "\n";
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  static std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
      if (c == '\\' || c == '"') {
        result += '\\';
      }
      result += c == '\n' ? ' ' : c;
    }
    return result;
  }
  static std::string number(double value) {
    if (std::isnan(value)) {
      return "NaN";
    }
    if (std::isinf(value)) {
      return value > 0 ? "+Inf" : "-Inf";
    }
    return number_text(value);
  }

  std::string name_;
  std::string text_;
};

double of(std::uint64_t count) { return static_cast<double>(count); }
double of(std::int64_t count) { return static_cast<double>(count); }

void add_times(MetricText& out, const TimeHistogram& times, const Label& label) {
  for (const auto& [quantile, words] :
       std::initializer_list<std::pair<double, std::string_view>>{{0.5, "0.5"}, {0.99, "0.99"}, {0.999, "0.999"}}) {
    out.value(times.quantile_s(quantile).value_or(std::nan("")), label, {"quantile", words});
  }
  out.value(of(times.count()), label, {}, "_count");
}

void add_answer(MetricText& out, const CellAnswer& answer) {
  out.metric("answer_time_seconds", "gauge", "Of the newest answer, since 1970: one that does not grow is over.");
  out.value(answer.sequence > 0 ? messages::seconds(sensors::stamp_of(answer.time_s)) : std::nan(""));
  out.metric("stop", "gauge", "1: the newest answer says stop, or there is none.");
  out.value(answer.stop ? 1 : 0);
  out.metric("distance_metres", "gauge", "The least distance of the newest answer.");
  out.value(answer.distance_m);
  out.metric("clear_metres", "gauge", "The same less the blind layer.");
  out.value(answer.clear_m);
  out.metric("blind_layer_metres", "gauge", "The thickest blind layer.");
  out.value(answer.blind_m);
  out.metric("joint_state_age_seconds", "gauge", "Of the newest joint state.");
  out.value(answer.joints_age_s);
}

void add_cameras(MetricText& out, const MonitorReport& report, const CellAnswer& answer, const Names& names) {
  out.metric("image_age_seconds", "gauge", "Of the newest image of each camera.");
  for (std::size_t k = 0; k < answer.camera_count; ++k) {
    out.value(answer.cameras.at(k).age_s, {"camera", names.cameras.at(k)});
  }
  out.metric("without_reading_ratio", "gauge", "Share of that image's pixels without a reading.");
  for (std::size_t k = 0; k < answer.camera_count; ++k) {
    out.value(answer.cameras.at(k).without_reading, {"camera", names.cameras.at(k)});
  }
  out.metric("camera_live", "gauge", "1: the camera's newest image is used.");
  for (std::size_t k = 0; k < answer.camera_count; ++k) {
    const CameraBasis& camera = answer.cameras.at(k);
    out.value(camera.state == CameraState::live && !camera.late ? 1 : 0, {"camera", names.cameras.at(k)});
  }
  out.metric("images_total", "counter", "Images of each camera, by what became of them.");
  for (std::size_t k = 0; k < report.cameras.size(); ++k) {
    const SourceCounts& counts = report.cameras[k];
    const Label camera{"camera", names.cameras.at(k)};
    out.value(of(counts.taken), camera, {"result", "taken"});
    out.value(of(counts.skipped), camera, {"result", "passed_over"});
    out.value(of(counts.refused), camera, {"result", "refused"});
    out.value(of(counts.dropped), camera, {"result", "dropped"});
  }
  out.metric("camera_failures_total", "counter", "How often a camera was lost or could not be opened.");
  for (std::size_t k = 0; k < report.cameras.size(); ++k) {
    out.value(of(report.cameras[k].failures), {"camera", names.cameras.at(k)});
  }
}

}  // namespace

std::string prometheus_text(const Monitor& monitor, const CellAnswer& newest, bool has_ended) {
  CellAnswer answer = newest;
  if (has_ended) {
    answer.stop = true;
    answer.distance_m = answer.clear_m = std::nan("");
    for (CameraBasis& camera : answer.cameras) {
      camera.state = CameraState::ended;
    }
  }
  const MonitorReport report = monitor.report();
  const Names& names = monitor.names();
  MetricText out;
  out.metric("answers_total", "counter", "Answers by their state.");
  for (std::size_t i = 0; i < report.by_state.size(); ++i) {
    out.value(of(report.by_state.at(i)), {"state", avoidance::to_string(static_cast<avoidance::MotionLimit>(i))});
  }
  out.metric("answers_stop_total", "counter", "Answers that say stop.");
  out.value(of(report.stopped));
  out.metric("stops_total", "counter", "How often answers began to say stop.");
  out.value(of(report.stops));
  out.metric("late_questions_total", "counter", "Questions that began more than a period late.");
  out.value(of(report.late_questions));
  add_answer(out, answer);
  add_cameras(out, report, answer, names);
  out.metric("joint_states_total", "counter", "Joint states by what became of them.");
  out.value(of(report.joints.taken), {"result", "taken"});
  out.value(of(report.joints.refused), {"result", "refused"});
  out.metric("exposure_to_answer_seconds", "summary",
             "From the newest exposure to the first answer that stands on it.");
  add_times(out, monitor.exposure_to_answer(), {});
  out.metric("question_seconds", "summary", "What one question takes.");
  add_times(out, monitor.asking(), {});
  out.metric("preparation_seconds", "summary", "From an image at hand to the image that can be asked.");
  for (std::size_t k = 0; k < names.cameras.size(); ++k) {
    add_times(out, monitor.preparation(k), {"camera", names.cameras[k]});
  }
  if (report.recorded) {
    out.metric("recording_dropped_total", "counter", "What was not recorded.");
    out.value(of(report.recorded->dropped_images), {"what", "images"});
    out.value(of(report.recorded->dropped_joint_states), {"what", "joint_states"});
    out.value(of(report.recorded->dropped_answers), {"what", "answers"});
  }
  return out.text();
}

}  // namespace depthgrid::monitor
