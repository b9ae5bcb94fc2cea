// Answers as CSV or JSON lines.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "depthgrid/core/answer.hpp"
#include "depthgrid/core/past.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/files/control_points.hpp"

namespace depthgrid::program {

enum class AnswerFormat : std::uint8_t { csv, json_lines };

/// What is written beyond the columns that all methods have.
struct AnswerColumns {
  bool hybrid_direction = false;
  bool obstacle_points = false;  ///< how many the hybrid direction stands on
  bool reasons = false;          ///< what is nearest in words, and what a memory knows of it
  bool shapes = false;           ///< radius and end of the control points, and where on their axis the distance is
};

/// Why an answer is no larger.
struct AnswerReason {
  std::string text;
  std::optional<double> hidden_s;  ///< since when something may be there: the memory's Past
  Eigen::Vector3d from_world = Eigen::Vector3d::Constant(Past::kNaN);
};

/// Turns answers into lines of text. A distance that is not known is an empty cell or null, never a number. Distances
/// (known_to_m too) are rounded down to a micrometre, the blind layer up. Immutable after construction.
class AnswerWriter {
 public:
  /// `T_output_world` maps the world to the frame of the control points, in which everything is written. `rig` must
  /// outlive the writer.
  AnswerWriter(AnswerFormat format, const Rig& rig, Pose T_output_world, const AnswerColumns& columns);

  /// The first line: column names of CSV, nothing for JSON lines.
  [[nodiscard]] std::string header() const;

  /// One line. `point` is in the output frame; `time_s` is empty where the recording does not say.
  [[nodiscard]] std::string line(int frame, std::optional<double> time_s, const files::ControlPoint& point,
                                 const Answer& answer, const AnswerReason& reason = {}) const;

 private:
  struct Row;
  [[nodiscard]] std::string csv(const Row& row) const;
  [[nodiscard]] std::string json(const Row& row) const;

  AnswerFormat format_;
  const Rig& rig_;
  Pose T_output_world_;
  AnswerColumns columns_;
};

}  // namespace depthgrid::program
