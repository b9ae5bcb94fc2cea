// A robot's capsules over the edges of its shapes, from two sides.
#pragma once

#include <filesystem>
#include <vector>

#include "program/robot/robot_survey.hpp"

namespace depthgrid::program {

/// At joint positions q. Shapes are drawn by the edges of their triangles (those of the other kind in a lighter gray),
/// capsules as their outlines in a colour a link, corners that lie outside of their link's capsules as red dots. Throws
/// Error where there is nothing to draw, or that names the file.
void save_robot_picture(const std::filesystem::path& file, const RobotSurvey& survey, const std::vector<double>& q);

}  // namespace depthgrid::program
