// One camera's newest image, prepared for the search.
#pragma once

#include <cstdint>
#include <memory>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::views {

struct PreparedImage;

/// A prepared image. Buffers are allocated by the constructor; update() does not allocate. Written by one thread,
/// read by many once it is published.
class View {
 public:
  View(const RigCamera& camera, const CameraMargins& margins, const Policies& policies);
  ~View();
  View(View&&) noexcept;
  View& operator=(View&&) noexcept;
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  /// Takes a frame: normalises, lets shadow bands and small holes count as what may be there (shadow_rule.hpp,
  /// hole_rule.hpp), subtracts the margin, applies the robot and the minimum filter. False when the frame is unusable;
  /// then nothing is free.
  bool update(const Frame& frame, const Pose& T_world_camera) noexcept;
  /// Why update() finds a frame unusable (see core/usable_frame.hpp); null: it is usable.
  [[nodiscard]] const char* why_unusable(const Frame& frame) const noexcept;

  [[nodiscard]] int width_px() const noexcept;
  [[nodiscard]] int height_px() const noexcept;
  [[nodiscard]] bool present() const noexcept { return present_; }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  /// Differs between any two images, of this or of other views of the process; of what was prepared, not of its pixels.
  [[nodiscard]] std::uint64_t version() const noexcept { return version_; }
  /// Of the last frame, usable or not; where the rig says before the first.
  [[nodiscard]] const Pose& T_world_camera() const noexcept { return T_world_camera_; }
  /// How thick the layer around the robot is in which this image shows nothing: blind_layer_m(). 0 without robot.
  [[nodiscard]] double blind_m() const noexcept { return blind_m_; }

  /// Measured depth of a pixel of the image, 0 = no measurement, whatever a hole there counts as.
  [[nodiscard]] float measured_m(int u, int v) const noexcept;
  /// The same of a whole row, faster. `row_m` has to be at least as wide as the image.
  void measured_row(int v, DepthImage& row_m) const noexcept;
  /// Up to which depth from the blind zone on a pixel's frustum is free, the robot counted as free.
  [[nodiscard]] float free_m(int u, int v) const noexcept;

 private:
  friend const PreparedImage& prepared(const View& view) noexcept;
  struct Preparation;

  void clear() noexcept;

  std::unique_ptr<Preparation> preparation_;
  std::unique_ptr<PreparedImage> image_;
  Pose T_world_camera_;
  double time_s_ = 0;
  std::uint64_t version_ = 0;
  double blind_m_ = 0;
  bool present_ = false;
};

}  // namespace depthgrid::views
