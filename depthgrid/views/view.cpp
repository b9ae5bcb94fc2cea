#include "depthgrid/views/view.hpp"

#include <limits>
#include <utility>

#include "depthgrid/core/rounding.hpp"
#include "depthgrid/core/usable_frame.hpp"
#include "depthgrid/views/image_preparation.hpp"
#include "depthgrid/views/prepared_image.hpp"
#include "depthgrid/views/pyramid_rows.hpp"
#include "depthgrid/views/reading.hpp"

namespace depthgrid::views {
namespace {

float pocket_m(const Policies& policies) noexcept {
  return policies.robot_pockets == Policy::ignored ? rounded_down(policies.ignored_pocket_m) : 0.0F;
}

}  // namespace

/// What is known of the camera, and the scratch memory of update().
struct View::Preparation {
  Preparation(RigCamera camera_in, const CameraMargins& margins, const Policies& policies)
      : camera(std::move(camera_in)),
        reading(camera.rule, camera.metres_per_unit, margins.sensor),
        radius_px(margins.sensor.lateral_px),
        pocket(pocket_m(policies)),
        blind_m(rounded_up(camera.rule.near_m)),
        rows(camera.intrinsics.width_px, camera.intrinsics.height_px, radius_px) {}

  RigCamera camera;
  Reading reading;
  int radius_px;
  float pocket;
  float blind_m;
  PreparationRows rows;
  DepthView kept;  ///< the newest image, in the buffer of that name
};

View::View(const RigCamera& camera, const CameraMargins& margins, const Policies& policies)
    : T_world_camera_(camera.T_world_camera) {
  validate(margins.sensor);
  image_ = std::make_unique<PreparedImage>(camera.intrinsics.width_px, camera.intrinsics.height_px);
  preparation_ = std::make_unique<Preparation>(camera, margins, policies);
  clear();
}

View::~View() = default;
View::View(View&&) noexcept = default;
View& View::operator=(View&&) noexcept = default;

int View::width_px() const noexcept { return image_->free_m.width_px(); }
int View::height_px() const noexcept { return image_->free_m.height_px(); }
float View::free_m(int u, int v) const noexcept { return image_->free_m.at(u, v); }

float View::measured_m(int u, int v) const noexcept {
  return present_ ? measured_depth_m(preparation_->kept, preparation_->camera.rule, u, v).value_or(0.0F) : 0.0F;
}

const char* View::why_unusable(const Frame& frame) const noexcept {
  return depthgrid::why_unusable(frame, preparation_->camera);
}

void View::clear() noexcept {
  present_ = false;
  time_s_ = std::numeric_limits<double>::quiet_NaN();
  image_->clear();
}

bool View::update(const Frame& frame, const Pose& T_world_camera) noexcept {
  T_world_camera_ = T_world_camera;  // what the camera covers is known although nothing in it is free
  if (why_unusable(frame) != nullptr) {
    clear();
    return false;
  }
  Preparation& p = *preparation_;
  PreparedImage& image = *image_;
  const Frame read = with_strides(frame);
  if (read.robot.near_m != nullptr) {
    image.clear_islands();
  }
  const NewImage news{read.depth, read.robot, p.radius_px, p.pocket, p.blind_m};
  image.has_islands = !prepare(p.reading, news, p.rows, image).empty();
  if (image.has_islands) {
    image.join_island_bands();
    build_island_pyramids(image, p.rows.scratch());
  }
  p.kept = read.depth;
  p.kept.data = image.kept.data();
  p.kept.stride_bytes = row_bytes(read.depth.format, width_px());
  time_s_ = frame.time_s;
  present_ = true;
  return true;
}

}  // namespace depthgrid::views
