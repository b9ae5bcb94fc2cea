#include "lab/experiments/real_sensors/scene_play.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "depthgrid/robot/robot_parts.hpp"
#include "lab/experiments/stage/camera_images.hpp"
#include "lab/experiments/stage/deviation.hpp"
#include "lab/experiments/stage/distance_method.hpp"
#include "lab/experiments/stage/point_truth.hpp"
#include "lab/experiments/stage/rig_width.hpp"

namespace depthgrid::experiments {

namespace {

constexpr double kSceneRate_hz = 30;
constexpr int kAskEvery = 3;       ///< images
constexpr double kFilling_s = 1;   ///< before anything is asked
constexpr double kClear_m = 0.10;  ///< of a link
constexpr double kAway_m = 0.5;    ///< of the person, where links are asked to be clear
constexpr double kBeyond_m = DistanceMethod::kRho - 1e-6;
constexpr std::size_t kHandPoint = 4;  ///< the control point behind which the hand comes

simulation::PersonStage stage_of(Scene scene, const Rig& rig) {
  if (scene != Scene::hand_behind) {
    return stage_around_the_wrist();
  }
  simulation::PersonStage stage;
  stage.robot_world = ArmAtWork().points_world()[kHandPoint];
  stage.camera_world = rig.cameras.front().T_world_camera.translation();
  return stage;
}

/// A play while it goes on.
class Played {
 public:
  explicit Played(const ScenePlay& play)
      : play_(play),
        arrangement_(simulation::arrangement(play.cameras, play.sensor)),
        rig_(with_width(arrangement_.rig, play.width_px)),
        stage_(play.scene == Scene::hand_behind ? simulation::Motion::hand_behind_robot : simulation::Motion::reach,
               stage_of(play.scene, rig_), play.seed),
        links_(robot::moving_capsules(stage_.arm().model())) {
    if (play.scene == Scene::nobody) {
      stage_.send_person_away();
    }
    images_.emplace(rig_, stage_, play.declared ? RobotPixels::thin_layer : RobotPixels::behind_unknown,
                    simulation::SensorGroupSettings{.seed = play.seed});
    method_.emplace(play.declared ? EvaluationMethod::search_memory : EvaluationMethod::search, rig_, arrangement_);
    points_truth_.emplace(stage_.cell(), stage_.arm().points_world().size());
    cell_truth_.emplace(stage_.cell());
  }

  SceneFigures figures() {
    const double duration_s = play_.scene == Scene::nobody ? play_.duration_s : stage_.person().duration_s();
    const auto filling = static_cast<int>(kFilling_s * kSceneRate_hz);
    std::uint64_t frame = 0;
    for (int image = -filling; image < duration_s * kSceneRate_hz; ++image) {
      const double time_s = image / kSceneRate_hz;
      move_to(time_s);
      const bool asked = image >= 0 && image % kAskEvery == 0;
      if (!asked && !play_.declared) {
        continue;  // nothing is remembered
      }
      images_->take(stage_, frame++, time_s);
      method_->update(images_->frames());
      if (asked) {
        ask();
      }
    }
    return {deviation_.false_obstacles(), share(said_beyond_, truly_beyond_),  share(clear_, away_),
            deviation_.shortfall_m(0.5),  deviation_.largest_overestimate_m(), deviation_.compared()};
  }

 private:
  static double share(std::size_t part, std::size_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole)
                     : std::numeric_limits<double>::quiet_NaN();
  }

  void move_to(double time_s) {
    if (play_.scene == Scene::hand_behind) {
      stage_.move_person_to(time_s);
    } else {
      stage_.move_to(time_s);
    }
  }

  void ask() {
    cell_truth_->update(stage_.cell());
    const double person_m = cell_truth_->between(stage_.arm_body(), stage_.person_body())->distance_m;
    const auto points_world = stage_.arm().points_world();
    const std::vector<PointTruth::Nearest> truth = points_truth_->distances(stage_.cell(), points_world);
    std::vector<Proximity> answers(points_world.size());
    method_->evaluate(points_world, answers);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (person_m <= images_->padding_m() + kPixels_m) {  // what is in the layer no method can see
        deviation_.leave_out();
        continue;
      }
      deviation_.add(answers[i], truth[i].distance_m);
      if (truth[i].distance_m > DistanceMethod::kRho) {
        ++truly_beyond_;
        said_beyond_ += has_distance(answers[i]) && answers[i].distance_m >= kBeyond_m ? 1 : 0;
      }
    }
    if (person_m > kAway_m) {
      ++away_;
      clear_ += every_link_clear() ? 1 : 0;
    }
  }

  [[nodiscard]] bool every_link_clear() {
    std::vector<Capsule> links_world(links_.size());
    robot::place(links_, stage_.arm().T_world_link(), links_world);
    std::vector<Answer> answers(links_.size());
    method_->evaluate(std::span<const Capsule>(links_world), answers);
    return std::all_of(answers.begin(), answers.end(), [](const Answer& answer) {
      return has_distance(answer.nearest) && answer.nearest.distance_m >= kClear_m;
    });
  }

  static constexpr double kPixels_m = 0.02;  ///< what pixels add to a layer at 2.5 m

  const ScenePlay& play_;
  simulation::Arrangement arrangement_;
  Rig rig_;
  StagedCell stage_;
  std::vector<robot::LinkCapsule> links_;
  std::optional<CameraImages> images_;
  std::optional<DistanceMethod> method_;
  std::optional<PointTruth> points_truth_;
  std::optional<workcell::CellTruth> cell_truth_;
  Deviation deviation_{DistanceMethod::kRho};
  std::size_t truly_beyond_ = 0;
  std::size_t said_beyond_ = 0;
  std::size_t away_ = 0;
  std::size_t clear_ = 0;
};

}  // namespace

std::string_view to_string(Scene scene) noexcept {
  switch (scene) {
    case Scene::nobody:
      return "nobody";
    case Scene::reach:
      return "a person reaches";
    case Scene::hand_behind:
      return "a hand behind the arm";
  }
  return "";
}

SceneFigures play(const ScenePlay& scene) { return Played(scene).figures(); }

}  // namespace depthgrid::experiments
