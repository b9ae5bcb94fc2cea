#include "depthgrid/memory/image_intake.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depthgrid/memory/carving.hpp"
#include "depthgrid/memory/declarations.hpp"
#include "depthgrid/memory/growth.hpp"

namespace depthgrid::memory {
namespace {

/// Readings of one image in places that the memory takes for free: more than half an image of them say no more.
constexpr std::size_t kMostReadings = std::size_t{1} << 16;

template <class Side>
int largest(const Rig& rig, Side&& side) {
  int result = 1;
  for (const RigCamera& camera : rig.cameras) {
    result = std::max(result, side(camera.intrinsics));
  }
  return result;
}

}  // namespace

ImageIntake::ImageIntake(const views::ViewStore& views, const MemorySettings& settings)
    : thinnest_hidden_m_(settings.thinnest_hidden_m),
      ignored_before_s_(-std::numeric_limits<double>::infinity()),
      planes_(largest(views.rig(), [](const PinholeCamera& c) { return c.width_px; }),
              largest(views.rig(), [](const PinholeCamera& c) { return c.height_px; })) {
  validate(settings);
  const VoxelSet region(settings.low_world, settings.high_world, settings.voxel_m);
  blocks_ = region.voxel_blocks();
  blocking_.assign(views.rig().cameras.size(), BlockingPixels(blocks_.size()));
  seeds_.readings.reserve(kMostReadings);
  seeds_.row_m = DepthImage(largest(views.rig(), [](const PinholeCamera& c) { return c.width_px; }), 1);
  seeds_.in_row.resize(static_cast<std::size_t>(seeds_.row_m.width_px()));
}

void ImageIntake::ignore_before(double time_s) noexcept {
  ignored_before_s_ = time_s > ignored_before_s_ ? time_s : ignored_before_s_;
}

Intake ImageIntake::take(const views::Snapshot& snapshot, std::uint32_t cameras, PossibleSpace& space,
                         History& history) noexcept {
  std::array<std::size_t, views::kMaxCameras> order{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < snapshot.camera_count(); ++k) {
    const views::View& view = snapshot.view(k);
    if (((cameras >> k) & 1U) != 0 && view.present() && std::isfinite(view.time_s()) && view.version() != taken_[k]) {
      order[count++] = k;
    }
  }
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
            [&](std::size_t a, std::size_t b) { return snapshot.view(a).time_s() < snapshot.view(b).time_s(); });
  Intake result;
  for (std::size_t n = 0; n < count; ++n) {
    take_one(snapshot, order[n], space, history, result);
  }
  return result;
}

void ImageIntake::take_one(const views::Snapshot& snapshot, std::size_t camera, PossibleSpace& space, History& history,
                           Intake& result) noexcept {
  const views::View& view = snapshot.view(camera);
  const double v_max_m_s = snapshot.settings().v_max_m_s;
  taken_[camera] = view.version();
  if (!(view.time_s() <= space.time_s) && !std::isnan(space.time_s)) {
    grow(space, v_max_m_s > 0 ? v_max_m_s * (view.time_s() - space.time_s) : 0.0, blocks_, &history, view.time_s());
  }
  if (space.is_everything && view.time_s() < space.time_s) {
    history.begin_anew(view.time_s());
  }
  // Where everything may be occupied it may be at any time.
  if (space.is_everything || !(view.time_s() <= space.time_s)) {
    space.time_s = view.time_s();
  }
  ++result.images;
  const VoxelSet& voxels = space.voxels;
  const double late_s = space.time_s - view.time_s();
  if (view.time_s() < ignored_before_s_ || v_max_m_s * late_s > (voxels.high_world() - voxels.low_world()).norm()) {
    return;
  }
  planes_.update(views::prepared(view), snapshot.camera(camera).intrinsics);
  const Carver carver = make_carver(snapshot, camera, late_s, planes_, space, thinnest_hidden_m_);
  if (carve(carver, blocking_[camera], space.voxels) > 0) {
    space.is_everything = false;
  }
  const CameraMargins& margins = snapshot.settings().margins[camera];
  take_out(views::prepared(view).links_world, -v_max_m_s * (margins.time_uncertainty_s + late_s), thinnest_hidden_m_,
           space);
  history.note(space.voxels, space.time_s, false);
  const Seeded seeded = put_back(snapshot, camera, thinnest_hidden_m_, space, seeds_);
  if (seeded.impossible > 0) {
    space.impossible = {.images = space.impossible.images + 1,
                        .voxels = space.impossible.voxels + seeded.impossible,
                        .camera = static_cast<std::uint16_t>(camera),
                        .time_s = view.time_s(),
                        .at_world = seeded.impossible_at_world};
  }
  if (seeded.voxels > 0) {
    history.note(space.voxels, space.time_s, false);
  }
  result.impossible += seeded.impossible;
}

}  // namespace depthgrid::memory
