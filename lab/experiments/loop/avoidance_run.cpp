#include "lab/experiments/loop/avoidance_run.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/avoidance/history_port.hpp"
#include "depthgrid/control/simulated_arm.hpp"
#include "depthgrid/core/error.hpp"
#include "lab/experiments/loop/contact_watch.hpp"
#include "lab/experiments/loop/motion_count.hpp"
#include "lab/experiments/stage/declared_rig.hpp"

namespace depthgrid::experiments {

namespace {

/// In simulated time nothing may fail: what follows a failure would be measured as if it were the method's.
void need(bool done, const char* what, double time_s) {
  if (!done) {
    fail("simulated run: ", what, " failed at ", time_s, " s");
  }
}

/// One run while it goes on.
Rig rig_of(Method method, const AvoidanceSettings& settings) {
  Rig rig = avoidance_rig(std::max(1, cameras_of(method)), settings.width_px, settings.sensor);
  return method == Method::search_memory ? with_declarations(std::move(rig)) : rig;
}

class Run {
 public:
  Run(Method method, const robot::RobotModel& model, const AvoidanceMotion& motion, const RunSettings& settings)
      : model_(model),
        settings_(settings),
        common_(settings_for(method, settings.common)),
        method_(method),
        rig_(rig_of(method, common_)),
        loop_settings_(loop_settings(method, model, common_)),
        hexagon_(hexagon(model, motion.hexagon_radius_m)),
        task_(hexagon_),
        history_(model.joints().size(), 256, 0.02, 0.0),
        evaluator_(make_evaluator(method, rig_, common_)),
        loop_({model}, task_, *evaluator_, loop_settings_),
        arm_(loop_settings_.controller.limits, common_.period_s, start_rad()),
        port_(arm_, history_),
        cell_(model, motion),
        images_(rig_, model, history_, cell_, *evaluator_, common_, settings.seed, settings.on_frame),
        contacts_(method, model, loop_, loop_settings_.parts, common_),
        motion_count_(common_.period_s, hexagon_.speed_m_s, common_.rho_m) {}

  RunResult result() {
    const auto periods = static_cast<std::int64_t>(std::llround(settings_.duration_s / common_.period_s));
    // The first images are there before the arm moves.
    place_at_rest();
    need(loop_.start(port_), "the loop's start", 0);
    for (std::int64_t k = 0; k < periods; ++k) {
      const double time_s = static_cast<double>(k) * common_.period_s;
      need(loop_.cycle(port_, time_s), "the loop's cycle", time_s);
      cell_.update(time_s, loop_.T_world_link());
      watch(k, time_s);
      expose(k, time_s);
      images_.deliver(time_s);
      arm_.advance();
    }
    result_.duration_s = settings_.duration_s;
    finish_task();
    return std::move(result_);
  }

 private:
  void place_at_rest() {
    if (cameras_of(method_) == 0) {
      return;
    }
    const control::JointVector q = start_rad();
    const std::span<const double> joints(q.data(), static_cast<std::size_t>(q.size()));
    std::vector<Pose> T_world_link(model_.links().size(), Pose::Identity());
    need(model_.link_poses(joints, Pose::Identity(), T_world_link), "the arm's pose", 0);
    need(history_.add(-common_.period_s, joints), "the first entry of the joint history", 0);
    cell_.update(0, T_world_link);
    images_.expose(-common_.period_s);
    images_.deliver(std::numeric_limits<double>::infinity());
  }

  void expose(std::int64_t k, double time_s) {
    const auto frame_at = [this](std::int64_t period) {
      return static_cast<std::int64_t>(
          std::floor(static_cast<double>(period) * common_.period_s * kFrameRate_hz + 1e-9));
    };
    if (k > 0 && frame_at(k) == frame_at(k - 1)) {
      return;
    }
    if (cameras_of(method_) > 0) {
      images_.expose(time_s);
    }
    if (settings_.on_instant) {
      settings_.on_instant({time_s, cell_.cell(), loop_, *evaluator_, task_.vertices_reached()});
    }
  }

  void watch(std::int64_t k, double time_s) {
    const Eigen::Vector3d tip = loop_.report().end_effector_world;
    const double speed_m_s = k > 0 ? (tip - tip_before_).norm() / common_.period_s : hexagon_.speed_m_s;
    tip_before_ = tip;
    const auto person = cell_.to_person();
    const auto object = cell_.to_objects();
    const double person_m = person ? person->distance_m : std::numeric_limits<double>::infinity();
    const double object_m = object ? object->distance_m : std::numeric_limits<double>::infinity();
    motion_count_.take(speed_m_s, person_m, object_m, result_.summary);
    if (person) {
      contacts_.take(time_s, *person, result_.summary);
    }
    if (settings_.sample_every > 0 && k % settings_.sample_every == 0) {
      const Eigen::Vector3d to_nearest = control::obstacle_of(loop_.answers()[0], control::BlindLayer::ignored)
                                             .direction_world.value_or(Eigen::Vector3d::Zero());
      RunSample sample{time_s,   joints_of_cycle(loop_, common_.period_s), tip,
                       person_m, loop_.report().output.repulsion_m_s,      to_nearest,
                       {}};
      for (const Answer& answer : loop_.answers()) {
        sample.told_m.push_back(
            std::min(common_.rho_m, control::obstacle_of(answer, control::BlindLayer::ignored).distance_m.value_or(0)));
      }
      result_.samples.push_back(std::move(sample));
    }
  }

  void finish_task() {
    const auto& vertices = hexagon_.vertices_world;
    const auto reached = static_cast<std::size_t>(task_.vertices_reached());
    result_.vertices = task_.vertices_reached();
    const double edge_m = (vertices[1] - vertices[0]).norm();
    const double left_m = (task_.next_vertex_world() - tip_before_).norm();
    result_.summary.task_share = static_cast<double>(reached) + std::clamp(1 - left_m / edge_m, 0.0, 1.0);
  }

  const robot::RobotModel& model_;
  const RunSettings& settings_;
  AvoidanceSettings common_;  ///< those of the method
  Method method_;
  Rig rig_;
  avoidance::LoopSettings loop_settings_;
  control::PolygonSettings hexagon_;
  control::PolygonTask task_;
  robot::JointHistory history_;
  std::unique_ptr<DistanceEvaluator> evaluator_;
  avoidance::AvoidanceLoop loop_;
  control::SimulatedArm arm_;
  avoidance::HistoryPort port_;
  AvoidanceCell cell_;
  ImageDelivery images_;
  ContactWatch contacts_;
  MotionCount motion_count_;
  RunResult result_;
  Eigen::Vector3d tip_before_ = Eigen::Vector3d::Zero();
};

}  // namespace

RunResult run_avoidance(Method method, const robot::RobotModel& model, const AvoidanceMotion& motion,
                        const RunSettings& settings) {
  return Run(method, model, motion, settings).result();
}

}  // namespace depthgrid::experiments
