#include "program/distances/recorded_joints.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/joint_table.hpp"
#include "program/usage_error.hpp"
#include "report/number_text.hpp"

namespace depthgrid::program {

namespace {

constexpr double kDefaultGap_s = 0.1;
constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr double kMetresPerMillimetre = 1e-3;
/// How far beyond its limits a joint may be found: encoders, and limits that are rounded.
constexpr double kBeyondLimits = 0.05;

std::optional<double> seconds_per_unit(const std::optional<std::string>& unit) {
  return !unit           ? std::nullopt
         : *unit == "s"  ? std::optional<double>(1.0)
         : *unit == "ms" ? std::optional<double>(1e-3)
         : *unit == "us" ? std::optional<double>(1e-6)
                         : std::optional<double>(1e-9);
}

bool within_limits(const robot::Joint& joint, double position) {
  return position >= joint.lower - kBeyondLimits && position <= joint.upper + kBeyondLimits;
}

/// Takes out the jumps by whole turns of a joint without limits.
void unwrap(std::vector<double>& angles) {
  constexpr double kTurn = 2 * std::numbers::pi;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    angles[i] += kTurn * std::round((angles[i - 1] - angles[i]) / kTurn);
  }
}

/// Positions of one joint in radians or metres.
class JointConverter {
 public:
  JointConverter(const RecordedRobotOptions& options, const files::JointTable& table)
      : options_(options), table_(table) {}

  std::vector<double> operator()(const robot::Joint& joint, const files::JointColumn& column) {
    std::vector<double> q = column.values;
    const bool slides = joint.type == robot::JointType::prismatic;
    if (!slides && column.unit == files::JointUnit::metres) {
      fail(options_.joints_file, ": column '", column.column, "' is a length, but joint '", joint.name,
           "' turns: its positions are angles; rename the column");
    }
    if (slides && (column.unit == files::JointUnit::radians || column.unit == files::JointUnit::degrees)) {
      fail(options_.joints_file, ": column '", column.column, "' is an angle, but joint '", joint.name,
           "' slides: its positions are metres");
    }
    const bool said = column.unit != files::JointUnit::not_said;
    const bool degrees =
        !slides && (said ? column.unit == files::JointUnit::degrees : options_.joint_unit == "degrees");
    has_degrees_ = has_degrees_ || degrees;
    has_radians_ = has_radians_ || (!slides && !degrees);
    if (degrees) {
      std::transform(q.begin(), q.end(), q.begin(), [](double value) { return value * kRadiansPerDegree; });
    }
    if (slides || (!said && !options_.joint_unit)) {  // --joint-unit is of angles
      check(joint, column);
    }
    if (joint.type == robot::JointType::continuous) {
      unwrap(q);
    }
    return q;
  }

  /// ", angles in ..." of the joints so far; for people.
  [[nodiscard]] std::string units_text() const {
    return !has_degrees_ ? (has_radians_ ? ", angles in radians" : "")
                         : (has_radians_ ? ", angles in degrees and radians" : ", angles in degrees");
  }

 private:
  void check(const robot::Joint& joint, const files::JointColumn& column) const {
    const bool slides = joint.type == robot::JointType::prismatic;
    const double factor = slides ? kMetresPerMillimetre : kRadiansPerDegree;
    const bool good = std::all_of(column.values.begin(), column.values.end(),
                                  [&](double value) { return within_limits(joint, value * factor); });
    const std::string hint = slides ? std::string(good ? "; are these millimetres? slides are metres" : "") +
                                          "; if the joint was there, mend its limits in the URDF"
                                    : std::string(good ? ": if these are degrees, state --joint-unit degrees" : "") +
                                          ", if the joint was there, --joint-unit radians";
    for (std::size_t i = 0; i < column.values.size(); ++i) {
      if (!within_limits(joint, column.values[i])) {
        fail(options_.joints_file, ": line ", table_.lines[i], ", column '", column.column, "': joint '", joint.name,
             "' at ", column.values[i], " ", unit_of(joint.type), " is beyond its limits ", joint.lower, " and ",
             joint.upper, hint);
      }
    }
  }

