// The parts of the page that are tables of measured figures.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "lab/speed/goals.hpp"
#include "lab/speed/record.hpp"

namespace depthgrid::lab {

/// For docs/goals.md.
std::string goals_text(const std::vector<Goal>& all);
std::string goals_text(const std::vector<AimedGoal>& all);
/// Where the time goes, as far as counts tell.
void write_work(std::ostream& page, const Report& report);
/// The search's own figures.
void write_ours(std::ostream& page, const Report& report);
/// All peers' tables, and what is quicker than ours.
void write_side_by_side(std::ostream& page, const Report& report);

}  // namespace depthgrid::lab
