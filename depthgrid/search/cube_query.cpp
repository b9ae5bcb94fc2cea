#include "depthgrid/search/cube_query.hpp"

#include <cmath>

#include "depthgrid/core/rounding.hpp"

namespace depthgrid::search {

void make_query(const views::Snapshot& snapshot, const memory::MemorySnapshot* memory, CubeQuery& query) noexcept {
  const views::Settings& settings = snapshot.settings();
  query.lattice = Lattice(snapshot);
  const Lattice& lattice = query.lattice;
  query.camera_count = snapshot.camera_count();
  for (std::size_t k = 0; k < views::kMaxCameras; ++k) {
    query.order[k] = static_cast<std::uint8_t>(k);
  }
  for (std::size_t k = 0; k < query.camera_count; ++k) {
    make_local(snapshot, k, lattice.origin_world, lattice.extent_m, query.cameras[k]);
  }
  query.possible_reach_m = memory != nullptr ? memory->reach_m(snapshot.reference_time_s()) : 0.0;
  // With every image too late nothing is known, whatever v_max lets one remember.
  bool any_new = false;
  for (std::size_t k = 0; k < query.camera_count; ++k) {
    any_new = any_new || (snapshot.view(k).present() && !snapshot.late(k));
  }
  query.possible = memory != nullptr && any_new && std::isfinite(query.possible_reach_m) ? &memory->voxels() : nullptr;
  query.uncovered_ignored = settings.policies.unobserved == views::Policy::ignored;
  const auto* box = std::get_if<views::BoxSpace>(&settings.space);
  query.boxed = box != nullptr;
  query.principal = -1;
  query.slack_m = settings.resolution_m - 1e-5;
  if (box != nullptr) {
    query.space_low = box->low_world - lattice.origin_world;
    query.space_high = box->high_world - lattice.origin_world;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      query.box_low[i] = float_below(query.space_low[axis]);
      query.box_high[i] = float_above(query.space_high[axis]);
    }
  } else {
    query.frustum = std::get<views::FrustumSpace>(settings.space);
    query.principal = static_cast<int>(query.frustum.principal);
    query.d_min_m = float_below(query.frustum.d_min_m);
    query.d_max_m = float_above(query.frustum.d_max_m);
  }
}

}  // namespace depthgrid::search
