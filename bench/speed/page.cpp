#include "page.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "depthgrid/core/error.hpp"
#include "goals.hpp"
#include "markdown.hpp"

namespace depthgrid::bench {
namespace {

constexpr const char* kIntroduction = R"(# Benchmark

Made by `./scripts/benchmark` from one run; all numbers: [docs/benchmark.json](docs/benchmark.json). The grid evaluators
alone: [docs/benchmark.md](docs/benchmark.md).

)";

constexpr const char* kMethod = R"(## How it was measured

- Workload W: a room of 6.6 x 6.6 m with a table, five boxes, an arm of 7 capsules and two people of 17 capsules each, all
  moving; up to eight cameras of 640 x 480 pixels around it at 30 Hz, nine control points along the arm at 480 Hz, rho =
  0.4 m. The space of interest is a box of 3 x 3 x 2 m. The noisy variant has axial noise of 0.5 mm + 1.5 mm/m² z² (10 mm
  at 2.5 m), quantisation of 11 mm at 2 m, one invalid pixel in a hundred and robot intervals padded by 10 cm; there ours
  runs with margins that cover the noise (three standard deviations and half a step) and a calibration error of 5 mm and
  1 mrad, on W with an ideal sensor and a lateral reach of one pixel.
- Everybody gets the same frames. Pixels that show the robot are left out of clouds, and looked through up to the robot's
  exit where shadows count. Points lie in the robot, so where something hides the robot, its volume behind counts as
  occluded for all but ours and the oracle, which know that it is the robot.
- Prepare: from the 16-bit images to ready to answer. Nine: one call with nine points. Cycle: prepare, then the first nine
  points. Times are CPU time of the one thread that is used; peers run single-threaded.
- Ours runs a whole cycle after every frame set of every peer, so each ratio has both its times from the same seconds.
- Too far and too near: against a reference that proves an interval of the distance to space that no camera has seen free
  (ideal sensor, clean images, errors below its interval count as none), cut off at rho. Too far is the dangerous side.
- Memory: growth of the process's peak while the peer was made and answered its first frame set; below 2 MB it is noise.
- Nothing near, nothing within rho: nine points in free space. Deep: nine points at least 0.1 m deep in space that no camera
  sees free. Both are chosen in the clean images, the noisy variant's too: there holes put obstacles near the former.
- Peers that need over a second for a frame set ran on three of them; a row stops after its share of the time.
)";

constexpr const char* kSetups = R"(## How the peers are set up

All from Debian 12 packages, built like this project for any x86-64; scans choose AVX2 or AVX-512 at run time as ours does.

- nanoflann: single-index tree, leaves of 10 points (its default) or 32, search bounded by rho. The tree is built anew for
  every frame set. Arm box: only points within rho of the box that contains all control points.
- PCL: `KdTreeFLANN`, `VoxelGrid` before it where it says so.
- OctoMap: `computeDiscreteUpdate` (one ray a voxel) with lazy evaluation, rays of at most 4 m, no bounding box: with
  one, OctoMap carves nothing along rays that end outside. Rays to the robot carve up to its exit. With unknown space free
  the map is kept between frame sets, as OctoMap is meant, and lags behind people; with unknown space occupied every frame
  set gets an empty map. dynamicEDT3D covers the arm's box, answers by voxel, and follows the changes of a kept map.
- FCL: distance of a sphere of 1 mm to the occupied voxels of the same octree.
- Scan of the cloud: every point, with vector instructions. Scan of the window: every pixel that may lie within rho, a
  pixel's ray counts from its depth on. The maximum over the cameras counts what lies outside an image too, without which it
  would be no bound.
- Lattice: points around the control point in order of distance, each tested against every camera; about 30 lines.
- `letter` and `corrected`: this project's grid evaluators with cells of 1 cm; their space of interest is the first camera's
  view.
)";

std::string milliseconds(double value_s) { return digits3(1e3 * value_s); }
std::string microseconds(double value_s) { return digits3(1e6 * value_s); }
std::string millimetres1(double value_m) {
  const double value = std::round(1e4 * value_m) / 10;
  return std::isnan(value) ? "-" : value >= 10 ? whole(value) : digits3(value).substr(0, 3);
}
std::string yes_no(double value) { return value != 0 ? "yes" : "no"; }
std::string cameras_text(double cameras) { return whole(cameras); }

void write_goals(std::ostringstream& page, const std::vector<Goal>& all) {
  page << "## Goals\n\n";
  MarkdownTable table({"goal", "bound", "workload W", "", "moving and noisy, with margins", ""});
  const auto verdict = [](const Goal& goal, double value) {
    return std::isnan(value) ? std::string() : std::string(goal.met(value) ? "met" : "**MISSED**");
  };
  for (const Goal& goal : all) {
    table.row({goal.what, goal.bound_text, digits3(goal.clean), verdict(goal, goal.clean), digits3(goal.noisy),
               verdict(goal, goal.noisy)});
  }
  page << table.text() << '\n';
}

