#include "world/play.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "world/judge.hpp"
#include "world/random.hpp"
#include "world/sensor.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

/// How deep the capsule lies in W; negative outside.
double to_border_m(const views::BoxSpace& box, const Capsule& capsule) {
  const auto inside_m = [&box](const Vector3d& p) {
    return std::min((p - box.low_world).minCoeff(), (box.high_world - p).minCoeff());
  };
  return std::min(inside_m(capsule.a), inside_m(capsule.b)) - capsule.radius_m;
}

search::EvaluatorOptions with_memory(const World& world) {
  search::EvaluatorOptions options;
  options.memory = world.memory;
  return options;
}

std::vector<std::string> kinds_of(const World& world) {
  std::vector<std::string> kinds{
      "all", std::to_string(world.cameras.size()) + (world.cameras.size() == 1 ? " camera" : " cameras")};
  const auto add_if = [&kinds](bool so, const char* kind) {
    if (so) {
      kinds.emplace_back(kind);
    }
  };
  const auto any_camera = [&world](auto&& holds) {
    return std::any_of(world.cameras.begin(), world.cameras.end(), holds);
  };
  add_if(!world.robot.empty(), "a robot");
  add_if(!world.robot.empty() && world.margin_in_test, "margins in the robot's test");
  add_if(world.settings.v_max_m_s == 0, "nothing moves");
  add_if(world.settings.v_max_m_s > 0, "things move");
  add_if(std::any_of(world.solids.begin(), world.solids.end(), [](const Solid& solid) { return solid.black; }),
         "things without readings");
  add_if(any_camera([](const TrueCamera& c) { return c.noise.constant_m + c.noise.quadratic_per_m > 0; }), "noise");
  add_if(world.memory && world.memory->thinnest_hidden_m > 0, "hidden things not thin");
  add_if(world.memory && std::holds_alternative<memory::StartEmptyAroundRobot>(world.memory->start),
         "empty around the robot");
  add_if(world.memory && std::holds_alternative<memory::StartEmpty>(world.memory->start), "empty region");
  add_if(world.release.has_value(), "something let go");
  add_if(any_camera([](const TrueCamera& c) { return c.moves; }), "cameras that move");
  add_if(any_camera([](const TrueCamera& c) { return c.lone_holes > 0 || c.round_holes > 0; }), "holes");
  return kinds;
}

/// One world on its way.
class Player {
 public:
  Player(const World& world, const std::function<void(Answer&)>& spoil)
      : world_(world),
        spoil_(spoil),
        evaluator_(world.rig, world.settings, with_memory(world)),
        random_(world.options.seed, 6) {
    const std::vector<Capsule> links = robot_at(world, 0);
    std::vector<robot::LinkCapsule> capsules;
    capsules.reserve(links.size());
    for (std::size_t i = 0; i < links.size(); ++i) {
      const double length_m = (links[i].b - links[i].a).norm();
      capsules.push_back({i, {Vector3d::Zero(), length_m * Vector3d::UnitZ(), links[i].radius_m}});
    }
    sensors_.reserve(world.cameras.size());
    removals_.reserve(world.cameras.size());
    for (std::size_t k = 0; k < world.cameras.size(); ++k) {
      sensors_.emplace_back(world, k);
      if (!capsules.empty()) {
        removals_.emplace_back(world.rig.cameras[k].intrinsics, capsules,
                               robot::RemovalSettings{world.robot_padding_m, true, world.margin_in_test});
      }
    }
    looks_.resize(world.memory ? 0 : world.cameras.size());
    stamps_s_.resize(world.cameras.size(), std::numeric_limits<double>::quiet_NaN());
  }

