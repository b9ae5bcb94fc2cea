#include "depthgrid/files/joint_table.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/text_encoding.hpp"
#include "depthgrid/files/joint_columns.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::files {

namespace {

struct Row {
  std::size_t line;
  std::vector<std::string_view> cells;
};

/// The table as text; all rows have as many cells as the header.
struct Cells {
  const std::string& name;
  std::vector<std::string> header;
  std::vector<Row> rows;

  [[noreturn]] void fail_at(const Row& row, std::size_t column, const std::string& rule) const {
    fail(name, ": line ", row.line, ", column '", header[column], "': '", row.cells[column], "' ", rule);
  }
  [[nodiscard]] std::vector<double> numbers(std::size_t column) const {
    std::vector<double> result;
    for (const Row& row : rows) {
      const auto number = parse_number<double>(row.cells[column]);
      if (!number || !std::isfinite(*number)) {
        fail_at(row, column, "must be a finite number");
      }
      result.push_back(*number);
    }
    return result;
  }
};

std::string_view unquoted(std::string_view cell) {
  cell = trimmed(cell);
  return cell.size() >= 2 && cell.front() == '"' && cell.back() == '"' ? trimmed(cell.substr(1, cell.size() - 2))
                                                                       : cell;
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end =
        std::min(separator == ' ' ? line.find_first_of(" \t", begin) : line.find(separator, begin), line.size());
    const std::string_view cell = unquoted(line.substr(begin, end - begin));
    if (separator != ' ' || !cell.empty()) {  // any number of blanks is one separator
      cells.push_back(cell);
    }
    begin = end + 1;
  }
  return cells;
}

char separator_of(std::string_view header) {
  const auto found = header.find_first_of(",;\t");
  return header.find(',') != std::string_view::npos ? ',' : found == std::string_view::npos ? ' ' : header[found];
}

/// "time A1 A2" behind a #, and no remark ("one row per image").
bool is_header(std::string_view line, std::span<const std::string> joints) {
  bool has_row = false;
  bool has_joint = false;
  for (const std::string_view cell : cells_of(line, separator_of(line))) {
    const ColumnName name = column_name(std::string(cell), joints);
    has_row = has_row || name.is_time || name.is_frame;
    has_joint = has_joint ||
                std::any_of(joints.begin(), joints.end(), [&](const std::string& joint) { return name.is_of(joint); });
  }
  return has_row && has_joint;
}

Cells cells_in(std::string_view text, const std::string& name, std::span<const std::string> joints) {
  Cells cells{name, {}, {}};
  text = without_byte_order_mark(text, name + ": ");
  char separator = ',';
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool remark = line.starts_with('#') || line.starts_with('%');
    if (cells.header.empty() && remark && is_header(line.substr(1), joints)) {
      line = trimmed(line.substr(1));
    } else if (remark || line.empty()) {
      continue;
    }
    if (cells.header.empty()) {
      separator = separator_of(line);
      for (const std::string_view cell : cells_of(line, separator)) {
        cells.header.emplace_back(cell);
      }
      if (parse_number<double>(cells.header.front())) {
        fail(name, ": line ", number, ": begins with the number '", cells.header.front(),
             "', must be a header with the names of the columns: time or frame, and the joints");
      }
      continue;
    }
    Row row{number, cells_of(line, separator)};
    if (row.cells.size() != cells.header.size()) {
      fail(name, ": line ", number, ": ", row.cells.size(), " values, must be ", cells.header.size(),
           " as in the header");
    }
    cells.rows.push_back(std::move(row));
  }
  if (cells.rows.empty()) {
    fail(name, ": holds no joint positions, needs a header and at least one row");
  }
  return cells;
}

