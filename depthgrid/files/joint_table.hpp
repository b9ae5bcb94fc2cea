// Recorded joint positions: a table of text with a header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::files {

/// What a column's name says of its numbers.
enum class JointUnit : std::uint8_t { not_said, radians, degrees, metres };

/// A joint's column. Values as in the file.
struct JointColumn {
  std::string column;          ///< its name in the file; empty: the file has none for this joint
  std::vector<double> values;  ///< one a row
  JointUnit unit = JointUnit::not_said;
};

/// Rows in the file's order, or by frame number. There is a frame or a time for each.
struct JointTable {
  std::vector<JointColumn> joints;  ///< those asked for, in their order
  std::vector<double> time_s;       ///< increasing; empty: the file has frame numbers
  std::vector<int> frames;          ///< increasing; empty: the file has no frame numbers
  std::vector<std::size_t> lines;   ///< of the file, from 1
  std::string time_column;          ///< what became the time, and how its unit is known; for people
  std::vector<std::string> unused;  ///< other columns
};

/// Reads a table of joint positions: a header, then one row a sample, cells between commas, semicolons, tabs or blanks.
/// - Joints: columns called as one of `joints`; case, quotes, blanks and a unit (A1_rad, "A1 [deg]") do not count, nor
///   what stands before and after in paths such as /joint_states/A1/position.
/// - Time: a column time, t, stamp, timestamp or the like, or two of whole seconds and nanoseconds within them. Its
/// unit is what
///   its name says (time_ns), else `seconds_per_unit`, else the only one of s, ms, us and ns with which the rows are
///   0.5 ms to 0.5 s apart (us and ns: whole numbers; seconds: to 100 s) and the times are of these years or less than
///   a month.
/// - Frame: a column frame or image with the numbers in the images' names; then times are not read.
/// Blank lines and lines that begin with # or % are skipped (the header may begin so, if it names a joint), a row with
/// the time of the row before too. Throws Error that names file, line, column and value: no header, no time and no
/// frame, a unit that cannot be told, a cell of these columns that is no finite number, times that go back, a frame
/// twice, two columns for a joint.
[[nodiscard]] JointTable parse_joint_table(std::string_view text, const std::string& name,
                                           std::span<const std::string> joints,
                                           std::optional<double> seconds_per_unit = std::nullopt);
[[nodiscard]] JointTable load_joint_table(const std::filesystem::path& file, std::span<const std::string> joints,
                                          std::optional<double> seconds_per_unit = std::nullopt);

}  // namespace depthgrid::files
