// Colours of pictures that show a cell from above, so that all of them read alike.
#pragma once

#include "report/colour.hpp"

namespace depthgrid::report {

inline constexpr Colour kOutsideView{0.87, 0.91, 0.96};  ///< where no camera looks
inline constexpr Colour kGrayArea{0.60, 0.60, 0.62};     ///< not known free
inline constexpr Colour kFreeByOther{0.78, 0.92, 0.78};  ///< known free to another camera
inline constexpr Colour kPerson{0.80, 0.36, 0.10};
inline constexpr Colour kRobot{0.35, 0.33, 0.62};
inline constexpr Colour kUnseenAnswer{0.84, 0.08, 0.30};  ///< nearest is space that nobody has seen
inline constexpr Colour kSeenAnswer{0.00, 0.45, 0.72};    ///< nearest is a measured surface
inline constexpr Colour kNothingNear{0.10, 0.55, 0.22};

}  // namespace depthgrid::report