double median_step(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps.push_back(std::abs(times[i] - times[i - 1]));
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Whether rows this far apart, up to this time, may be joint positions in this unit.
bool plausible(double step, double latest, double seconds_per_unit) {
  constexpr double kMonth_s = 2.6e6;
  const double step_s = step * seconds_per_unit;
  const double latest_s = latest * seconds_per_unit;
  return step_s >= 0.0005 && step_s <= (seconds_per_unit == 1 ? 100 : 0.5) &&
         (latest_s < kMonth_s || (latest_s > 1e9 && latest_s < 4e9));
}

/// The unit of times whose column does not say it.
const TimeUnit& unit_by_range(const Cells& cells, std::size_t column, const std::vector<double>& times) {
  const TimeUnit* found = nullptr;
  bool several = false;
  if (times.size() > 1) {
    const bool whole = std::all_of(times.begin(), times.end(), [](double t) { return t == std::floor(t); });
    for (const TimeUnit& unit : time_units()) {
      if ((whole || unit.seconds >= 1e-3) && plausible(median_step(times), std::abs(times.back()), unit.seconds)) {
        several = found != nullptr;
        found = found == nullptr ? &unit : found;
      }
    }
  }
  if (found == nullptr || several) {
    fail(cells.name, ": column '", cells.header[column], "' from ", times.front(), " to ", times.back(), " may be ",
         several ? "seconds or a fraction of them" : "in no unit of time that fits",
         ": name it time_s, time_ms, time_us or time_ns, or state --joint-time-unit");
  }
  return *found;
}

bool is_within_second(double nanoseconds) { return nanoseconds >= 0 && nanoseconds < 1e9; }

/// Whole seconds, and nanoseconds within them: not two clocks, and not one in two units.
bool is_pair(const std::vector<double>& seconds, const std::vector<double>& nanoseconds) {
  constexpr double kRounded_s = 1e-3;
  bool same = std::any_of(nanoseconds.begin(), nanoseconds.end(), [](double n) { return !is_within_second(n); });
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    same = same && std::abs(seconds[i] - 1e-9 * nanoseconds[i]) <= kRounded_s;
  }
  return !same && std::all_of(seconds.begin(), seconds.end(), [](double s) { return s == std::floor(s); }) &&
         std::any_of(nanoseconds.begin(), nanoseconds.end(), is_within_second);
}

/// Takes the times of a pair of columns, whole seconds and nanoseconds; false where they are none.
bool read_pair(const Cells& cells, std::size_t whole, std::size_t fraction, JointTable& table) {
  const auto seconds = cells.numbers(whole);
  const auto nanoseconds = cells.numbers(fraction);
  if (!is_pair(seconds, nanoseconds)) {
    return false;
  }
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    if (!is_within_second(nanoseconds[i])) {
      cells.fail_at(cells.rows[i], fraction, "must be from 0 to 999999999, the nanoseconds within a second");
    }
    table.time_s.push_back(seconds[i] + 1e-9 * nanoseconds[i]);
  }
  table.time_column = "'" + cells.header[whole] + "' and '" + cells.header[fraction] + "'";
  return true;
}

void read_times(const Cells& cells, const std::vector<ColumnName>& names, std::optional<double> seconds_per_unit,
                JointTable& table) {
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].is_time) {
      columns.push_back(k);
    }
  }
  if (columns.empty()) {
    return;
  }
  const auto unit_is = [&names](std::size_t k, double seconds) {
    return names[k].time_unit != nullptr && names[k].time_unit->seconds == seconds;
  };
  if (columns.size() > 1) {
    for (const auto& [whole, fraction] : {std::pair(columns[0], columns[1]), std::pair(columns[1], columns[0])}) {
      if (unit_is(whole, 1) && unit_is(fraction, 1e-9) && read_pair(cells, whole, fraction, table)) {
        return;
      }
    }
  }
  const std::size_t column = columns.front();
  std::vector<double> times = cells.numbers(column);
  table.time_column = "'" + cells.header[column] + "'";
  double seconds = 1;
  if (names[column].time_unit != nullptr) {
    seconds = names[column].time_unit->seconds;
  } else if (seconds_per_unit) {
    seconds = *seconds_per_unit;
  } else {
    const TimeUnit& unit = unit_by_range(cells, column, times);
    seconds = unit.seconds;
    table.time_column += std::string(" taken as ") + unit.name + ", the only unit that fits";
  }
  for (const double time : times) {
    table.time_s.push_back(time * seconds);
  }
}