/// Where the time of what was missed goes, as far as counts tell.
void write_misses(std::ostringstream& page, const std::vector<Goal>& all, const Report& report) {
  const auto missed = std::count_if(all.begin(), all.end(), [](const Goal& goal) {
    return (!std::isnan(goal.clean) && !goal.met(goal.clean)) || (!std::isnan(goal.noisy) && !goal.met(goal.noisy));
  });
  page << "### What is slower than it should be, and where the time goes\n\n";
  if (missed == 0) {
    page << "Every goal is met on both workloads.\n\n";
    return;
  }
  page << missed << " of " << all.size()
       << " rows are missed on at least one workload. What one call does, in cubes of the octree that it opens and "
          "exact "
          "tests of a ball against one camera:\n\n";
  MarkdownTable table({"question", "workload", "cameras", "µs (mean)", "cubes", "ball tests", "ns a cube"});
  for (const char* workload : {"W", "noisy"}) {
    for (const Record* row : report.group(std::string("ours, ") + workload)) {
      const double nodes = (*row)["nodes_mean"];
      const double cameras = (*row)["cameras"];
      if (std::isfinite(nodes) && (cameras == 2 || cameras == 8)) {
        table.row({row->name, workload, cameras_text(cameras), microseconds((*row)["call_mean_s"]), whole(nodes),
                   whole((*row)["ball_tests_mean"]), digits3(1e9 * (*row)["call_mean_s"] / nodes)});
      }
    }
  }
  page << table.text() << '\n';
}

void write_ours(std::ostringstream& page, const Report& report) {
  page
      << "## Ours\n\nTimes in ms a call; all frame sets of the moving scene, new points for every call, the first call "
         "after each frame set included. Resolution 5 mm.\n\n";
  for (const char* workload : {"W", "noisy"}) {
    const auto rows = report.group(std::string("ours, ") + workload);
    page << (workload[0] == 'W' ? "Workload W, ideal sensor:" : "Moving and noisy, with margins:") << "\n\n";
    MarkdownTable table(
        {"question", "cameras", "a second", "median", "99 %", "99.9 %", "largest", "first after a frame set", "calls"});
    for (const Record* row : rows) {
      const Record& r = *row;
      if (r.name != "errors" && !std::isnan(r["call_mean_s"])) {
        table.row({r.name, cameras_text(r["cameras"]), digits3(1 / r["call_mean_s"]), milliseconds(r["call_median_s"]),
                   milliseconds(r["call_p99_s"]), milliseconds(r["call_p999_s"]), milliseconds(r["call_max_s"]),
                   milliseconds(r["first_median_s"]), whole(r["call_count"])});
      }
    }
    page << table.text() << '\n';
  }
  page << "Errors against the oracle that knows the same margins, in mm (too near: the price of the resolution and of "
          "seams "
          "between the cameras' views):\n\n";
  MarkdownTable errors({"workload", "cameras", "answers", "too far: largest", "too near: median", "95 %", "99 %",
                        "largest", "nearest is a measured surface"});
  for (const char* workload : {"W", "noisy"}) {
    for (const Record* row : report.group(std::string("ours, ") + workload)) {
      const Record& r = *row;
      if (r.name == "errors") {
        errors.row({workload, cameras_text(r["cameras"]), whole(r["over_count"]), digits3(1e3 * r["over_max_m"]),
                    millimetres1(r["under_median_m"]), millimetres1(r["under_p95_m"]), millimetres1(r["under_p99_m"]),
                    millimetres1(r["under_max_m"]), whole(100 * r["measured_share"]) + " %"});
      }
    }
  }
  page << errors.text() << '\n';

  page << "Beside `letter`, in turns on the same points, ms for nine points (median):\n\n";
  MarkdownTable letter({"cameras", "search", "search, hybrid", "letter, hybrid", "letter, minimum",
                        "letter, hybrid / search, hybrid", "letter, minimum / search"});
  for (const double cameras : {1.0, 2.0, 4.0, 8.0}) {
    const auto time_s = [&](const char* name) {
      return report.number("call_median_s", "beside the letter", name, {{"cameras", cameras}});
    };
    if (!std::isnan(time_s("search"))) {
      letter.row({cameras_text(cameras), milliseconds(time_s("search")), milliseconds(time_s("search, hybrid")),
                  milliseconds(time_s("letter, hybrid")), milliseconds(time_s("letter, minimum")),
                  digits3(time_s("letter, hybrid") / time_s("search, hybrid")),
                  digits3(time_s("letter, minimum") / time_s("search"))});
    }
  }
  page << letter.text() << '\n';

  page << "Frames that no scene gives, nine points, ms:\n\n";
  MarkdownTable adversarial({"case", "cameras", "budget", "median", "largest", "answers that the budget stopped"});
  for (const Record* row : report.group("adversarial")) {
    const Record& r = *row;
    adversarial.row({r.name, cameras_text(r["cameras"]), r["budget_s"] > 0 ? milliseconds(r["budget_s"]) : "none",
                     milliseconds(r["call_median_s"]), milliseconds(r["call_max_s"]),
                     r["budget_s"] > 0 ? whole(100 * r["stopped_share"]) + " %" : "-"});
  }
  page << adversarial.text() << '\n';
}

