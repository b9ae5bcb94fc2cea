// What the name of a column of joint positions stands for. Internal.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "depthgrid/files/joint_table.hpp"

namespace depthgrid::files {

struct TimeUnit {
  const char* name;
  double seconds;
};

/// Seconds, milliseconds, microseconds, nanoseconds.
[[nodiscard]] std::span<const TimeUnit> time_units() noexcept;

struct ColumnName {
  std::vector<std::string> joints;  ///< the joints that this name may stand for, small letters
  JointUnit joint_unit = JointUnit::not_said;
  bool is_time = false;
  const TimeUnit* time_unit = nullptr;  ///< as the name says it; null: it does not
  bool is_frame = false;

  [[nodiscard]] bool is_of(const std::string& joint) const;
};

/// A name that is one of `joints` is no time and no frame, whatever else it may mean.
[[nodiscard]] ColumnName column_name(const std::string& column, std::span<const std::string> joints);

/// "a, b, c".
[[nodiscard]] std::string joined_names(const std::vector<std::string>& names);

}  // namespace depthgrid::files
