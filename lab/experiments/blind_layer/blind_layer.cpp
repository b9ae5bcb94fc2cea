#include "lab/experiments/blind_layer/blind_layer.hpp"

#include <algorithm>
#include <array>

#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/blind_layer/hand_beside.hpp"
#include "lab/experiments/blind_layer/layer_picture.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/stage/rig_width.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"

namespace depthgrid::experiments {

namespace {

constexpr std::array kPaddings_m{0.0, 0.05, 0.10, 0.158, 0.35};
constexpr std::array kGaps_m{0.02, 0.05, 0.10, 0.20};
constexpr int kSeen = 15;  ///< images at 30 Hz before a memory is asked

std::vector<std::string> sensors_of(const Options& options) {
  if (!options.sensor) {
    return {"ideal", "kinect_v1"};
  }
  const std::string sensor(sensor_or(options, "ideal"));
  return {sensor, sensor + std::string(kDeclared)};
}

Rig rig_of(const Options& options, std::string_view sensor) {
  return with_width(simulation::letter_arrangement(sensor).rig, width_or(options, 640, 320));
}

LayerReading reading(HandBeside& scene, const std::string& sensor, double padding_m, std::optional<double> gap_m,
                     int frames) {
  std::vector<Answer> answers;
  if (sensor.ends_with(kDeclared)) {
    RememberedScene remembered(scene, padding_m);
    remembered.see(HandPlace::beside, gap_m, kSeen);
    for (int frame = 0; frame < frames; ++frame) {
      remembered.see(HandPlace::beside, gap_m, 1);
      answers.push_back(remembered.distance(scene.link_world()));
    }
  }
  for (int frame = 0; frame < frames && !sensor.ends_with(kDeclared); ++frame) {
    scene.take(HandPlace::beside, gap_m, static_cast<std::uint64_t>(frame));
    answers.push_back(removed_answer(scene, padding_m));
  }
  std::sort(answers.begin(), answers.end(),
            [](const Answer& a, const Answer& b) { return a.nearest.distance_m < b.nearest.distance_m; });
  const Answer& middle = answers[answers.size() / 2];
  return {sensor,
          padding_m,
          gap_m,
          middle.nearest.distance_m,
          std::string(to_string(middle.nearest.state)),
          middle.blind_m,
          std::max(0.0, middle.nearest.distance_m - middle.blind_m)};
}

std::string gap_text(const std::optional<double>& gap_m) { return gap_m ? report::fixed(*gap_m, 2) : "no hand"; }

/// The readings of one sensor: a row a gap, a column a padding.
std::string table(const std::vector<LayerReading>& readings, const std::string& sensor) {
  std::vector<std::string> head{"hand, really"};
  std::vector<std::string> layer{"blind_m"};
  for (const double padding_m : kPaddings_m) {
    head.push_back("padding " + report::fixed(padding_m, 3));
  }
  report::MarkdownTable rows(head);
  std::vector<std::optional<double>> gaps(kGaps_m.begin(), kGaps_m.end());
  gaps.emplace_back();
  for (const std::optional<double>& gap_m : gaps) {
    std::vector<std::string> cells{gap_text(gap_m)};
    for (const LayerReading& r : readings) {
      if (r.sensor == sensor && r.gap_m == gap_m) {
        cells.push_back(report::fixed(r.distance_m, 3));
        if (!gap_m) {
          layer.push_back(report::fixed(r.blind_m, 3));
        }
      }
    }
    rows.row(cells);
  }
  rows.row(layer);
  return rows.text();
}

}  // namespace

std::vector<LayerReading> measure_blind_layer(const Options& options, ExperimentReport* pictures) {
  std::vector<LayerReading> readings;
  const std::vector<std::string> sensors = sensors_of(options);
  const std::size_t total = sensors.size() * (kGaps_m.size() + 1) * kPaddings_m.size();
  for (const std::string& sensor : sensors) {
    const std::string_view model = std::string_view(sensor).substr(0, sensor.find(kDeclared));
    HandBeside scene(rig_of(options, model), options.seed);
    const int frames = model == "ideal" ? 1 : frames_or(options, 9, 3);
    std::vector<std::optional<double>> gaps(kGaps_m.begin(), kGaps_m.end());
    gaps.emplace_back();
    for (const std::optional<double>& gap_m : gaps) {
      for (const double padding_m : kPaddings_m) {
        readings.push_back(reading(scene, sensor, padding_m, gap_m, frames));
        options.progress(readings.size(), total);
      }
    }
  }
  if (pictures != nullptr) {
    HandBeside scene(rig_of(options, "ideal"), options.seed);
    pictures->picture(
        "blind-layer.png", draw_blind_layer(scene, options.quick ? 90 : 220),
        "A section through the last link, seen from beside both cameras, which look from the left and the "
        "right. White: known free; gray: not. Blue: the blind layer, blind_m thick. Red: the hand as it "
        "really is, and the distance that is answered for the link.");
  }
  return readings;
}

void run_blind_layer(const Options& options, ExperimentReport& report) {
  report.paragraph(
      "The LWR stands in full view of the letter's two cameras, which face each other. A ball of 5 cm radius stands "
      "beside its last link, where nothing hides it from either. The arm is removed with a padding, and the search is "
      "asked for the link's distance: D in metres.");
  const std::vector<LayerReading> readings = measure_blind_layer(options, &report);
  double worst_m = 0;
  double outside_m = -1;
  for (const LayerReading& r : readings) {
    auto& json = report.figures()[r.sensor]["padding " + report::fixed(r.padding_m, 3)][gap_text(r.gap_m)];
    json["distance_m"] = r.distance_m;
    json["state"] = r.state;
    json["blind_m"] = r.blind_m;
    json["clear_m"] = r.clear_m;
    if (r.gap_m) {
      worst_m = std::max(worst_m, r.distance_m - *r.gap_m);
      outside_m = *r.gap_m > r.blind_m ? std::max(outside_m, r.distance_m - *r.gap_m) : outside_m;
    }
  }
  report.headline("A hand within the layer reads up to " + report::fixed(worst_m, 3) +
                  " m too far; one outside of it never more than " + report::fixed(outside_m, 3) + " m.");
  for (const std::string& sensor : sensors_of(options)) {
    report.paragraph(sensor + ":");
    report.paragraph(table(readings, sensor));
  }
}

}  // namespace depthgrid::experiments
