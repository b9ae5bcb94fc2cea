// A limit on how fast a point of the body comes nearer, whatever joints do it.
#pragma once

#include "depthgrid/control/joints.hpp"

namespace depthgrid::control {

/// gradient . qd <= speed.
struct ApproachLimit {
  JointVector gradient;  ///< J^T n: metres of approach for each radian
  double speed_m_s = 0;
};

}  // namespace depthgrid::control