  const RecordedRobotOptions& options_;
  const files::JointTable& table_;
  bool has_degrees_ = false;
  bool has_radians_ = false;
};

/// The positions of --joint, one a joint of the model.
std::vector<std::optional<double>> still_positions(const RecordedRobotOptions& options,
                                                   const robot::RobotModel& model) {
  std::vector<std::optional<double>> result(model.joints().size());
  for (const std::string& text : options.still_joints) {
    const NamedPosition named = named_position(text, "--joint");
    const std::size_t index = joint_index(model, named.joint, "--joint");
    if (result[index]) {
      fail_usage("--joint ", text, ": joint '", named.joint, "' is given twice");
    }
    check_limits(model.joints()[index], named.position, "--joint " + text);
    result[index] = named.position;
  }
  return result;
}

/// One column a joint of the model.
std::vector<std::vector<double>> positions_of(const RecordedRobotOptions& options, const robot::RobotModel& model,
                                              const files::JointTable& table, JointConverter& converter) {
  const auto still = still_positions(options, model);
  std::vector<std::vector<double>> positions;
  std::string missing;
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const robot::Joint& joint = model.joints()[j];
    const bool has_column = !table.joints[j].column.empty();
    if (has_column && still[j]) {
      fail_usage("--joint ", joint.name, ": ", options.joints_file, " has this joint already, in column '",
                 table.joints[j].column, "'");
    }
    if (!has_column && !still[j]) {
      missing += (missing.empty() ? "" : ", ") + joint.name;
      continue;
    }
    positions.push_back(has_column ? converter(joint, table.joints[j])
                                   : std::vector<double>(table.lines.size(), *still[j]));
  }
  if (!missing.empty()) {
    std::string others;
    for (const std::string& name : table.unused) {
      others += (others.empty() ? "; columns of no joint: " : ", ") + name;
    }
    fail(options.joints_file, ": has no column for ", missing, " of ", model.source(), others,
         "; a joint that stands still: --joint NAME=VALUE");
  }
  return positions;
}

std::string note_of(const RecordedRobotOptions& options, const files::JointTable& table, const std::string& units) {
  std::string note = options.joints_file + ": " + std::to_string(table.lines.size()) + " rows, ";
  note += table.frames.empty() ? "time " + table.time_column + " from " + report::micro_text(table.time_s.front()) +
                                     " to " + report::micro_text(table.time_s.back()) + " s"
                               : "by frame number";
  note += units;
  for (std::size_t k = 0; k < table.unused.size(); ++k) {
    note += (k == 0 ? "; not used: " : ", ") + table.unused[k];
  }
  return note;
}

}  // namespace

std::optional<double> RecordedJoints::time_of(int frame_number, double time_s) const {
  if (frames.empty()) {
    return time_s;
  }
  const auto found = std::lower_bound(frames.begin(), frames.end(), frame_number);
  return found == frames.end() || *found != frame_number
             ? std::nullopt
             : std::optional<double>(static_cast<double>(found - frames.begin()));
}

RecordedJoints recorded_joints(const RecordedRobotOptions& options, const robot::RobotModel& model) {
  std::vector<std::string> names;
  names.reserve(model.joints().size());
  for (const robot::Joint& joint : model.joints()) {
    names.push_back(joint.name);
  }
  if (names.empty()) {
    fail(model.source(), ": the robot has no joint that moves");
  }
  files::JointTable table =
      files::load_joint_table(options.joints_file, names, seconds_per_unit(options.joint_time_unit));
  JointConverter converter(options, table);
  const auto positions = positions_of(options, model, table, converter);

  RecordedJoints result;
  result.file = options.joints_file;
  result.note = note_of(options, table, converter.units_text());
  const bool by_frame = !table.frames.empty();
  const double gap_s = by_frame ? 1.0 : options.joint_gap_s.value_or(kDefaultGap_s);
  if (!(std::isfinite(gap_s) && gap_s > 0)) {
    fail_usage("--joint-gap ", gap_s, " must be a positive number of seconds");
  }
  const std::size_t rows = table.lines.size();
  result.history = std::make_unique<robot::JointHistory>(names.size(), std::max<std::size_t>(2, rows), gap_s, 0.0);
  const double offset_s = options.joint_time_offset_s.value_or(0);
  std::vector<double> q(names.size());
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) {
      q[j] = positions[j][i];
    }
    const double time_s = by_frame ? static_cast<double>(i) : table.time_s[i] + offset_s;
    if (!result.history->add(time_s, q)) {
      fail(options.joints_file, ": line ", table.lines[i], ": its time ", time_s,
           " s is not later than the one before");
    }
    result.first_s = i == 0 ? time_s : result.first_s;
    result.last_s = time_s;
  }
  result.frames = std::move(table.frames);
  return result;
}

}  // namespace depthgrid::program
