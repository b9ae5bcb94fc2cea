// Answers as CSV or JSON lines.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/input/control_points.hpp"

namespace depthgrid::app {

enum class AnswerFormat : std::uint8_t { csv, json_lines };

/// Turns answers into lines of text. A distance that is not known is an empty cell or null, never a number. Distances
/// (known_to_m too) are rounded down to a micrometre. Immutable after construction.
class AnswerWriter {
 public:
  /// `T_output_world` maps the world to the frame of the control points, in which everything is written. With `hybrid`
  /// the hybrid direction and its number of obstacle points follow. `rig` must outlive the writer.
  AnswerWriter(AnswerFormat format, const Rig& rig, Pose T_output_world, bool hybrid);

  /// The first line: column names of CSV, nothing for JSON lines.
  [[nodiscard]] std::string header() const;

  /// One line. `point` is in the output frame; `time_s` is empty where the recording does not say.
  [[nodiscard]] std::string line(int frame, std::optional<double> time_s, const input::ControlPoint& point,
                                 const grid::Evaluation& answer) const;

 private:
  struct Row;
  [[nodiscard]] static std::string csv(const Row& row);
  [[nodiscard]] static std::string json(const Row& row);

  AnswerFormat format_;
  const Rig& rig_;
  Pose T_output_world_;
  bool hybrid_;
};

}  // namespace depthgrid::app
