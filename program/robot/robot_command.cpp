#include "program/robot/robot_command.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/error.hpp"
#include "program/cell_arguments.hpp"
#include "program/output_check.hpp"
#include "program/output_file.hpp"
#include "program/robot/robot_picture.hpp"
#include "program/robot/robot_report.hpp"
#include "program/robot/robot_survey.hpp"
#include "program/robot_options.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

struct RobotOptions {
  RobotFileOptions robot;
  std::vector<std::string> joints;
  std::string tip;
  std::string picture;
  bool json = false;
};

void run_robot(const RobotOptions& options) {
  if (!options.picture.empty()) {
    refuse_overwriting({{"--output", options.picture}}, robot_inputs(options.robot));
    check_output_file(options.picture);
  }
  const RobotSurvey survey = survey_robot(options.robot, options.tip);
  const std::vector<double> q = joint_positions(options.joints, survey.model);
  OutputFile output("-");
  output.write(options.json ? robot_json(survey, q) : robot_text(survey, q));
  output.commit();
  if (!survey.missing_meshes.empty()) {
    fail(survey.model.source(), ": ", missing_meshes_text(survey));
  }
  if (!options.picture.empty()) {
    save_robot_picture(options.picture, survey, q);
  }
}

}  // namespace

void add_robot_command(CLI::App& app) {
  auto options = std::make_shared<RobotOptions>();
  CLI::App* command =
      app.add_subcommand("robot", "whether a URDF loads; its joints, its capsules against its meshes, what is missing");
  command->add_option("URDF", options->robot.file, "robot file, or a cell file, CELL.yaml, that names it")->required();
  add_robot_file_options(*command, options->robot, "Robot");
  command->add_option("--tip", options->tip, "only the links from the root to this one, and where it stands")
      ->group("Robot");
  command
      ->add_option("--joints", options->joints,
                   "joint positions, radians or metres: one a joint, or NAME=VALUE for some, comma-separated (default: "
                   "0, or the limit nearest to it)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group("Robot");
  command->add_option("--output", options->picture,
                      "PNG picture to write: the capsules over the shapes' edges, from two sides");
  command->add_flag("--json", options->json, "one JSON object in place of tables");
  command->footer(
      "Examples:\n"
      "  depthgrid robot share/robots/kuka_lwr4.urdf --output lwr.png\n"
      "  depthgrid robot panda.urdf --package franka_description=/opt/franka_description --tip panda_hand \\\n"
      "      --joints=0,-0.8,0,-2.4,0,1.6,0.8,0.04\n"
      "Exit code 1 where the robot does not load. What the columns mean stands in docs/command.md.");
  command->callback([options] {
    if (is_cell_file(options->robot.file)) {
      const cell::Cell cell = cell::load_cell(options->robot.file);
      if (!cell.robot || cell.robot->is_built_in) {
        fail_usage(options->robot.file, cell.robot ? ": its robot is built in, and has no file" : ": has no robot");
      }
      options->robot.file = cell.robot->urdf;
    }
    run_robot(*options);
  });
}

}  // namespace depthgrid::program