  void run() {
    int until_asked = random_.integer(1, 4);
    for (const Exposure& exposure : world_.exposures) {
      say_release(exposure.arrival_s);
      show(exposure);
      if (--until_asked == 0) {
        ask(exposure.arrival_s + random_.uniform(0, 0.03));
        until_asked = random_.integer(2, 5);
      }
    }
    counts.worlds = 1;
    counts.noticed = evaluator_.memory() != nullptr ? evaluator_.memory()->count().impossible : 0;
    counts.worlds_above = counts.above + counts.above_now > 0 ? 1 : 0;
    counts.worlds_noticed = counts.noticed > 0 ? 1 : 0;
  }

  Counts counts;
  std::vector<std::string> lines;

 private:
  /// Before an image or an answer can know of it.
  void say_release(double arrival_s) {
    if (!world_.release || said_ || arrival_s < world_.release->said_s) {
      return;
    }
    const std::array<Capsule, 1> at_world{world_.release->at_world};
    if (!evaluator_.memory()->occupy(at_world, world_.release->distance_m, world_.release->time_s)) {
      fail("the memory was not told what was let go");
    }
    said_ = true;
  }

  void show(const Exposure& exposure) {
    const std::size_t k = exposure.camera;
    const CameraMargins& margins = world_.settings.margins[k];
    const Pose T_world_camera = stated_pose(world_, exposure);
    Frame frame{sensors_[k].take(exposure), {}, exposure.stamp_s};
    const std::vector<Capsule> robot = robot_at(world_, exposure.stamp_s);
    if (!robot.empty()) {
      std::vector<Pose> T_world_link;
      T_world_link.reserve(robot.size());
      for (const Capsule& link : robot) {
        Pose& pose = T_world_link.emplace_back(Pose::Identity());
        pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), link.b - link.a).toRotationMatrix();
        pose.translation() = link.a;
      }
      const std::vector<double> motion_m(
          robot.size(), world_.robot_speed_m_s * (margins.half_exposure_s + margins.time_uncertainty_s));
      frame.robot = removals_[k].find(T_world_link, T_world_camera, motion_m, &frame.depth);
    }
    (void)evaluator_.update(k, frame, T_world_camera);
    stamps_s_[k] = exposure.stamp_s;
    Look look{exposure.mid_s - margins.half_exposure_s, exposure.mid_s + margins.half_exposure_s, robot,
              evaluator_.memory() != nullptr ? evaluator_.store().snapshot().blind_m() : 0.0};
    if (world_.margin_in_test) {
      look.sight = Sight{T_world_camera.translation(), T_world_camera.linear().col(2), margins.sensor};
    }
    // A memory answers from all images that there were.
    if (evaluator_.memory() != nullptr) {
      looks_.push_back(look);
    } else {
      looks_[k] = look;
    }
  }

  [[nodiscard]] Capsule random_query(double time_s) {
    const std::vector<Capsule> robot = robot_at(world_, time_s);
    const double kind = random_.uniform(0, 1);
    if (!robot.empty() && kind < 0.2) {
      Capsule link = robot[static_cast<std::size_t>(random_.integer(0, static_cast<int>(robot.size()) - 1))];
      link.radius_m += random_.chance(0.5) ? 0.0 : random_.uniform(0, 0.05);
      return link;
    }
    Vector3d at = random_.in_box(world_.box().low_world, world_.box().high_world);
    if (!world_.solids.empty() && kind < 0.85) {
      const Capsule thing =
          world_.solids[static_cast<std::size_t>(random_.integer(0, static_cast<int>(world_.solids.size()) - 1))].at(
              time_s);
      at = thing.a + random_.uniform(0, 1) * (thing.b - thing.a);
      // Beside it, or most often before it, where a camera has seen free.
      const auto camera = static_cast<std::size_t>(random_.integer(0, static_cast<int>(world_.cameras.size()) - 1));
      const Vector3d to_camera = world_.rig.cameras[camera].T_world_camera.translation() - at;
      const Vector3d towards = random_.chance(0.7)
                                   ? Vector3d(to_camera.normalized() + 0.3 * random_.direction()).normalized()
                                   : random_.direction();
      at += (thing.radius_m + random_.uniform(0, 0.6)) * towards;
      at = at.cwiseMax(world_.box().low_world).cwiseMin(world_.box().high_world);
    }
    Vector3d other = at;
    if (random_.chance(0.4)) {
      other = (at + random_.uniform(0, 0.3) * random_.direction())
                  .cwiseMax(world_.box().low_world)
                  .cwiseMin(world_.box().high_world);
    }
    return {at, other, random_.chance(0.4) ? 0.0 : random_.uniform(0, 0.08)};
  }

  void ask(double now_s) {
    double reference_s = -std::numeric_limits<double>::infinity();
    for (const double stamp_s : stamps_s_) {
      reference_s = std::isnan(stamp_s) ? reference_s : std::max(reference_s, stamp_s);
    }
    now_s = std::max(now_s, reference_s);
    std::vector<Capsule> asked;
    asked.reserve(kAsked);
    for (int i = 0; i < kAsked; ++i) {
      asked.push_back(random_query(reference_s));
    }
    std::vector<Answer> answers(asked.size());
    evaluator_.evaluate(asked, now_s, answers);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (spoil_) {
        spoil_(answers[i]);
      }
      count(asked[i], answers[i], reference_s, now_s);
    }
  }

  void count(const Capsule& asked, const Answer& answer, double reference_s, double now_s) {
    ++counts.answers;
    const Verdict verdict = found(asked, answer.nearest.distance_m, reference_s, answer, counts.above, "");
    if (std::isfinite(answer.distance_now_m)) {
      ++counts.answers_now;
      (void)found(asked, answer.distance_now_m, now_s, answer, counts.above_now, " now");
    }
    const double rho_m = world_.settings.rho_m;
    const double truth_m = std::min(verdict.truth_m, to_border_m(world_.box(), asked));
    if (truth_m >= rho_m) {
      ++counts.far_true;
      counts.far_said += answer.nearest.state == ProximityState::beyond_rho ? 1 : 0;
    } else if (truth_m > 0) {
      const double ratio = std::clamp(answer.nearest.distance_m / truth_m, 0.0, 1.0);
      ++counts.ratios.at(static_cast<std::size_t>(ratio * (Counts::kRatios - 1)));
    }
  }

  Verdict found(const Capsule& asked, double answer_m, double time_s, const Answer& answer, std::int64_t& above,
                const char* when) {
    const Verdict verdict = judge(world_, asked, answer_m, time_s, answer.blind_m, looks_);
    counts.in_layer += verdict.in_layer ? 1 : 0;
    if (verdict.excess_m) {
      ++above;
      counts.largest_excess_m = std::max(counts.largest_excess_m, *verdict.excess_m);
      std::ostringstream line;
      line.precision(9);
      line << command_of(world_.options) << ": answer" << when << " " << answer_m << " m, too far by "
           << *verdict.excess_m << " m, at " << time_s << " s for [" << asked.a.transpose() << "] to ["
           << asked.b.transpose() << "] radius " << asked.radius_m << ", " << to_string(answer.nearest.state)
           << ", blind " << answer.blind_m;
      lines.push_back(line.str());
    }
    return verdict;
  }

  const World& world_;
  const std::function<void(Answer&)>& spoil_;
  search::SearchEvaluator evaluator_;
  Random random_;
  std::vector<Sensor> sensors_;
  std::vector<robot::RobotRemoval> removals_;
  std::vector<Look> looks_;       ///< of each camera's newest image
  std::vector<double> stamps_s_;  ///< likewise
  bool said_ = false;             ///< what is let go
};

}  // namespace

void play(const World& world, Tally& tally, const std::function<void(Answer&)>& spoil) {
  Player player(world, spoil);
  player.run();
  for (const std::string& kind : kinds_of(world)) {
    tally.rows[kind] += player.counts;
  }
  for (const std::string& line : player.lines) {
    tally.note(line);
  }
}

}  // namespace depthgrid::world
