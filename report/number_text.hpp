// Numbers as text, independent of the locale.
#pragma once

#include <string>

namespace depthgrid::report {

/// The shortest text that reads back as the same double. NaN gives an empty text.
std::string exact_text(double value);

/// Six decimals; NaN gives an empty text. Metres to a micrometre.
std::string micro_text(double value);

/// Six decimals, rounded towards minus infinity, so that a lower bound stays one. NaN gives an empty text.
std::string micro_text_down(double value);

}  // namespace depthgrid::report
