// The pictures that explain a page of docs/ each. Drawn from the definitions, in a flat world or with the library's own
// formulas, not by hand.
#pragma once

#include <array>
#include <string>

#include "lab/pictures/sheet.hpp"

namespace depthgrid::lab {

[[nodiscard]] Sheet draw_method();
[[nodiscard]] Sheet draw_search();
[[nodiscard]] Sheet draw_robot();
[[nodiscard]] Sheet draw_avoidance();
[[nodiscard]] Sheet draw_control();
[[nodiscard]] Sheet draw_choosing();

struct ExplainingPicture {
  const char* page;  ///< of docs/, without .md; the file is docs/images/explain-PAGE.png
  Sheet (*draw)();
};

inline constexpr std::array<ExplainingPicture, 6> kExplainingPictures{{{"method", draw_method},
                                                                       {"search", draw_search},
                                                                       {"robot", draw_robot},
                                                                       {"avoidance", draw_avoidance},
                                                                       {"control", draw_control},
                                                                       {"choosing", draw_choosing}}};

[[nodiscard]] inline std::string file_name(const ExplainingPicture& picture) {
  return std::string("explain-") + picture.page + ".png";
}

}  // namespace depthgrid::lab
