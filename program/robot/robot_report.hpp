// What depthgrid robot prints.
#pragma once

#include <string>
#include <vector>

#include "program/robot/robot_survey.hpp"

namespace depthgrid::program {

/// For people: tables, and what is missing. `q`: where --tip is, the joint positions at which it is said to stand.
[[nodiscard]] std::string robot_text(const RobotSurvey& survey, const std::vector<double>& q);

/// The same as one JSON object and a line break: radians, metres; what is not stated or not known is null.
[[nodiscard]] std::string robot_json(const RobotSurvey& survey, const std::vector<double>& q);

/// One line about meshes that are not there and the option that would find them; empty where none is missing.
[[nodiscard]] std::string missing_meshes_text(const RobotSurvey& survey);

}  // namespace depthgrid::program
