#include "lab/speed/record.hpp"

#include <rapidjson/document.h>
#include <rapidjson/istreamwrapper.h>
#include <rapidjson/ostreamwrapper.h>
#include <rapidjson/prettywriter.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "depthgrid/core/error.hpp"

namespace depthgrid::lab {
namespace {

using Writer = rapidjson::PrettyWriter<rapidjson::OStreamWrapper>;

void write_texts(Writer& json, const std::map<std::string, std::string>& texts) {
  json.StartObject();
  for (const auto& [key, text] : texts) {
    json.Key(key.c_str());
    json.String(text.c_str());
  }
  json.EndObject();
}

std::map<std::string, std::string> read_texts(const rapidjson::Value& object) {
  std::map<std::string, std::string> texts;
  for (const auto& member : object.GetObject()) {
    texts[member.name.GetString()] = member.value.GetString();
  }
  return texts;
}

}  // namespace

double Record::operator[](const std::string& key) const {
  const auto found = numbers.find(key);
  return found != numbers.end() ? found->second : std::numeric_limits<double>::quiet_NaN();
}

std::vector<const Record*> Report::group(const std::string& name) const {
  std::vector<const Record*> rows;
  for (const Record& record : records) {
    if (record.group == name) {
      rows.push_back(&record);
    }
  }
  return rows;
}

const Record* Report::find(const std::string& group, const std::string& name,
                           const std::map<std::string, double>& numbers) const {
  const auto found = std::find_if(records.begin(), records.end(), [&](const Record& record) {
    return record.group == group && record.name == name &&
           std::all_of(numbers.begin(), numbers.end(),
                       [&record](const auto& wanted) { return record[wanted.first] == wanted.second; });
  });
  return found != records.end() ? &*found : nullptr;
}

double Report::number(const std::string& key, const std::string& group, const std::string& name,
                      const std::map<std::string, double>& numbers) const {
  const Record* record = find(group, name, numbers);
  return record != nullptr ? (*record)[key] : std::numeric_limits<double>::quiet_NaN();
}

void write_json(const std::string& file, const Report& report) {
  std::ofstream out(file);
  rapidjson::OStreamWrapper stream(out);
  Writer json(stream);
  json.SetIndent(' ', 1);
  json.SetMaxDecimalPlaces(9);  // nanoseconds, nanometres
  json.SetFormatOptions(rapidjson::kFormatSingleLineArray);
  json.StartObject();
  json.Key("about");
  write_texts(json, report.about);
  json.Key("records");
  json.StartArray();
  for (const Record& record : report.records) {
    json.StartObject();
    json.Key("group");
    json.String(record.group.c_str());
    json.Key("name");
    json.String(record.name.c_str());
    json.Key("numbers");
    json.StartObject();
    for (const auto& [key, value] : record.numbers) {
      json.Key(key.c_str());
      if (std::isfinite(value)) {
        json.Double(value);
      } else {
        json.Null();
      }
    }
    json.EndObject();
    json.Key("texts");
    write_texts(json, record.texts);
    json.EndObject();
  }
  json.EndArray();
  json.EndObject();
  out << '\n';
  out.close();
  if (!out) {
    fail(file, ": cannot be written");
  }
}

Report read_json(const std::string& file) {
  std::ifstream in(file);
  if (!in) {
    fail(file, ": cannot be read");
  }
  rapidjson::IStreamWrapper stream(in);
  rapidjson::Document json;
  json.ParseStream(stream);
  if (json.HasParseError() || !json.IsObject() || !json.HasMember("about") || !json.HasMember("records")) {
    fail(file, ": is no report of the benchmark");
  }
  Report report;
  report.about = read_texts(json["about"]);
  for (const auto& row : json["records"].GetArray()) {
    Record record;
    record.group = row["group"].GetString();
    record.name = row["name"].GetString();
    record.texts = read_texts(row["texts"]);
    for (const auto& member : row["numbers"].GetObject()) {
      record.numbers[member.name.GetString()] =
          member.value.IsNull() ? std::numeric_limits<double>::quiet_NaN() : member.value.GetDouble();
    }
    report.records.push_back(std::move(record));
  }
  return report;
}

}  // namespace depthgrid::lab
