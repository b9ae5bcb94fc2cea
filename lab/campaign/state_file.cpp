#include "lab/campaign/state_file.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/text_file.hpp"
#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {
namespace {

constexpr const char* kWhat = "state of the campaign; one is written by --state";

/// Json's own items() take anything for an object.
const Json& object(const Json& json) {
  if (!json.is_object()) {
    fail("'", printable_excerpt(json.dump(-1, ' ', true)), "' must be an object");
  }
  return json;
}

const Json& list(const Json& json) {
  if (!json.is_array()) {
    fail("'", printable_excerpt(json.dump(-1, ' ', true)), "' must be a list");
  }
  return json;
}

Json to_json(const std::map<std::string, LogHistogram>& histograms) {
  Json json = Json::object();
  for (const auto& [name, histogram] : histograms) {
    json[name] = {{"maximum", histogram.maximum()}, {"bins", histogram.bins()}};
  }
  return json;
}

std::map<std::string, std::int64_t> counts_of(const Json& json) {
  std::map<std::string, std::int64_t> counts;
  for (const auto& [name, count] : object(json).items()) {
    counts[name] = count_of(count);
  }
  return counts;
}

std::map<std::string, LogHistogram> histograms_of(const Json& json) {
  std::map<std::string, LogHistogram> histograms;
  for (const auto& [name, entry] : object(json).items()) {
    const Json& numbers = entry.at("bins");
    std::array<std::int64_t, LogHistogram::kBins> bins{};
    if (!numbers.is_array() || numbers.size() != bins.size()) {
      fail("a histogram has ", numbers.size(), " bins, must have ", bins.size());
    }
    std::transform(numbers.begin(), numbers.end(), bins.begin(), count_of);
    histograms[name] = LogHistogram::from(bins, quantity_of(entry.at("maximum")));
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
  for (const auto& [name, entry] : object(json).items()) {
    each_count(rows[name], [&entry = entry](const auto& key, std::int64_t& count) { count = count_of(entry.at(key)); });
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

SeedRanges seeds_of(const Json& json) {
  SeedRanges seeds;
  for (const Json& range : list(json)) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t first = whole_number_of(range.at(0), kMost);
    const std::uint64_t end = whole_number_of(range.at(1), kMost);
    if (first >= end || range.size() != 2) {
      fail("seeds ", printable_excerpt(range.dump()), " must be the first and the one after the last");
    }
    seeds.add(first, end);
  }
  return seeds;
}

/// A state from which rows were lost would pass for one without faults.
void check_whole(const Tally& tally) {
  const std::uint64_t seeds = tally.seeds.count(0, std::numeric_limits<std::uint64_t>::max());
  const auto all = tally.rows.find("all");
  const auto problems = static_cast<std::uint64_t>(all != tally.rows.end() ? all->second.problems : 0);
  if (problems != seeds) {
    fail("the row \"all\" counts ", problems, " problems of ", seeds, " seeds, one a seed is needed");
  }
}

Tally tally_of(const Json& json) {
  Tally tally;
  tally.width_px = static_cast<int>(whole_number_of(json.at("width_px"), kLargestImageSide));
  tally.seconds = quantity_of(json.at("seconds"));
  tally.seeds = seeds_of(json.at("seeds"));
  tally.queries_by_code = counts_of(json.at("queries_by_code"));
  tally.rows = rows_of(json.at("rows"));
  tally.counts = counts_of(json.at("counts"));
  for (const Json& line : list(json.at("lines"))) {
    tally.lines.push_back(line.get<std::string>());
    if (tally.lines.back().find(", ") == std::string::npos || !is_printable(tally.lines.back())) {
      fail("line '", printable_excerpt(tally.lines.back()), "' must be of the form \"KIND, PROBLEM\"");
    }
  }
  tally.shortfall_m = histograms_of(json.at("shortfall_m"));
  tally.shortfall_resolutions = histograms_of(json.at("shortfall_resolutions"));
  check_whole(tally);
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

bool CampaignState::is_unsound() const {
  return std::any_of(tallies.begin(), tallies.end(), [](const auto& item) { return item.second.is_unsound(); });
}

std::string to_text(const CampaignState& state) {
  Json tallies = Json::array();
  for (const auto& [width_px, tally] : state.tallies) {
    tallies.push_back(to_json(tally));
  }
  return text_of({{"campaign", std::move(tallies)}});
}

CampaignState parse_state(std::string_view text, const std::string& name) {
  const Json all = parse_json(text, name, kWhat, {"campaign"});
  return taken_apart(name, kWhat, [&all] {
    CampaignState state;
    for (const Json& json : list(all["campaign"])) {
      Tally tally = tally_of(json);
      const int width_px = tally.width_px;
      if (!state.tallies.emplace(width_px, std::move(tally)).second) {
        fail("images of width ", width_px, " have two tallies, must have one");
      }
    }
    return state;
  });
}

void write_state(const std::string& file, const CampaignState& state) { files::write_text_file(file, to_text(state)); }

CampaignState read_state(const std::string& file) { return parse_state(files::read_text_file(file), file); }

}  // namespace depthgrid::lab
