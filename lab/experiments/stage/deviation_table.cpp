#include "lab/experiments/stage/deviation_table.hpp"

#include "report/markdown_table.hpp"
#include "report/number_text.hpp"

namespace depthgrid::experiments {

std::string deviation_table(const std::vector<LabelledDeviation>& rows) {
  report::MarkdownTable table({"method", "answers", "more than 100 mm too near", "too near, median / 95 %, mm",
                               "more than 10 mm too far", "farthest, mm"});
  for (const auto& [label, deviation] : rows) {
    table.row(
        {label, std::to_string(deviation.compared()), report::percent(deviation.false_obstacles()),
         report::fixed(1000 * deviation.shortfall_m(0.5)) + " / " + report::fixed(1000 * deviation.shortfall_m(0.95)),
         report::percent(deviation.overestimates()), report::fixed(1000 * deviation.largest_overestimate_m())});
  }
  return table.text();
}

nlohmann::ordered_json deviation_figures(const std::vector<LabelledDeviation>& rows) {
  nlohmann::ordered_json json;
  for (const auto& [label, deviation] : rows) {
    json[label] = deviation.json();
  }
  return json;
}

}  // namespace depthgrid::experiments
