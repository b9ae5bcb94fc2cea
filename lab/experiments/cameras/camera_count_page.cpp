#include <algorithm>
#include <utility>

#include "lab/experiments/cameras/camera_count.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"
#include "report/plot.hpp"

namespace depthgrid::experiments {

namespace {

std::string milliseconds(double seconds) { return report::fixed(1000 * seconds, seconds < 0.01 ? 2 : 1); }

double time_ratio(const std::vector<CameraCount>& counts, std::size_t method, std::size_t index) {
  return counts[index].methods[method].evaluation_s / counts[1].methods[method].evaluation_s;
}

report::Canvas draw(const std::vector<CameraCount>& counts) {
  report::Plot time{"time of an evaluation of nine points, two cameras = 1", "cameras", "ratio", false, false, {}};
  report::Plot left{"what is left", "cameras", "share (%)", false, false, {}};
  report::Series linear{"proportional to the cameras", {}, {}, false, true};
  for (std::size_t method = 0; method < counts[0].methods.size(); ++method) {
    report::Series& series = time.series.emplace_back();
    series.label = counts[0].methods[method].label;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      series.x.push_back(counts[i].cameras);
      series.y.push_back(time_ratio(counts, method, i));
    }
  }
  report::Series gray{"gray area, workspace", {}, {}};
  report::Series near_arm{"gray area, within 0.4 m of the arm", {}, {}};
  report::Series pockets{"pockets at the robot (search)", {}, {}};
  report::Series false_obstacles{"false obstacles (search)", {}, {}};
  for (const CameraCount& count : counts) {
    const CountedMethod& search = count.methods[kCountedSearch];
    linear.x.push_back(count.cameras);
    linear.y.push_back(0.5 * count.cameras);
    for (report::Series* series : {&gray, &near_arm, &pockets, &false_obstacles}) {
      series->x.push_back(count.cameras);
    }
    gray.y.push_back(100 * count.gray.share());
    near_arm.y.push_back(100 * count.gray.share_near());
    pockets.y.push_back(100.0 * static_cast<double>(search.pockets) /
                        static_cast<double>(std::max<std::size_t>(1, search.far)));
    false_obstacles.y.push_back(100 * search.deviation.false_obstacles());
  }
  time.series.push_back(std::move(linear));
  left.series = {gray, near_arm, pockets, false_obstacles};
  report::Canvas canvas(880, 700);
  draw_plot(canvas, {10, 0, 860, 340}, time);
  draw_plot(canvas, {10, 350, 860, 340}, left);
  return canvas;
}

std::string time_table(const std::vector<CameraCount>& counts) {
  std::vector<std::string> head{"cameras"};
  for (const CountedMethod& method : counts[0].methods) {
    head.push_back(method.label + ", ms");
    head.emplace_back("to two cameras");
  }
  report::MarkdownTable table(head);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::vector<std::string> row{std::to_string(counts[i].cameras)};
    for (std::size_t method = 0; method < counts[0].methods.size(); ++method) {
      row.push_back(milliseconds(counts[i].methods[method].evaluation_s));
      row.push_back(report::fixed(time_ratio(counts, method, i), 2));
    }
    table.row(row);
  }
  return table.text();
}

std::string preparation_table(const std::vector<CameraCount>& counts) {
  std::vector<std::string> head{"cameras"};
  for (const CountedMethod& method : counts[0].methods) {
    head.push_back(method.label + ", ms");
  }
  report::MarkdownTable table(head);
  for (const CameraCount& count : counts) {
    std::vector<std::string> row{std::to_string(count.cameras)};
    for (const CountedMethod& method : count.methods) {
      row.push_back(milliseconds(method.update_s));
    }
    table.row(row);
  }
  return table.text();
}

std::string pockets_text(const CountedMethod& method) {
  return report::percent(static_cast<double>(method.pockets) /
                         static_cast<double>(std::max<std::size_t>(1, method.far)));
}

std::string left_table(const std::vector<CameraCount>& counts) {
  report::MarkdownTable table({"cameras", "gray, workspace", "gray, within 0.4 m of the arm", "pockets, letter",
                               "pockets, search", "> 100 mm too near, letter", "the same, search",
                               "> 10 mm too far, letter", "the same, search"});
  for (const CameraCount& count : counts) {
    const CountedMethod& search = count.methods[kCountedSearch];
    const CountedMethod& letter = count.methods[kCountedLetter];
    table.row({std::to_string(count.cameras), report::percent(count.gray.share()),
               report::percent(count.gray.share_near()), pockets_text(letter), pockets_text(search),
               report::percent(letter.deviation.false_obstacles()), report::percent(search.deviation.false_obstacles()),
               report::percent(letter.deviation.overestimates()), report::percent(search.deviation.overestimates())});
  }
  return table.text();
}

