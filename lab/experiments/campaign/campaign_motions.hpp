// The random motions of the campaign, by number.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "lab/experiments/loop/avoidance_motion.hpp"

namespace depthgrid::experiments {

/// A list of motions without end: each script in turn, and, where the recordings are there, a recorded one after them.
/// Motions that meet a camera are left out. Const members may be called from many threads at once.
class CampaignMotions {
 public:
  /// `mocap`: folder with 02.asf and its clips; without the files there are scripts only. Throws Error when a file is
  /// there and broken.
  CampaignMotions(const Rig& rig, std::uint64_t seed, double duration_s, const std::filesystem::path& mocap);

  [[nodiscard]] AvoidanceMotion motion(int number) const;
  [[nodiscard]] bool has_recordings() const noexcept { return !clips_.empty(); }

 private:
  struct Clip {
    std::string name;
    simulation::MocapClip clip;
  };
  Rig rig_;
  simulation::PersonStage stage_;
  std::uint64_t seed_;
  double duration_s_;
  std::vector<Clip> clips_;
};

/// Whether a motion of this name is a recorded one.
[[nodiscard]] bool is_recorded(std::string_view name) noexcept;

/// DEPTHGRID_DATA or ../shared/data, and mocap_cmu in it.
[[nodiscard]] std::filesystem::path mocap_folder();

}  // namespace depthgrid::experiments
