// Everything that the options of `depthgrid distances` decide, resolved once: what works afterwards reads only this.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/avoidance/least_padding.hpp"
#include "depthgrid/core/distance_evaluator.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/files/recording.hpp"
#include "program/distances/answer_writer.hpp"
#include "program/distances/evaluation_options.hpp"
#include "program/distances/point_options.hpp"
#include "program/distances/recorded_robot.hpp"
#include "program/distances/robot_options.hpp"
#include "program/distances/search_options.hpp"
#include "program/sensor_options.hpp"

namespace depthgrid::program {

/// As given on the command line.
struct DistancesOptions {
  std::string recording;
  files::McapChoice mcap;
  std::vector<std::string> cameras;
  std::string principal;
  PointOptions points;
  std::string frame_of_points = "world";
  std::string frames;
  bool static_scene = false;
  std::string map_file;
  std::string format = "csv";
  std::string output = "-";
  std::string pictures;
  bool reasons = false;
  EvaluationOptions evaluation;
  SensorOptions sensor;
  SearchOptions search;
  RecordedRobotOptions robot;
};

struct DistancesPlan {
  files::Recording recording;
  Rig rig;                               ///< as the evaluator knows it
  Pose T_output_world;                   ///< from the evaluator's world to the frame in which the user speaks
  Pose T_world_recording;                ///< from the recording's world to the evaluator's
  std::vector<int> frames;               ///< indices into the recording
  Points points;                         ///< none: the robot's links are asked for
  std::unique_ptr<RecordedRobot> robot;  ///< none: nothing is taken out of the images
  std::unique_ptr<DistanceEvaluator> evaluator;
  std::optional<avoidance::LeastPaddingSettings> least_padding;  ///< asked for instead of distances
  bool asks_links = false;                                       ///< of the robot, in place of points
  bool takes_shapes = false;                                     ///< spheres and capsules, not only points
  AnswerFormat format = AnswerFormat::csv;
  AnswerColumns columns;
  double rho_m = 0;
  std::string output;                    ///< file, or - for standard output
  std::string pictures;                  ///< folder; empty: none
  std::vector<std::string> assumptions;  ///< lines for the user, said beside the answers
  std::vector<std::string> warnings;
};

/// Opens the recording and makes the evaluator. Throws UsageError where options do not fit together or to the
/// recording, and Error where a file or a value is broken.
[[nodiscard]] DistancesPlan plan_distances(const DistancesOptions& options);

}  // namespace depthgrid::program
