#include "depthgrid/views/view.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <utility>

#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/rounding.hpp"
#include "depthgrid/core/usable_frame.hpp"
#include "depthgrid/views/hole_rule.hpp"
#include "depthgrid/views/image_preparation.hpp"
#include "depthgrid/views/prepared_image.hpp"
#include "depthgrid/views/pyramid_rows.hpp"
#include "depthgrid/views/reading.hpp"
#include "depthgrid/views/shadow_rule.hpp"

namespace depthgrid::views {
namespace {

std::uint64_t next_version() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

float pocket_m(const Policies& policies) noexcept {
  return policies.robot_pockets == Policy::ignored ? rounded_down(policies.ignored_pocket_m) : 0.0F;
}

std::unique_ptr<HoleRule> hole_rule(const RigCamera& camera, const CameraMargins& margins) {
  if (!(margins.smallest_obstacle_m > 0)) {
    return nullptr;
  }
  return std::make_unique<HoleRule>(camera.intrinsics, camera.metres_per_unit, camera.rule, margins.sensor,
                                    margins.smallest_obstacle_m);
}

std::unique_ptr<ShadowRule> shadow_rule(const RigCamera& camera, const CameraMargins& margins) {
  return margins.second_view_x_m == 0
             ? nullptr
             : std::make_unique<ShadowRule>(camera.intrinsics, camera.metres_per_unit, camera.rule, margins.sensor,
                                            margins.second_view_x_m);
}

/// The image as it came, without the padding of its rows.
void copy_rows(const DepthView& depth, std::byte* kept) noexcept {
  const std::ptrdiff_t bytes = row_bytes(depth.format, depth.width_px);
  for (int v = 0; v < depth.height_px; ++v) {
    std::memcpy(kept + bytes * v, static_cast<const std::byte*>(depth.data) + depth.stride_bytes * v,
                static_cast<std::size_t>(bytes));
  }
}

}  // namespace

/// What is known of the camera, and the scratch memory of update().
struct View::Preparation {
  Preparation(RigCamera camera_in, const CameraMargins& margins, const Policies& policies)
      : camera(std::move(camera_in)),
        reading(camera.rule, camera.metres_per_unit, margins.sensor),
        radius_px(margins.sensor.lateral_px),
        sensor(margins.sensor),
        pose{margins.translation_m, margins.rotation_rad, 0},
        pocket(pocket_m(policies)),
        blind_m(rounded_up(camera.rule.near_m)),
        shadows(shadow_rule(camera, margins)),
        holes(hole_rule(camera, margins)),
        rows(camera.intrinsics.width_px, camera.intrinsics.height_px, radius_px) {
    if (shadows && holes) {
      rims.reserve(static_cast<std::size_t>(camera.intrinsics.width_px) *
                   static_cast<std::size_t>(camera.intrinsics.height_px) / 4);
    }
  }

  RigCamera camera;
  Reading reading;
  int radius_px;
  SensorMargin sensor;
  PoseMargin pose;  ///< of the calibration alone
  float pocket;
  float blind_m;
  // Null: a pixel without reading frees nothing.
  std::unique_ptr<ShadowRule> shadows;
  std::unique_ptr<HoleRule> holes;
  std::vector<HoleBounds> rims;  ///< of bands, where small holes are looked at, too
  PreparationRows rows;
  DepthView kept;  ///< the newest image, in the buffer of that name
};

View::View(const RigCamera& camera, const CameraMargins& margins, const Policies& policies)
    : T_world_camera_(camera.T_world_camera), version_(next_version()) {
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

void View::measured_row(int v, DepthImage& row_m) const noexcept {
  if (!present_) {
    std::fill_n(row_m.data(), width_px(), 0.0F);
    return;
  }
  DepthView row = preparation_->kept;
  row.data = static_cast<const std::byte*>(row.data) + v * row.stride_bytes;
  row.height_px = 1;
  normalise(row, preparation_->camera.rule, row_m);
}

const char* View::why_unusable(const Frame& frame) const noexcept {
  return depthgrid::why_unusable(frame, preparation_->camera);
}

void View::clear() noexcept {
  present_ = false;
  blind_m_ = 0;
  time_s_ = std::numeric_limits<double>::quiet_NaN();
  image_->clear();
}

bool View::update(const Frame& frame, const Pose& T_world_camera) noexcept {
  version_ = next_version();
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
  // What a hole counts as frees space like a reading. It never is one: what is kept is the image as it came.
  const DepthView lit = p.shadows ? p.shadows->fill(read.depth, p.holes ? &p.rims : nullptr) : read.depth;
  const NewImage news{
      p.holes ? p.holes->fill(lit, p.rims) : lit, read.robot, read.depth, p.radius_px, p.pocket, p.blind_m};
  image.has_islands = !prepare(p.reading, news, p.rows, image).empty();
  if (image.has_islands) {
    image.join_island_bands();
    build_second_pyramids(p.blind_m, p.rows, image);
  }
  if (p.shadows || p.holes) {
    copy_rows(read.depth, image.kept.data());
  }
  const std::span<const Capsule> links = read.robot.links_world;
  const std::span<const Capsule> kept_links = links.first(std::min(links.size(), PreparedImage::kMostLinks));
  image.links_world.assign(kept_links.begin(), kept_links.end());
  image.within_margin = read.robot.within_margin;
  p.kept = read.depth;
  p.kept.data = image.kept.data();
  p.kept.stride_bytes = row_bytes(read.depth.format, width_px());
  time_s_ = frame.time_s;
  blind_m_ = blind_layer_m(read.robot, p.camera.intrinsics, p.sensor, p.pose);
  present_ = true;
  return true;
}

}  // namespace depthgrid::views
