#include "depthgrid/experiments/deviation_table.hpp"

#include "depthgrid/experiments/markdown_table.hpp"

namespace depthgrid::experiments {

std::string deviation_table(const std::vector<LabelledDeviation>& rows) {
  std::vector<std::vector<std::string>> cells;
  cells.reserve(rows.size());
  for (const auto& [label, deviation] : rows) {
    cells.push_back({label, std::to_string(deviation.compared()), percent(deviation.false_obstacles()),
                     fixed(1000 * deviation.shortfall_m(0.5)) + " / " + fixed(1000 * deviation.shortfall_m(0.95)),
                     percent(deviation.overestimates()), fixed(1000 * deviation.largest_overestimate_m())});
  }
  return markdown_table({"method", "answers", "more than 100 mm too near", "too near, median / 95 %, mm",
                         "more than 10 mm too far", "farthest, mm"},
                        cells);
}

nlohmann::ordered_json deviation_figures(const std::vector<LabelledDeviation>& rows) {
  nlohmann::ordered_json json;
  for (const auto& [label, deviation] : rows) {
    json[label] = deviation.json();
  }
  return json;
}

}  // namespace depthgrid::experiments
