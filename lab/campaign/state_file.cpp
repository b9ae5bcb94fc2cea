#include "lab/campaign/state_file.hpp"

#include <rapidjson/document.h>
#include <rapidjson/istreamwrapper.h>
#include <rapidjson/ostreamwrapper.h>
#include <rapidjson/prettywriter.h>

#include <filesystem>
#include <fstream>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_target.hpp"

namespace depthgrid::lab {
namespace {

using Writer = rapidjson::PrettyWriter<rapidjson::OStreamWrapper>;
using rapidjson::Value;

void write_histograms(Writer& json, const std::map<std::string, LogHistogram>& histograms) {
  json.StartObject();
  for (const auto& [name, histogram] : histograms) {
    json.Key(name.c_str());
    json.StartObject();
    json.Key("maximum");
    json.Double(histogram.maximum());
    json.Key("bins");
    json.StartArray();
    for (const std::int64_t count : histogram.bins()) {
      json.Int64(count);
    }
    json.EndArray();
    json.EndObject();
  }
  json.EndObject();
}

std::map<std::string, LogHistogram> read_histograms(const Value& object) {
  std::map<std::string, LogHistogram> histograms;
  for (const auto& member : object.GetObject()) {
    std::array<std::int64_t, LogHistogram::kBins> bins{};
    const auto& counts = member.value["bins"];
    if (counts.Size() != bins.size()) {
      fail("a histogram of ", counts.Size(), " bins, expected ", bins.size());
    }
    for (rapidjson::SizeType i = 0; i < counts.Size(); ++i) {
      bins.at(i) = counts[i].GetInt64();
    }
    histograms[member.name.GetString()] = LogHistogram::from(bins, member.value["maximum"].GetDouble());
  }
  return histograms;
}

void write_counts(Writer& json, const std::map<std::string, std::int64_t>& counts) {
  json.StartObject();
  for (const auto& [name, count] : counts) {
    json.Key(name.c_str());
    json.Int64(count);
  }
  json.EndObject();
}

std::map<std::string, std::int64_t> read_counts(const Value& object) {
  std::map<std::string, std::int64_t> counts;
  for (const auto& member : object.GetObject()) {
    counts[member.name.GetString()] = member.value.GetInt64();
  }
  return counts;
}

void write_rows(Writer& json, const std::map<std::string, Row>& rows) {
  json.StartObject();
  for (const auto& [name, row] : rows) {
    std::map<std::string, std::int64_t> counts{{"problems", row.problems}, {"queries", row.queries}};
    for (std::size_t i = 0; i < row.faults.size(); ++i) {
      counts[to_string(static_cast<reference::Fault>(i))] = row.faults.at(i);
    }
    json.Key(name.c_str());
    write_counts(json, counts);
  }
  json.EndObject();
}

std::map<std::string, Row> read_rows(const Value& object) {
  std::map<std::string, Row> rows;
  for (const auto& member : object.GetObject()) {
    const std::map<std::string, std::int64_t> counts = read_counts(member.value);
    Row& row = rows[member.name.GetString()];
    row.problems = counts.at("problems");
    row.queries = counts.at("queries");
    for (std::size_t i = 0; i < row.faults.size(); ++i) {
      row.faults.at(i) = counts.at(to_string(static_cast<reference::Fault>(i)));
    }
  }
  return rows;
}

void write_tally(Writer& json, const Tally& tally) {
  json.StartObject();
  json.Key("width_px");
  json.Int(tally.width_px);
  json.Key("seconds");
  json.Double(tally.seconds);
  json.Key("seeds");
  json.StartArray();
  for (const auto& [first, end] : tally.seeds.ranges()) {
    json.StartArray();
    json.Uint64(first);
    json.Uint64(end);
    json.EndArray();
  }
  json.EndArray();
  json.Key("queries_by_code");
  write_counts(json, tally.queries_by_code);
  json.Key("rows");
  write_rows(json, tally.rows);
  json.Key("counts");
  write_counts(json, tally.counts);
  json.Key("lines");
  json.StartArray();
  for (const std::string& line : tally.lines) {
    json.String(line.c_str());
  }
  json.EndArray();
  json.Key("shortfall_m");
  write_histograms(json, tally.shortfall_m);
  json.Key("shortfall_resolutions");
  write_histograms(json, tally.shortfall_resolutions);
  json.EndObject();
}

Tally read_tally(const Value& object) {
  Tally tally;
  tally.width_px = object["width_px"].GetInt();
  tally.seconds = object["seconds"].GetDouble();
  for (const auto& range : object["seeds"].GetArray()) {
    tally.seeds.add(range[0].GetUint64(), range[1].GetUint64());
  }
  tally.queries_by_code = read_counts(object["queries_by_code"]);
  tally.rows = read_rows(object["rows"]);
  tally.counts = read_counts(object["counts"]);
  for (const auto& line : object["lines"].GetArray()) {
    tally.lines.emplace_back(line.GetString());
  }
  tally.shortfall_m = read_histograms(object["shortfall_m"]);
  tally.shortfall_resolutions = read_histograms(object["shortfall_resolutions"]);
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
  const std::filesystem::path target = replaceable_file(file);
  const std::filesystem::path temporary = target.string() + ".part";
  std::ofstream out(temporary);
  rapidjson::OStreamWrapper stream(out);
  Writer json(stream);
  json.SetIndent(' ', 1);
  json.SetFormatOptions(rapidjson::kFormatSingleLineArray);
  json.StartObject();
  json.Key("campaign");
  json.StartArray();
  for (const auto& [width_px, tally] : state.tallies) {
    write_tally(json, tally);
  }
  json.EndArray();
  json.EndObject();
  out << '\n';
  out.close();
  std::error_code error;
  if (out) {
    std::filesystem::rename(temporary, target, error);
  }
  if (!out || error) {
    fail(file, ": cannot be written; is there such a folder, and space in it?");
  }
}

CampaignState read_state(const std::string& file) {
  std::ifstream in(file);
  if (!in) {
    fail(file, ": cannot be read");
  }
  rapidjson::IStreamWrapper stream(in);
  rapidjson::Document json;
  json.ParseStream(stream);
  if (json.HasParseError() || !json.IsObject() || !json.HasMember("campaign")) {
    fail(file, ": is no state of the campaign; one is written by --state");
  }
  CampaignState state;
  for (const auto& object : json["campaign"].GetArray()) {
    Tally tally = read_tally(object);
    state.of_width(tally.width_px) = std::move(tally);
  }
  return state;
}

}  // namespace depthgrid::lab
