#include "lab/experiments/campaign/campaign_motions.hpp"

#include "lab/measure/recording_folder.hpp"

namespace depthgrid::experiments {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kRecorded = "mocap ";

}  // namespace

bool is_recorded(std::string_view name) noexcept { return name.starts_with(kRecorded); }

fs::path mocap_folder() { return lab::recording_folder("mocap_cmu"); }

CampaignMotions::CampaignMotions(const Rig& rig, std::uint64_t seed, double duration_s, const fs::path& mocap)
    : rig_(rig), stage_(avoidance_stage(rig)), seed_(seed), duration_s_(duration_s) {
  std::error_code error;
  for (const char* name : {"02_01", "02_05", "02_06", "02_10"}) {
    const fs::path file = mocap / (std::string(name) + ".amc");
    if (fs::exists(file, error)) {
      clips_.push_back({name, simulation::MocapClip::load(mocap / "02.asf", file)});
    }
  }
}

AvoidanceMotion CampaignMotions::motion(int number) const {
  const auto scripts = simulation::motions();
  const std::size_t kinds = scripts.size() + (clips_.empty() ? 0 : 1);
  const std::size_t kind = static_cast<std::size_t>(number) % kinds;
  const std::size_t round = static_cast<std::size_t>(number) / kinds;
  // Another seed for a motion that meets a camera.
  constexpr std::uint64_t kOthers = 1000;
  for (std::uint64_t other = 0;; ++other) {
    const std::uint64_t seed = (seed_ * 1'000'000 + round) * kOthers + other;
    AvoidanceMotion motion =
        kind < scripts.size()
            ? scripted_motion(scripts[kind], stage_, seed)
            : recorded_motion(clips_[round % clips_.size()].clip,
                              std::string(kRecorded) + clips_[round % clips_.size()].name, stage_, seed);
    if (!meets_a_camera(motion, rig_) || other + 1 == kOthers) {
      return nearest_part(motion, stage_.robot_world, duration_s_);
    }
  }
}

}  // namespace depthgrid::experiments
