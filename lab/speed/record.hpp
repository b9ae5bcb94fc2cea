// Measured figures as flat records: what the JSON file holds, and what the page and its plots are made from.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace depthgrid::lab {

/// One row. Times are in seconds, lengths in metres, memory in bytes; the key ends in the unit.
struct Record {
  std::string group;  ///< what was measured, for instance "side by side"
  std::string name;   ///< of whom
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> texts;

  /// NaN where the row has no such number.
  [[nodiscard]] double operator[](const std::string& key) const;
};

/// All of one run.
struct Report {
  std::map<std::string, std::string> about;  ///< machine, date, what was run
  std::vector<Record> records;

  /// Rows of a group in the order in which they were added.
  [[nodiscard]] std::vector<const Record*> group(const std::string& name) const;
  /// The first row of this group and name, and with these numbers where given; null when there is none.
  [[nodiscard]] const Record* find(const std::string& group, const std::string& name,
                                   const std::map<std::string, double>& numbers = {}) const;
  /// A number of such a row, NaN when there is none.
  [[nodiscard]] double number(const std::string& key, const std::string& group, const std::string& name,
                              const std::map<std::string, double>& numbers = {}) const;
};

/// Throws Error when the file cannot be written. Numbers keep nine decimals; those that
/// are not finite become null.
void write_json(const std::string& file, const Report& report);
/// Throws Error when the file cannot be read or is no such report.
[[nodiscard]] Report read_json(const std::string& file);

}  // namespace depthgrid::lab