void read_frames(const Cells& cells, const std::vector<ColumnName>& names, JointTable& table) {
  const auto found = std::find_if(names.begin(), names.end(), [](const ColumnName& name) { return name.is_frame; });
  if (found == names.end()) {
    return;
  }
  const auto column = static_cast<std::size_t>(found - names.begin());
  for (const Row& row : cells.rows) {
    const auto frame = parse_number<int>(row.cells[column]);
    if (!frame || *frame < 0) {
      cells.fail_at(row, column, "must be a whole number from 0, as in the images' names");
    }
    table.frames.push_back(*frame);
  }
}

void read_joints(const Cells& cells, const std::vector<ColumnName>& names, std::span<const std::string> joints,
                 JointTable& table) {
  std::vector<bool> used(names.size(), false);
  for (const std::string& joint : joints) {
    JointColumn& result = table.joints.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!names[k].is_of(joint)) {
        continue;
      }
      if (!result.column.empty()) {
        fail(cells.name, ": the columns '", result.column, "' and '", cells.header[k], "' are both of joint '", joint,
             "', must be one");
      }
      result = {cells.header[k], cells.numbers(k), names[k].joint_unit};
      used[k] = true;
    }
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!used[k] && !names[k].is_time && !names[k].is_frame) {
      table.unused.push_back(cells.header[k]);
    }
  }
}

template <class T>
void keep(std::vector<T>& values, const std::vector<std::size_t>& rows) {
  std::vector<T> kept;
  for (const std::size_t i : rows) {
    if (!values.empty()) {
      kept.push_back(values[i]);
    }
  }
  values = std::move(kept);
}

/// The rows in the order of their frames or times, each once.
std::vector<std::size_t> ordered(const Cells& cells, const JointTable& table) {
  std::vector<std::size_t> rows(cells.rows.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  if (!table.frames.empty()) {
    std::sort(rows.begin(), rows.end(),
              [&](std::size_t a, std::size_t b) { return table.frames[a] < table.frames[b]; });
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (table.frames[rows[i]] == table.frames[rows[i - 1]]) {
        fail(cells.name, ": line ", cells.rows[std::max(rows[i], rows[i - 1])].line, ": frame ", table.frames[rows[i]],
             " stands there a second time");
      }
    }
    return rows;
  }
  std::vector<std::size_t> result;
  for (const std::size_t i : rows) {
    if (!result.empty() && table.time_s[i] < table.time_s[result.back()]) {
      fail(cells.name, ": line ", cells.rows[i].line, ": its time ", table.time_s[i], " s is before the one of line ",
           cells.rows[result.back()].line, ", ", table.time_s[result.back()], " s");
    }
    if (result.empty() || table.time_s[i] > table.time_s[result.back()]) {
      result.push_back(i);
    }
  }
  return result;
}

}  // namespace

JointTable parse_joint_table(std::string_view text, const std::string& name, std::span<const std::string> joints,
                             std::optional<double> seconds_per_unit) {
  const Cells cells = cells_in(text, name, joints);
  std::vector<ColumnName> names;
  for (const std::string& column : cells.header) {
    names.push_back(column_name(column, joints));
  }
  JointTable table;
  read_frames(cells, names, table);
  if (table.frames.empty()) {
    read_times(cells, names, seconds_per_unit, table);
  }
  if (table.time_s.empty() && table.frames.empty()) {
    fail(name, ": has no column 'time' and no column 'frame', must have one of them; it has ",
         joined_names(cells.header));
  }
  read_joints(cells, names, joints, table);
  for (const Row& row : cells.rows) {
    table.lines.push_back(row.line);
  }
  const std::vector<std::size_t> rows = ordered(cells, table);
  keep(table.time_s, rows);
  keep(table.frames, rows);
  keep(table.lines, rows);
  for (JointColumn& joint : table.joints) {
    keep(joint.values, rows);
  }
  return table;
}

JointTable load_joint_table(const std::filesystem::path& file, std::span<const std::string> joints,
                            std::optional<double> seconds_per_unit) {
  return parse_joint_table(read_text_file(file), file.string(), joints, seconds_per_unit);
}

}  // namespace depthgrid::files
