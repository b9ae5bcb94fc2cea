#include "lab/speed/plots.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <vector>

#include "report/plot.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kWidth = 980;
constexpr double kHeight = 520;
/// Stands for "none" on a logarithmic axis of errors, millimetres.
constexpr double kNoError = 0.1;

void save(const std::string& folder, const std::string& name, const std::vector<report::Plot>& panels) {
  report::Canvas canvas(static_cast<int>(kWidth), static_cast<int>(kHeight * static_cast<double>(panels.size())));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    report::draw_plot(canvas, {0, kHeight * static_cast<double>(i), kWidth, kHeight}, panels[i]);
  }
  canvas.save_png(folder + "/benchmark-" + name + ".png");
}

/// One series a peer of the group, at most eight so that colours differ, x and y taken from each of its rows.
template <class Select, class X, class Y>
std::vector<report::Series> series(const Report& report, const std::string& group, Select select, X x, Y y) {
  std::vector<report::Series> result;
  for (const Record* row : report.group(group)) {
    const std::string label = select(*row);
    if (label.empty()) {
      continue;
    }
    auto found =
        std::find_if(result.begin(), result.end(), [&label](const report::Series& s) { return s.label == label; });
    if (found == result.end()) {
      result.push_back({label, {}, {}, true});
      found = result.end() - 1;
    }
    found->x.push_back(x(*row));
    found->y.push_back(y(*row));
  }
  return result;
}

auto column(const char* key, double scale) {
  return [key, scale](const Record& row) { return scale * row[key]; };
}

std::string own_name(const Record& row) { return row.name; }

/// The name if it is one of these, else empty.
auto among(std::vector<std::string> names) {
  return [names = std::move(names)](const Record& row) {
    return std::find(names.begin(), names.end(), row.name) != names.end() ? row.name : std::string();
  };
}

void draw_cameras(const std::string& folder, const Report& report) {
  const auto cycle =
      among({"search", "letter, minimum", "lattice 20 mm", "maximum of the cameras' scans", "nanoflann, cell",
             "nanoflann, arm box", "PCL VoxelGrid 1 cm + KdTreeFLANN", "OctoMap 5 cm + EDT"});
  const auto query = among({"search", "letter, hybrid", "letter, minimum", "corrected, minimum", "lattice 20 mm",
                            "maximum of the cameras' scans", "scan of the arm box's cloud", "nanoflann, cell"});
  save(folder, "cameras",
       {{"All new frames and nine points", "cameras", "ms (median)", true, true,
         series(report, "side by side, W", cycle, column("cameras", 1), column("cycle_median_s", 1e3))},
        {"Nine points alone", "cameras", "ms (median)", true, true,
         series(report, "side by side, W", query, column("cameras", 1), column("nine_median_s", 1e3))}});
}

void draw_sweeps(const std::string& folder, const Report& report) {
  const auto query_ms = column("query_median_s", 1e3);
  const auto cycle_ms = [](const Record& row) { return 1e3 * (row["prepare_median_s"] + row["query_median_s"]); };
  save(folder, "points",
       {{"Points of one call, 2 cameras", "points", "ms (median)", true, true,
         series(report, "sweep: points", own_name, column("x", 1), query_ms)}});
  save(folder, "rho",
       {{"Nine points, 2 cameras", "rho (m)", "ms (median)", false, true,
         series(report, "sweep: rho", own_name, column("x", 1), query_ms)}});
  save(folder, "resolution",
       {{"Nine points, 2 cameras", "resolution or pitch (mm)", "ms (median)", true, true,
         series(report, "sweep: resolution", own_name, column("x", 1e3), query_ms)}});
  save(folder, "image",
       {{"All new frames and nine points, 2 cameras", "million pixels an image", "ms (median)", true, true,
         series(report, "sweep: image", own_name, column("x", 1e-6), cycle_ms)},
        {"Nine points alone, 2 cameras", "million pixels an image", "ms (median)", true, true,
         series(report, "sweep: image", own_name, column("x", 1e-6), query_ms)}});
}

void draw_accuracy(const std::string& folder, const Report& report) {
  const auto error_mm = [](const char* key) {
    return [key](const Record& row) { return std::max(kNoError, 1e3 * row[key]); };
  };
  const auto panel = [&](const char* title, const char* y_label, const char* key) {
    const auto family = [](const Record& row) {
      const auto found = row.texts.find("family");
      return row["cameras"] == 2 && found != row.texts.end() ? found->second : std::string();
    };
    report::Plot plot{title, "ms for all new frames and nine points (median)", y_label, true, true, {}};
    plot.series = series(report, "side by side, W", family, column("cycle_median_s", 1e3), error_mm(key));
    for (report::Series& s : plot.series) {
      s.joined = false;
    }
    return plot;
  };
  const auto sweep = [&](const char* title, const char* y_label, const char* key) {
    return report::Plot{
        title,   "ms for nine points (median)",
        y_label, true,
        true,    series(report, "sweep: resolution", own_name, column("query_median_s", 1e3), error_mm(key))};
  };
  save(folder, "accuracy",
       {panel("Too far, 2 cameras (0.1 mm: none)", "95th percentile (mm)", "over_p95_m"),
        panel("Too near, 2 cameras (0.1 mm: none)", "95th percentile (mm)", "under_p95_m"),
        sweep("Too far, by resolution or pitch (0.1 mm: none)", "largest (mm)", "over_max_m"),
        sweep("Too near, by resolution or pitch (0.1 mm: none)", "median (mm)", "under_median_m")});
}

}  // namespace

void draw_plots(const std::string& folder, const Report& report) {
  std::filesystem::create_directories(folder);
  draw_cameras(folder, report);
  draw_sweeps(folder, report);
  draw_accuracy(folder, report);
}

}  // namespace depthgrid::lab
