#include "lab/speed/record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {

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
  Json records = Json::array();
  for (const Record& record : report.records) {
    Json numbers = Json::object();
    for (const auto& [key, value] : record.numbers) {
      const bool small = std::abs(value) < 1e3;  // nanoseconds and nanometres are enough
      numbers[key] = finite(small ? std::round(value * 1e9) / 1e9 : value);
    }
    records.push_back(
        {{"group", record.group}, {"name", record.name}, {"numbers", std::move(numbers)}, {"texts", record.texts}});
  }
  write_json_file(file, {{"about", report.about}, {"records", std::move(records)}});
}

Report read_json(const std::string& file) {
  constexpr const char* kWhat = "report of the benchmark";
  const Json json = read_json_file(file, kWhat, {"about", "records"});
  return taken_apart(file, kWhat, [&json] {
    Report report;
    json["about"].get_to(report.about);
    for (const Json& row : json["records"]) {
      Record record{row.at("group"), row.at("name"), {}, row.at("texts")};
      for (const auto& [key, value] : row.at("numbers").items()) {
        record.numbers[key] = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
      }
      report.records.push_back(std::move(record));
    }
    return report;
  });
}

}  // namespace depthgrid::lab