void report_growth(const std::vector<CameraCount>& counts, ExperimentReport& report) {
  const std::size_t last = counts.size() - 1;
  std::string growth = "From two to eight cameras the time of an evaluation grows";
  for (const std::size_t method : {kCountedHybrid, kCountedCorrected, kCountedSearch}) {
    growth += std::string(method == kCountedHybrid ? " " : ", ") + report::fixed(time_ratio(counts, method, last), 2) +
              " times (" + counts[last].methods[method].label + ", a straight line explains " +
              report::percent(linear_fit(counts, method).r_squared, 0) + " of its variance)";
  }
  report.headline(growth + ".");
  report.headline("Within 0.4 m of the arm the gray area falls from " + report::percent(counts[0].gray.share_near()) +
                  " with one camera to " + report::percent(counts[1].gray.share_near()) + " with two and " +
                  report::percent(counts[last].gray.share_near()) + " with eight.");
  std::string pockets;
  for (const CameraCount& count : counts) {
    pockets += (pockets.empty() ? "" : ", ") + pockets_text(count.methods[kCountedSearch]);
  }
  report.headline("Points of the robot that touch a pocket, with one, two, ... cameras: " + pockets + ".");
}

/// With what is declared and a memory, which has seen half a second before each instant.
std::string memory_table(const std::vector<CameraCount>& counts) {
  report::MarkdownTable table({"cameras", "> 100 mm too near, search", "the same with memory",
                               "> 10 mm too far, search", "with memory", "most, mm, with memory"});
  for (const CameraCount& count : counts) {
    const Deviation& search = count.methods[kCountedSearch].deviation;
    const Deviation& memory = count.methods[kCountedMemory].deviation;
    table.row({std::to_string(count.cameras), report::percent(search.false_obstacles()),
               report::percent(memory.false_obstacles()), report::percent(search.overestimates()),
               report::percent(memory.overestimates()), report::fixed(1000 * memory.largest_overestimate_m())});
  }
  return table.text();
}

void report_tables(const std::vector<CameraCount>& counts, ExperimentReport& report) {
  report.paragraph("Processor time of an evaluation of nine control points, new points every time:");
  report.paragraph(time_table(counts));
  report.paragraph(
      "With one camera the nearest obstacle is the robot's own shadow, so the scan ends early: straight lines are "
      "fitted from two cameras on.");
  report.paragraph("Processor time to prepare the images of one instant, all cameras:");
  report.paragraph(preparation_table(counts));
  report.paragraph(left_table(counts));
  if (counts.front().methods.size() > kCountedMemory) {
    report.paragraph(memory_table(counts));
  }
  report.paragraph(
      "*pockets*: points of the robot's surface (grown by the padding of its removal) that read less than 10 mm though "
      "nothing is within 100 mm. Instants at which the person is inside that padding are left out of the comparison: "
      "no method can see them there.");
}

void report_figures(const std::vector<CameraCount>& counts, ExperimentReport& report) {
  for (const CameraCount& count : counts) {
    auto& json = report.figures()["cameras"][std::to_string(count.cameras)];
    json["gray_share"] = count.gray.share();
    json["gray_share_near_arm"] = count.gray.share_near();
    for (const CountedMethod& method : count.methods) {
      auto& figures = json[method.label];
      figures["evaluation_s"] = method.evaluation_s;
      figures["update_s"] = method.update_s;
      if (method.far > 0) {
        figures["far_surface_points"] = method.far;
        figures["pockets"] = method.pockets;
      }
      figures["distances"] = method.deviation.json();
    }
  }
  for (std::size_t method = 0; method < counts[0].methods.size(); ++method) {
    const LinearFit fit = linear_fit(counts, method);
    report.figures()["linear_fit"][counts[0].methods[method].label] = {
        {"offset_s", fit.offset_s}, {"slope_s_per_camera", fit.slope_s}, {"r_squared", fit.r_squared}};
  }
}

}  // namespace

void run_camera_count(const Options& options, ExperimentReport& report) {
  report.paragraph(
      "One to eight cameras: the letter's first one; its two; from three on a circle around the robot. A person "
      "reaches for the moving arm, sensor: " +
      std::string(sensor_or(options, "ideal")) +
      ", the space behind the robot counts as unknown. The letter states that its computations grow linearly with the "
      "number of cameras.");
  const std::vector<CameraCount> counts = measure_camera_counts(options);
  report_growth(counts, report);
  report.picture("cameras.png", draw(counts),
                 "Above: processor time, medians of one run. Below: space that no camera has seen free, points of the "
                 "robot that read contact though nothing is within 0.1 m, control points whose answer is more than 100 "
                 "mm too near.");
  report_tables(counts, report);
  report_figures(counts, report);
}

}  // namespace depthgrid::experiments
