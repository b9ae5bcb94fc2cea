#include "depthgrid/robot/robot_removal.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/usable_frame.hpp"

namespace depthgrid::robot {

namespace {

std::array<float, 3> floats(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// More than single precision loses of a distance between a ray and an axis.
double rounding_m(const Capsule& capsule) {
  return 1e-5 + 4e-6 * std::max(capsule.a.lpNorm<1>(), capsule.b.lpNorm<1>());
}

RowCapsule row_capsule(const Capsule& capsule, double padded_radius_m) {
  const Eigen::Vector3d along = capsule.b - capsule.a;
  const double length_m = along.norm();
  const Eigen::Vector3d axis = length_m > 1e-9 ? Eigen::Vector3d(along / length_m) : Eigen::Vector3d::UnitX();
  const double a_along_m = axis.dot(capsule.a);
  RowCapsule result;
  result.a = floats(capsule.a);
  result.b = floats(capsule.b);
  result.axis = floats(axis);
  result.a_across = floats(capsule.a - a_along_m * axis);
  result.a_along = static_cast<float>(a_along_m);
  result.length = static_cast<float>(length_m);
  result.body_square = static_cast<float>(capsule.radius_m * capsule.radius_m);
  result.padded_square = static_cast<float>(padded_radius_m * padded_radius_m);
  return result;
}

/// One row of readings in metres, 0 where there is none. What is no number, or saturated, lies in no interval.
void read_row(const DepthView& view, int v, const PixelSpan& pixels, float* reading_m) noexcept {
  const auto* row = static_cast<const std::byte*>(view.data) + static_cast<std::ptrdiff_t>(v) * view.stride_bytes;
  const int end = std::min(pixels.end, view.width_px);
  if (view.format == DepthFormat::uint16_units) {
    const auto* units = reinterpret_cast<const std::uint16_t*>(row);
    for (int u = pixels.begin; u < end; ++u) {
      reading_m[u] = static_cast<float>(units[u] * view.metres_per_unit);
    }
  } else {
    std::copy_n(reinterpret_cast<const float*>(row) + pixels.begin, std::max(0, end - pixels.begin),
                reading_m + pixels.begin);
  }
}

}  // namespace

RobotRemoval::RobotRemoval(const PinholeCamera& camera, std::vector<LinkCapsule> capsules,
                           const RemovalSettings& settings)
    : camera_(camera), capsules_(std::move(capsules)), settings_(settings) {
  validate(camera_);
  if (capsules_.empty()) {
    fail("robot removal: there is no capsule");
  }
  for (const LinkCapsule& item : capsules_) {
    const Capsule& c = item.capsule;
    if (!(c.a.allFinite() && c.b.allFinite() && std::isfinite(c.radius_m) && c.radius_m > 0)) {
      fail("robot removal: a capsule goes from (", c.a.transpose(), ") to (", c.b.transpose(), ") with radius ",
           c.radius_m, " m; all must be finite and the radius positive");
    }
  }
  if (!(std::isfinite(settings_.padding_m) && settings_.padding_m >= 0)) {
    fail("robot removal: the padding is ", settings_.padding_m, " m, must be finite and not negative");
  }
  half_pixel_ = settings_.whole_pixels ? half_pixel(camera_) : 0.0;
  stride_px_ = (camera_.width_px + kLanes - 1) / kLanes * kLanes;
  const auto columns = static_cast<std::size_t>(stride_px_);
  const auto height = static_cast<std::size_t>(camera_.height_px);
  near_m_.assign(columns * height, 0.0F);
  far_m_.assign(columns * height, 0.0F);
  written_.resize(height);
  x_ray_.resize(columns);
  for (std::size_t u = 0; u < columns; ++u) {
    x_ray_[u] = static_cast<float>((static_cast<double>(u) + 0.5 - camera_.cx_px) / camera_.fx_px);
  }
  reading_m_.assign(columns, 0.0F);
  scratch_.resize(2 * static_cast<std::size_t>(kLanes) * capsules_.size());
  spans_.resize(height * capsules_.size());
  rows_.resize(capsules_.size());
  in_camera_.resize(capsules_.size());
  links_world_.reserve(capsules_.size());
  row_capsules_.resize(capsules_.size());
  row_spans_.resize(capsules_.size());
}

/// Brings the capsules into the camera's frame and finds their pixels. False when a number is not finite.
bool RobotRemoval::take(std::span<const Pose> T_world_link, const Pose& T_world_camera,
                        std::span<const double> motion_m) noexcept {
  const Pose T_camera_world = T_world_camera.inverse(Eigen::Isometry);
  const auto height = static_cast<std::size_t>(camera_.height_px);
  blind_m_ = 0;
  reach_m_ = 0;
  links_world_.clear();
  for (std::size_t i = 0; i < capsules_.size(); ++i) {
    const LinkCapsule& item = capsules_[i];
    if (item.link >= T_world_link.size()) {
      return false;
    }
    const Pose T_camera_link = T_camera_world * T_world_link[item.link];
    const Capsule capsule{T_camera_link * item.capsule.a, T_camera_link * item.capsule.b, item.capsule.radius_m};
    const double grown_m = settings_.padding_m + (motion_m.empty() ? 0.0 : motion_m[i]);
    double padded_m = capsule.radius_m + grown_m;
    // What a pixel shows is as deep as a point of its centre ray that is half a diagonal away or less.
    const double farthest_m = std::max(capsule.a.z(), capsule.b.z()) + padded_m;
    padded_m += half_pixel_ * std::max(farthest_m, 0.0);
    padded_m += rounding_m(capsule);
    if (!capsule.a.allFinite() || !capsule.b.allFinite() || !std::isfinite(padded_m) || padded_m < capsule.radius_m) {
      return false;
    }
    in_camera_[i] = row_capsule(capsule, padded_m);
    const std::span<PixelSpan> spans(spans_.data() + i * height, height);
    std::fill(spans.begin(), spans.end(), PixelSpan{});
    rows_[i] = widen(camera_, {capsule.a, capsule.b, padded_m}, spans);
    if (rows_[i].begin < rows_[i].end) {
      const Pose& T = T_world_link[item.link];
      links_world_.push_back({T * item.capsule.a, T * item.capsule.b, capsule.radius_m + grown_m});
      const double deepest_m = std::max(capsule.a.z(), capsule.b.z()) + padded_m;
      blind_m_ = std::max(blind_m_, padded_m - capsule.radius_m + half_pixel(camera_) * std::max(deepest_m, 0.0));
      reach_m_ = std::max(reach_m_, std::max(capsule.a.norm(), capsule.b.norm()) + padded_m);
    }
  }
  return true;
}

void RobotRemoval::write(int v, const DepthView* reading) noexcept {
  const auto height = static_cast<std::size_t>(camera_.height_px);
  RobotRow row;
  PixelSpan all{stride_px_, 0};
  for (std::size_t i = 0; i < capsules_.size(); ++i) {
    const PixelSpan span = spans_[i * height + static_cast<std::size_t>(v)];
    if (v >= rows_[i].begin && v < rows_[i].end && !span.empty()) {
      row_capsules_[row.count] = in_camera_[i];
      row_spans_[row.count] = span;
      ++row.count;
      all = {std::min(all.begin, span.begin), std::max(all.end, span.end)};
    }
  }
  const std::size_t start = static_cast<std::size_t>(v) * static_cast<std::size_t>(stride_px_);
  PixelSpan& written = written_[static_cast<std::size_t>(v)];
  if (!written.empty()) {
    std::fill_n(near_m_.begin() + static_cast<std::ptrdiff_t>(start) + written.begin, written.end - written.begin,
                0.0F);
    std::fill_n(far_m_.begin() + static_cast<std::ptrdiff_t>(start) + written.begin, written.end - written.begin, 0.0F);
  }
  written = {};
  if (row.count == 0) {
    return;
  }
  written = {all.begin / kLanes * kLanes, std::min((all.end + kLanes - 1) / kLanes * kLanes, stride_px_)};
  row.capsules = row_capsules_.data();
  row.spans = row_spans_.data();
  row.x_ray = x_ray_.data();
  row.y_ray = static_cast<float>((v + 0.5 - camera_.cy_px) / camera_.fy_px);
  if (reading != nullptr) {
    read_row(*reading, v, written, reading_m_.data());
    row.reading_m = reading_m_.data();
  }
  row.pixels = written;
  row.near_m = near_m_.data() + start;
  row.far_m = far_m_.data() + start;
  row.scratch = scratch_.data();
  robot_row(row);
}

RobotView RobotRemoval::find(std::span<const Pose> T_world_link, const Pose& T_world_camera,
                             std::span<const double> motion_m, const DepthView* reading) noexcept {
  if ((!motion_m.empty() && motion_m.size() != capsules_.size()) || !take(T_world_link, T_world_camera, motion_m)) {
    return {};
  }
  const bool readable = reading != nullptr && why_unusable(*reading, camera_) == nullptr;
  const DepthView image = readable ? with_stride(*reading) : DepthView{};
  for (int v = 0; v < camera_.height_px; ++v) {
    write(v, readable ? &image : nullptr);
  }
  return {near_m_.data(), far_m_.data(), stride_px_, blind_m_, reach_m_, settings_.margin_in_test, links_world_};
}

}  // namespace depthgrid::robot
