#include "depthgrid/search/repulsion_table.hpp"

#include "depthgrid/core/repulsion_law.hpp"

namespace depthgrid::search {

void RepulsionTable::aim(const views::Settings& settings) noexcept {
  if (settings.rho_m == rho_m_ && settings.repulsion_alpha == alpha_) {
    return;
  }
  rho_m_ = settings.rho_m;
  alpha_ = settings.repulsion_alpha;
  places_per_m_ = kLast / rho_m_;
  for (std::size_t place = 0; place < values_.size(); ++place) {
    values_[place] = 1 / inverse_repulsion(static_cast<double>(place) / places_per_m_, rho_m_, alpha_);
  }
}

}  // namespace depthgrid::search
