#include "depthgrid/simulation/mocap_clip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/whole_file.hpp"

namespace depthgrid::simulation {

namespace {

constexpr std::uint64_t kLargestText = std::uint64_t{256} << 20U;  // an hour at 120 frames a second

/// Radius by a part of the bone's name; the first that fits.
double radius_m(const std::string& bone) {
  struct Entry {
    const char* part;
    double radius_m;
  };
  static constexpr std::array<Entry, 16> kRadii{{{"hipjoint", 0.10},
                                                 {"femur", 0.085},
                                                 {"tibia", 0.06},
                                                 {"foot", 0.045},
                                                 {"toes", 0.04},
                                                 {"lowerback", 0.13},
                                                 {"upperback", 0.14},
                                                 {"thorax", 0.14},
                                                 {"neck", 0.06},
                                                 {"head", 0.10},
                                                 {"clavicle", 0.07},
                                                 {"humerus", 0.055},
                                                 {"radius", 0.045},
                                                 {"wrist", 0.04},
                                                 {"hand", 0.04},
                                                 {"finger", 0.03}}};
  for (const Entry& entry : kRadii) {
    if (bone.find(entry.part) != std::string::npos) {
      return entry.radius_m;
    }
  }
  return 0.02;  // thumbs
}

Eigen::Vector3d z_up(const Eigen::Vector3d& y_up) { return {y_up.x(), -y_up.z(), y_up.y()}; }

}  // namespace

MocapClip::MocapClip(const MocapSkeleton& skeleton, const std::vector<MocapFrame>& frames, double rate_hz)
    : rate_hz_(rate_hz) {
  if (!(std::isfinite(rate_hz) && rate_hz > 0)) {
    fail("rate of a recorded motion is ", rate_hz, " Hz, must be a positive finite number");
  }
  if (frames.empty()) {
    fail("a recorded motion must have a frame");
  }
  for (const MocapFrame& frame : frames) {
    if (frame.turn_rad.size() != skeleton.bones.size()) {
      fail("frame ", frames_.size(), " turns ", frame.turn_rad.size(), " bones, the skeleton has ",
           skeleton.bones.size());
    }
    const MocapJoints at = joints(skeleton, frame);
    std::vector<Capsule>& body = frames_.emplace_back();
    for (std::size_t i = 0; i < skeleton.bones.size(); ++i) {
      body.push_back({z_up(at.start_m[i]), z_up(at.end_m[i]), radius_m(skeleton.bones[i].name)});
    }
    if (frames_.size() > 1) {
      const std::vector<Capsule>& before = frames_[frames_.size() - 2];
      for (std::size_t i = 0; i < body.size(); ++i) {
        const double moved_m = std::max((body[i].a - before[i].a).norm(), (body[i].b - before[i].b).norm());
        v_max_m_s_ = std::max(v_max_m_s_, moved_m * rate_hz);
      }
    }
  }
}

MocapClip MocapClip::load(const std::filesystem::path& asf, const std::filesystem::path& amc, double rate_hz) {
  const MocapSkeleton skeleton = parse_asf(read_whole_file(asf, kLargestText), asf.string());
  return {skeleton, parse_amc(read_whole_file(amc, kLargestText), skeleton, amc.string()), rate_hz};
}

double MocapClip::duration_s() const noexcept { return static_cast<double>(frames_.size() - 1) / rate_hz_; }

std::vector<Capsule> MocapClip::at(double time_s, const Pose& T_world_floor) const {
  const double position = std::clamp(time_s, 0.0, duration_s()) * rate_hz_;
  const std::size_t first = std::min(static_cast<std::size_t>(position), frames_.size() - 1);
  const std::size_t second = std::min(first + 1, frames_.size() - 1);
  const double share = position - static_cast<double>(first);
  std::vector<Capsule> body = frames_[first];
  for (std::size_t i = 0; i < body.size(); ++i) {
    const Capsule& next = frames_[second][i];
    body[i].a = T_world_floor * (body[i].a + share * (next.a - body[i].a));
    body[i].b = T_world_floor * (body[i].b + share * (next.b - body[i].b));
  }
  return body;
}

Eigen::Vector3d MocapClip::middle_m() const noexcept {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const std::vector<Capsule>& body : frames_) {
    low = low.cwiseMin(body.front().a);
    high = high.cwiseMax(body.front().a);
  }
  Eigen::Vector3d middle = 0.5 * (low + high);
  middle.z() = 0;
  return middle;
}

}  // namespace depthgrid::simulation