std::string errors_text(const Record& r, const std::string& side) {
  return millimetres1(r[side + "_median_m"]) + " / " + millimetres1(r[side + "_p95_m"]) + " / " +
         millimetres1(r[side + "_max_m"]);
}

void write_side_by_side(std::ostringstream& page, const Report& report, const std::string& group, double cameras,
                        const std::string& title) {
  MarkdownTable table({"", "prepare ms: median / max", "nine µs: median / max", "100 points µs", "nothing near µs",
                       "deep µs", "cycle ms", "cycle in ours", "MB", "occluded counts", "carved by others",
                       "too far mm: median / 95 % / max", "too near mm: the same"});
  bool any = false;
  for (const Record* row : report.group(group)) {
    const Record& r = *row;
    if (r["cameras"] != cameras) {
      continue;
    }
    any = true;
    table.row({r.name, milliseconds(r["prepare_median_s"]) + " / " + milliseconds(r["prepare_max_s"]),
               microseconds(r["nine_median_s"]) + " / " + microseconds(r["nine_max_s"]),
               microseconds(r["hundred_median_s"]), microseconds(r["far_median_s"]), microseconds(r["deep_median_s"]),
               milliseconds(r["cycle_median_s"]), digits3(r["cycle_median_s"] / r["our_cycle_median_s"]),
               digits3(r["memory_bytes"] / 1e6), yes_no(r["counts_occluded"]), yes_no(r["carves"]),
               errors_text(r, "over"), errors_text(r, "under")});
  }
  if (any) {
    page << "### " << title << "\n\n" << table.text() << '\n';
  }
}

/// Everything that is quicker than ours, and what it does not do for it.
void write_quicker(std::ostringstream& page, const Report& report) {
  std::ostringstream list;
  for (const Record* row : report.group("side by side")) {
    const Record& r = *row;
    if (r["cameras"] != 2 || r.name.rfind("search", 0) == 0) {
      continue;
    }
    const double cycle = r["cycle_median_s"] / r["our_cycle_median_s"];
    const double nine = r["nine_median_s"] / r["our_nine_median_s"];
    if (cycle < 1 || nine < 1) {
      list << "- " << r.name << ": " << (cycle < 1 ? "cycle" : "") << (cycle < 1 && nine < 1 ? " and " : "")
           << (nine < 1 ? "query" : "") << " (" << digits3(cycle) << " and " << digits3(nine) << " of ours). Up to "
           << millimetres1(r["over_max_m"]) << " mm too far and " << millimetres1(r["under_max_m"]) << " mm too near";
      if (r["counts_occluded"] == 0) {
        list << "; occluded space does not count";
      } else if (r["carves"] == 0) {
        list << "; no camera frees what another cannot see";
      }
      const double far = r["far_median_s"] / r["nine_median_s"];
      if (far > 2) {
        list << "; with nothing near its query takes " << digits3(far) << " times as long";
      }
      list << ".\n";
    }
  }
  page << "### What is quicker than ours, and at what price\n\nTwo cameras; cycle, and query of nine points alone:\n\n"
       << (list.str().empty() ? "Nothing.\n" : list.str()) << '\n';
}

}  // namespace

void write_page(const std::string& file, const std::string& images, const Report& report) {
  std::ostringstream page;
  page << kIntroduction;
  for (const char* key : {"machine", "run"}) {
    const auto found = report.about.find(key);
    if (found != report.about.end()) {
      page << found->second << "\n\n";
    }
  }
  const std::vector<Goal> all = goals(report);
  write_goals(page, all);
  write_misses(page, all, report);
  write_ours(page, report);
  page << "## Side by side\n\n`search` is ours with a lateral reach of one pixel, its default; `search, w = 0` "
          "without, as all "
          "others, and the reference.\n\n";
  write_side_by_side(page, report, "side by side", 2, "Two cameras");
  write_quicker(page, report);
  write_side_by_side(page, report, "side by side, noise", 2,
                     "Two cameras, moving and noisy; errors against the clean images");
  for (const auto& [cameras, title] : {std::pair{1.0, "One camera"}, {4.0, "Four cameras"}, {8.0, "Eight cameras"}}) {
    write_side_by_side(page, report, "side by side", cameras, title);
  }
  page << "## Plots\n\n";
  for (const auto& [name, text] : {std::pair{"cameras", "Time against the number of cameras"},
                                   {"accuracy", "Accuracy against time"},
                                   {"points", "Time against the number of points"},
                                   {"rho", "Time against rho"},
                                   {"resolution", "Time against the resolution"},
                                   {"image", "Time against the size of the images"}}) {
    page << "![" << text << "](" << images << "/benchmark-" << name << ".png)\n\n";
  }
  page << kMethod << '\n' << kSetups;
  std::ofstream out(file);
  out << page.str();
  out.close();
  if (!out) {
    fail(file, ": cannot be written");
  }
}

}  // namespace depthgrid::bench
