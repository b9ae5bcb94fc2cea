#include "lab/experiments/stage/method_comparison.hpp"

#include <algorithm>
#include <utility>

#include "depthgrid/core/error.hpp"

namespace depthgrid::experiments {

std::size_t points_behind_person(const StagedCell& stage, const Eigen::Vector3d& camera_world) {
  const simulation::WorkcellBody& person = stage.cell().bodies[stage.person_body()];
  const auto hidden = [&](const Eigen::Vector3d& p_world) {
    return std::any_of(person.capsules.begin(), person.capsules.end(), [&](const Capsule& part) {
      const simulation::Interval inside = simulation::intersect(part, {camera_world, p_world - camera_world});
      return !inside.empty() && inside.exit > 0 && inside.entry < 1;
    });
  };
  const auto points_world = stage.arm().points_world();
  return static_cast<std::size_t>(std::count_if(points_world.begin(), points_world.end(), hidden));
}

MethodComparison::MethodComparison(const StagedCell& stage, const Rig& rig, const simulation::Arrangement& arrangement,
                                   std::vector<Candidate> candidates, const simulation::SensorGroupSettings& noise)
    : candidates_(std::move(candidates)),
      point_truth_(stage.cell(), stage.arm().points_world().size()),
      cell_truth_(stage.cell()) {
  for (const Candidate& candidate : candidates_) {
    Rig used = rig;
    used.cameras.clear();
    for (const std::size_t camera : candidate.cameras) {
      if (camera >= rig.cameras.size()) {
        fail("comparison with camera ", camera, " of a rig of ", rig.cameras.size());
      }
      used.cameras.push_back(rig.cameras[camera]);
    }
    methods_.emplace_back(candidate.method, used, arrangement);
    if (images_.find(candidate.robot) == images_.end()) {
      images_.emplace(candidate.robot, CameraImages(rig, stage, candidate.robot, noise));
    }
  }
}

bool MethodComparison::remembers() const noexcept {
  return std::any_of(candidates_.begin(), candidates_.end(),
                     [](const Candidate& candidate) { return candidate.method == EvaluationMethod::search_memory; });
}

void MethodComparison::update(std::size_t candidate) {
  const auto all = images_.at(candidates_[candidate].robot).frames();
  frames_.clear();
  for (const std::size_t camera : candidates_[candidate].cameras) {
    frames_.push_back(all[camera]);
  }
  methods_[candidate].update(frames_);
}

void MethodComparison::pass(const StagedCell& stage, double time_s, std::uint64_t frame) {
  std::vector<RobotPixels> taken;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    if (candidate.method != EvaluationMethod::search_memory) {
      continue;
    }
    if (std::find(taken.begin(), taken.end(), candidate.robot) == taken.end()) {
      images_.at(candidate.robot).take(stage, frame, time_s);
      taken.push_back(candidate.robot);
    }
    update(i);
  }
}

void MethodComparison::retake(const StagedCell& stage, const Instant& instant) {
  for (auto& [robot, images] : images_) {
    images.take(stage, instant.frame, instant.time_s);
  }
}

Instant MethodComparison::at(const StagedCell& stage, double time_s, std::uint64_t frame) {
  Instant instant;
  instant.time_s = time_s;
  instant.frame = frame;
  instant.points_world.assign(stage.arm().points_world().begin(), stage.arm().points_world().end());
  instant.truth = point_truth_.distances(stage.cell(), instant.points_world);
  cell_truth_.update(stage.cell());
  instant.person_to_arm_m = cell_truth_.between(stage.arm_body(), stage.person_body())->distance_m;
  instant.points_behind_person =
      points_behind_person(stage, images_.begin()->second.rig().cameras.front().T_world_camera.translation());
  for (auto& [robot, images] : images_) {
    images.take(stage, frame, time_s);
  }
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    update(i);
    methods_[i].evaluate(instant.points_world, instant.answers.emplace_back(instant.points_world.size()));
  }
  return instant;
}

}  // namespace depthgrid::experiments
