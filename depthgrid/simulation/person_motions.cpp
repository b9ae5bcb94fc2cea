#include "depthgrid/simulation/person_motions.hpp"

#include <cmath>
#include <numbers>

#include "depthgrid/simulation/pixel_random.hpp"

namespace depthgrid::simulation {

namespace {

constexpr std::size_t kLeft = 0;
constexpr std::size_t kRight = 1;

/// Numbers of a plan, one after the other.
class Dice {
 public:
  Dice(std::uint64_t seed, Motion motion) : random_(seed, static_cast<std::uint64_t>(motion), 0) {}
  double uniform(double lower, double upper) { return lower + (upper - lower) * random_.uniform(next_++); }
  double sign() { return uniform(-1, 1) < 0 ? -1 : 1; }

 private:
  PixelRandom random_;
  std::uint64_t next_ = 0;
};

Eigen::Vector2d direction(double azimuth_rad) { return {std::cos(azimuth_rad), std::sin(azimuth_rad)}; }

double azimuth(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

/// Builds the keys of a plan.
class Choreography {
 public:
  Choreography(const PersonStage& stage, const ArmDirections& left, const ArmDirections& right) : stage_(stage) {
    now_.floor_m = stage.floor_m;
    now_.arms = {left, right};
  }

  [[nodiscard]] Eigen::Vector2d robot() const { return stage_.robot_world.head<2>(); }
  [[nodiscard]] const PersonConfiguration& now() const { return now_; }

  /// Stands here and looks there from the beginning.
  void enter(const Eigen::Vector2d& position_m, const Eigen::Vector2d& towards_m) {
    now_.position_m = position_m;
    now_.heading_rad = azimuth(towards_m - position_m);
    keys_.push_back({now_, 0.2});
  }
  void look_at(const Eigen::Vector2d& towards_m) {
    now_.heading_rad = azimuth(towards_m - now_.position_m);
    keys_.push_back({now_, 0});
  }
  /// Turns where it stands, then walks straight ahead.
  void walk_to(const Eigen::Vector2d& position_m, double hold_s) {
    look_at(position_m);
    now_.position_m = position_m;
    keys_.push_back({now_, hold_s});
  }
  void bring_hand(std::size_t side, const Eigen::Vector3d& target_world, double lean_rad, double hold_s) {
    now_.lean_rad = lean_rad;
    now_.arms[side] = arm_towards(now_, side, target_world);
    keys_.push_back({now_, hold_s});
  }
  void bring_hands(const Eigen::Vector3d& middle_world, double apart_m, double lean_rad, double hold_s) {
    now_.lean_rad = lean_rad;
    const Eigen::Vector3d aside(-std::sin(now_.heading_rad), std::cos(now_.heading_rad), 0);
    now_.arms[kLeft] = arm_towards(now_, kLeft, middle_world + 0.5 * apart_m * aside);
    now_.arms[kRight] = arm_towards(now_, kRight, middle_world - 0.5 * apart_m * aside);
    keys_.push_back({now_, hold_s});
  }
  void take_arms(const std::array<ArmDirections, 2>& arms, double hold_s) {
    now_.lean_rad = 0;
    now_.arms = arms;
    keys_.push_back({now_, hold_s});
  }
  [[nodiscard]] std::vector<PersonKey> take() { return std::move(keys_); }

 private:
  PersonStage stage_;
  PersonConfiguration now_;
  std::vector<PersonKey> keys_;
};

/// Hanging, a little bent.
ArmDirections hanging(double outward) {
  return {Eigen::Vector3d(0, 0.08 * outward, -1).normalized(), Eigen::Vector3d(0.2, 0.05 * outward, -1).normalized(),
          Eigen::Vector3d(0.25, 0, -1).normalized()};
}

/// Forearms forward, hands turned inward to the sides of what they hold.
ArmDirections carrying(double outward) {
  return {Eigen::Vector3d(0.15, 0.1 * outward, -1).normalized(), Eigen::Vector3d(1, 0.05 * outward, -0.15).normalized(),
          Eigen::Vector3d(1, -0.15 * outward, 0).normalized()};
}

Eigen::Vector3d scatter(Dice& dice, double half_m) {
  return {dice.uniform(-half_m, half_m), dice.uniform(-half_m, half_m), dice.uniform(-half_m, half_m)};
}

void walk_in(Choreography& person, const PersonStage& stage, Dice& dice) {
  const double from_rad = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const double beside_m = dice.uniform(0.8, 1.2);
  const double around_rad = dice.sign() * dice.uniform(0.5, 1.2);
  person.enter(person.robot() + stage.entrance_m * direction(from_rad), person.robot());
  person.walk_to(person.robot() + beside_m * direction(from_rad), dice.uniform(0.3, 1.5));
  person.walk_to(person.robot() + beside_m * direction(from_rad + around_rad), 0);
  person.look_at(person.robot());
  person.walk_to(person.robot() + stage.entrance_m * direction(from_rad + around_rad), 0.2);
}

void reach(Choreography& person, const PersonStage& stage, Dice& dice, bool with_box) {
  const double from_rad = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const Eigen::Vector2d entrance = person.robot() + stage.entrance_m * direction(from_rad);
  person.enter(entrance, person.robot());
  const std::array<ArmDirections, 2> arms = person.now().arms;
  person.walk_to(person.robot() + dice.uniform(0.7, 0.95) * direction(from_rad), dice.uniform(0, 0.5));
  const Eigen::Vector3d target_world = stage.robot_world + scatter(dice, 0.2);
  const double lean_rad = dice.uniform(0, 0.35);
  const double hold_s = dice.uniform(0.3, 1.5);
  if (with_box) {
    person.bring_hands(target_world, 0.28, lean_rad, hold_s);
  } else {
    person.bring_hand(dice.sign() < 0 ? kLeft : kRight, target_world, lean_rad, hold_s);
  }
  person.take_arms(arms, 0);
  person.walk_to(entrance, 0.2);
}

/// Beyond the robot as the camera sees it, beside the line of sight; the hand goes where the robot hides it.
void hand_behind_robot(Choreography& person, const PersonStage& stage, Dice& dice) {
  const Eigen::Vector3d sight = (stage.robot_world - stage.camera_world).normalized();
  const double beyond_rad = azimuth(sight.head<2>()) + dice.sign() * dice.uniform(0.45, 0.8);
  const Eigen::Vector2d entrance = person.robot() + stage.entrance_m * direction(beyond_rad);
  person.enter(entrance, person.robot());
  const std::array<ArmDirections, 2> arms = person.now().arms;
  person.walk_to(person.robot() + dice.uniform(0.75, 0.9) * direction(beyond_rad), 0.2);
  const Eigen::Vector3d hidden_world = stage.robot_world + dice.uniform(0.18, 0.28) * sight;
  person.bring_hand(dice.sign() < 0 ? kLeft : kRight, hidden_world, dice.uniform(0.1, 0.25), dice.uniform(1.0, 2.0));
  person.take_arms(arms, 0);
  person.walk_to(entrance, 0.2);
}

/// Beside the line of sight, nearer to the camera than to the robot; the arm goes up into the line.
void arm_between(Choreography& person, const PersonStage& stage, Dice& dice) {
  const Eigen::Vector3d from_robot = stage.camera_world - stage.robot_world;
  const double away_m = dice.uniform(0.9, 1.2);
  const Eigen::Vector3d crossing_world = stage.robot_world + away_m * from_robot.normalized();
  const double side = dice.sign();
  const double to_camera_rad = azimuth(from_robot.head<2>());
  const Eigen::Vector2d aside = side * direction(to_camera_rad + std::numbers::pi / 2);
  const Eigen::Vector2d place_m = crossing_world.head<2>() + dice.uniform(0.5, 0.6) * aside;
  const Eigen::Vector2d entrance = place_m + (stage.entrance_m - 1.0) * aside;
  person.enter(entrance, place_m);
  const std::array<ArmDirections, 2> arms = person.now().arms;
  person.walk_to(place_m, 0.1);
  person.bring_hand(dice.sign() < 0 ? kLeft : kRight, crossing_world, 0, dice.uniform(1.0, 2.0));
  person.take_arms(arms, 0);
  person.walk_to(entrance, 0.2);
}

}  // namespace

PersonPlan plan_motion(Motion motion, const PersonStage& stage, std::uint64_t seed) {
  Dice dice(seed, motion);
  const bool with_box = motion == Motion::carry_box;
  Choreography person(stage, with_box ? carrying(1) : hanging(1), with_box ? carrying(-1) : hanging(-1));
  const double pace = dice.uniform(0.6, 1.0);
  switch (motion) {
    case Motion::walk_in:
      walk_in(person, stage, dice);
      break;
    case Motion::reach:
    case Motion::carry_box:
      reach(person, stage, dice, with_box);
      break;
    case Motion::hand_behind_robot:
      hand_behind_robot(person, stage, dice);
      break;
    case Motion::arm_between:
      arm_between(person, stage, dice);
      break;
  }
  return {person.take(), pace};
}

}  // namespace depthgrid::simulation
