// Points, and the lines to their nearest obstacles, over a camera's image.
#pragma once

#include <Eigen/Core>
#include <span>

#include "depthgrid/core/proximity.hpp"
#include "depthgrid/core/rig.hpp"
#include "report/canvas.hpp"

namespace depthgrid::report {

/// World frame, metres.
struct AnsweredPoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Proximity answer;
};

/// Over the image of `camera` that fills `tile`. Points are discs and lines lead to the nearest obstacle points,
/// coloured from red (contact) to green (rho or more); a ring without line is a point without distance or with nothing
/// within rho.
void draw_answers(Canvas& canvas, const RigCamera& camera, const Rectangle& tile, std::span<const AnsweredPoint> lines,
                  double rho_m);

/// A horizontal bar with these colours and what they mean.
void draw_distance_legend(Canvas& canvas, const Rectangle& area, double rho_m);

}  // namespace depthgrid::report
