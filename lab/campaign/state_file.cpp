#include "lab/campaign/state_file.hpp"

#include <utility>

#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {
namespace {

Json to_json(const std::map<std::string, LogHistogram>& histograms) {
  Json json = Json::object();
  for (const auto& [name, histogram] : histograms) {
    json[name] = {{"maximum", histogram.maximum()}, {"bins", histogram.bins()}};
  }
  return json;
}

std::map<std::string, LogHistogram> histograms_of(const Json& json) {
  std::map<std::string, LogHistogram> histograms;
  for (const auto& [name, entry] : json.items()) {
    histograms[name] = LogHistogram::from(entry.at("bins"), entry.at("maximum"));
  }
  return histograms;
}

/// The counts of a row with their keys: the same for writing and reading.
template <class AnyRow, class Visit>
void each_count(AnyRow& row, Visit visit) {
  visit("problems", row.problems);
  visit("queries", row.queries);
  for (std::size_t i = 0; i < row.faults.size(); ++i) {
    visit(to_string(static_cast<reference::Fault>(i)), row.faults.at(i));
  }
}

Json to_json(const std::map<std::string, Row>& rows) {
  Json json = Json::object();
  for (const auto& [name, row] : rows) {
    each_count(row, [&entry = json[name]](const auto& key, std::int64_t count) { entry[key] = count; });
  }
  return json;
}

std::map<std::string, Row> rows_of(const Json& json) {
  std::map<std::string, Row> rows;
  for (const auto& [name, entry] : json.items()) {
    each_count(rows[name], [&entry = entry](const auto& key, std::int64_t& count) { entry.at(key).get_to(count); });
  }
  return rows;
}

Json to_json(const Tally& tally) {
  return {{"width_px", tally.width_px},
          {"seconds", tally.seconds},
          {"seeds", std::vector<std::pair<std::uint64_t, std::uint64_t>>(tally.seeds.ranges().begin(),
                                                                         tally.seeds.ranges().end())},
          {"queries_by_code", tally.queries_by_code},
          {"rows", to_json(tally.rows)},
          {"counts", tally.counts},
          {"lines", tally.lines},
          {"shortfall_m", to_json(tally.shortfall_m)},
          {"shortfall_resolutions", to_json(tally.shortfall_resolutions)}};
}

Tally tally_of(const Json& json) {
  Tally tally;
  json.at("width_px").get_to(tally.width_px);
  json.at("seconds").get_to(tally.seconds);
  for (const Json& range : json.at("seeds")) {
    tally.seeds.add(range.at(0), range.at(1));
  }
  json.at("queries_by_code").get_to(tally.queries_by_code);
  tally.rows = rows_of(json.at("rows"));
  json.at("counts").get_to(tally.counts);
  json.at("lines").get_to(tally.lines);
  tally.shortfall_m = histograms_of(json.at("shortfall_m"));
  tally.shortfall_resolutions = histograms_of(json.at("shortfall_resolutions"));
  return tally;
}

}  // namespace

Tally& CampaignState::of_width(int width_px) {
  Tally& tally = tallies[width_px];
  tally.width_px = width_px;
  return tally;
}

void CampaignState::add(const CampaignState& other) {
  for (const auto& [width_px, tally] : other.tallies) {
    of_width(width_px).add(tally);
  }
}

void write_state(const std::string& file, const CampaignState& state) {
  Json tallies = Json::array();
  for (const auto& [width_px, tally] : state.tallies) {
    tallies.push_back(to_json(tally));
  }
  write_json_file(file, {{"campaign", std::move(tallies)}});
}

CampaignState read_state(const std::string& file) {
  const Json all = read_json_file(file, "state of the campaign; one is written by --state", {"campaign"});
  CampaignState state;
  for (const Json& json : all["campaign"]) {
    Tally tally = tally_of(json);
    state.of_width(tally.width_px) = std::move(tally);
  }
  return state;
}

}  // namespace depthgrid::lab
