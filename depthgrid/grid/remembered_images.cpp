#include "depthgrid/grid/remembered_images.hpp"

#include <algorithm>

namespace depthgrid::grid {
namespace {

/// What the memory needs of images: their margins, and how fast things move. Nobody asks for distances in it.
views::Settings image_settings(const GridMemory& memory, double rho_m) {
  memory::validate(memory.settings);
  views::Settings settings;
  settings.space = views::BoxSpace{memory.settings.low_world, memory.settings.high_world};
  settings.policies = {views::Policy::obstacle, views::Policy::obstacle, views::Policy::obstacle, 0};
  settings.margins = memory.margins;
  settings.rho_m = rho_m;
  settings.v_max_m_s = memory.v_max_m_s;
  return settings;
}

}  // namespace

RememberedImages::RememberedImages(const Rig& rig, const GridMemory& memory, double rho_m)
    : images(rig, image_settings(memory, rho_m)), store(images, memory.settings) {}

void RememberedImages::update(std::size_t camera, const Frame& frame) noexcept {
  if (images.update(camera, frame).taken()) {
    store.take(camera);
  }
}

Past RememberedImages::past(const Proximity& nearest, const DepthGrid& grid,
                            const Pose& T_world_principal) const noexcept {
  const bool is_hidden = nearest.state == ProximityState::occluded || nearest.state == ProximityState::unmeasured ||
                         nearest.state == ProximityState::unobserved;
  if (!is_hidden) {
    return {};
  }
  // What of the cell may be occupied lies no farther away than its box along the world's axes is large.
  const double z_m = T_world_principal.linear().col(2).dot(nearest.nearest_world - T_world_principal.translation());
  const int n = std::clamp(grid.cell_of(z_m), 0, grid.count() - 1);
  const double deep_m = grid.boundary_m(n + 1) - grid.boundary_m(n);
  const double wide_m = grid.boundary_m(n + 1) / std::min(grid.principal().fx_px, grid.principal().fy_px);
  return store.past(nearest.nearest_world, 3 * (deep_m + wide_m));
}

}  // namespace depthgrid::grid
