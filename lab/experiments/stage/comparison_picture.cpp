#include "lab/experiments/stage/comparison_picture.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "lab/experiments/stage/deviation.hpp"
#include "report/answers_picture.hpp"
#include "report/depth_picture.hpp"
#include "report/statistics.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kTile = 400;  ///< width of an image in the picture
constexpr double kTileGap = 10;
constexpr double kTileTitle = 24;
constexpr double kLegend = 44;
constexpr double kPlot = 300;
constexpr std::size_t kColumns = 3;
constexpr report::DepthRange kRange{0.5, 5.3};

void draw_tile(report::Canvas& canvas, const report::Rectangle& area, const AnswerTile& tile) {
  canvas.text({area.x_px, area.y_px - 7}, tile.title, 14);
  report::draw_depth(canvas, area, *tile.depth_m, kRange);
  if (tile.answers == nullptr) {
    return;
  }
  std::vector<report::AnsweredPoint> points;
  for (std::size_t i = 0; i < tile.answers->size(); ++i) {
    points.push_back({tile.instant->points_world[i], (*tile.answers)[i]});
  }
  report::draw_answers(canvas, *tile.camera, area, points, DistanceMethod::kRho);
}

}  // namespace

AnswerTile answer_tile(std::string title, const CameraImages& images, std::size_t camera, const Instant& instant,
                       std::size_t candidate) {
  return {std::move(title), &images.rig().cameras[camera], &images.depth_m(camera), &instant,
          &instant.answers[candidate]};
}

report::Canvas draw_comparison(const std::vector<AnswerTile>& tiles, const std::vector<report::Plot>& plots) {
  const std::size_t columns = std::min(kColumns, tiles.size());
  const std::size_t rows = (tiles.size() + columns - 1) / columns;
  const double tile_height = 0.75 * kTile + kTileTitle + kTileGap;
  const double width = kTileGap + static_cast<double>(columns) * (kTile + kTileGap);
  const double plots_begin = static_cast<double>(rows) * tile_height + kLegend;
  report::Canvas canvas(static_cast<int>(width),
                        static_cast<int>(plots_begin + static_cast<double>(plots.size()) * kPlot + kTileGap));
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const std::size_t row = i / columns;
    const std::size_t column = i % columns;
    draw_tile(canvas,
              {kTileGap + static_cast<double>(column) * (kTile + kTileGap),
               static_cast<double>(row) * tile_height + kTileTitle, kTile, 0.75 * kTile},
              tiles[i]);
  }
  const double legend_y = static_cast<double>(rows) * tile_height;
  report::draw_depth_legend(canvas, {kTileGap, legend_y, 240, 10}, kRange);
  if (std::any_of(tiles.begin(), tiles.end(), [](const AnswerTile& tile) { return tile.answers != nullptr; })) {
    report::draw_distance_legend(canvas, {kTileGap + 300, legend_y, 240, 10}, DistanceMethod::kRho);
  }
  for (std::size_t i = 0; i < plots.size(); ++i) {
    draw_plot(canvas, {kTileGap, plots_begin + static_cast<double>(i) * kPlot, width - 2 * kTileGap, kPlot}, plots[i]);
  }
  return canvas;
}

report::Series smallest_answers(const std::vector<Instant>& instants, std::size_t candidate, std::string label) {
  report::Series series{std::move(label), {}, {}, false, true};
  for (const Instant& instant : instants) {
    double smallest_m = std::numeric_limits<double>::infinity();
    for (const Proximity& answer : instant.answers[candidate]) {
      if (has_distance(answer)) {
        smallest_m = std::min(smallest_m, answer.distance_m);
      }
    }
    series.x.push_back(instant.time_s);
    series.y.push_back(smallest_m);
  }
  return series;
}

report::Series smallest_truth(const std::vector<Instant>& instants, double rho_m) {
  report::Series series{"truth", {}, {}, false, true};
  for (const Instant& instant : instants) {
    double smallest_m = rho_m;
    for (const PointTruth::Nearest& truth : instant.truth) {
      smallest_m = std::min(smallest_m, truth.distance_m);
    }
    series.x.push_back(instant.time_s);
    series.y.push_back(smallest_m);
  }
  return series;
}

report::Series median_answers(const std::vector<Instant>& instants, std::size_t candidate, std::string label) {
  report::Series series{std::move(label), {}, {}, false, true};
  for (const Instant& instant : instants) {
    std::vector<double> distances_m;
    for (const Proximity& answer : instant.answers[candidate]) {
      if (has_distance(answer)) {
        distances_m.push_back(answer.distance_m);
      }
    }
    series.x.push_back(instant.time_s);
    series.y.push_back(report::quantile(std::move(distances_m), 0.5));
  }
  return series;
}

report::Series median_truth(const std::vector<Instant>& instants, double rho_m) {
  report::Series series{"truth", {}, {}, false, true};
  for (const Instant& instant : instants) {
    std::vector<double> distances_m;
    for (const PointTruth::Nearest& truth : instant.truth) {
      distances_m.push_back(std::min(truth.distance_m, rho_m));
    }
    series.x.push_back(instant.time_s);
    series.y.push_back(report::quantile(std::move(distances_m), 0.5));
  }
  return series;
}

report::Series point_answers(const std::vector<Instant>& instants, std::size_t candidate, std::size_t point,
                             std::string label) {
  report::Series series{std::move(label), {}, {}, false, true};
  for (const Instant& instant : instants) {
    series.x.push_back(instant.time_s);
    series.y.push_back(instant.answers[candidate][point].distance_m);
  }
  return series;
}

report::Series point_truth(const std::vector<Instant>& instants, std::size_t point, double rho_m) {
  report::Series series{"truth", {}, {}, false, true};
  for (const Instant& instant : instants) {
    series.x.push_back(instant.time_s);
    series.y.push_back(std::min(instant.truth[point].distance_m, rho_m));
  }
  return series;
}

}  // namespace depthgrid::experiments
