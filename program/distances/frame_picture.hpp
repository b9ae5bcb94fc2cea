// A picture of one frame: the depth images with the control points and the lines to their nearest obstacles.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "program/distances/robot_pixels.hpp"
#include "report/answers_picture.hpp"

namespace depthgrid::program {

using PictureLine = report::AnsweredPoint;

/// Where the picture of a frame goes: FOLDER/frame_0007.png.
std::filesystem::path picture_file(const std::string& folder, int frame_number);

/// `robot`: of each camera one kind a pixel, or nothing. Pixels taken for the robot are red; of the others on its
/// capsules those that read nearer green, farther blue; no reading has its own colour everywhere.
///
/// Draws the cameras side by side, at most three in a row. Points are discs and lines lead to the nearest obstacle
/// points, coloured from red (contact) to green (rho or more); a ring without line is a point without distance or with
/// nothing within rho. Written under a temporary name and then renamed. Throws Error that names the file.
void save_frame_picture(const std::filesystem::path& file, const std::string& title, const Rig& rig,
                        std::span<const Frame> frames, std::span<const PictureLine> lines, double rho_m,
                        std::span<const std::vector<RobotPixel>> robot = {});

}  // namespace depthgrid::program
