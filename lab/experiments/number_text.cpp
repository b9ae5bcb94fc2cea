#include "lab/experiments/number_text.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace depthgrid::experiments {

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) {
    return "-";
  }
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string percent(double share, int digits) { return fixed(100 * share, digits) + " %"; }

}  // namespace depthgrid::experiments
