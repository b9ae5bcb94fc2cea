// Poses and Jacobians against a product of transforms that is written here, and against differences.
#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <thread>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/urdf.hpp"
#include "robot/robot_support.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"

namespace depthgrid::robot {
namespace {

using Eigen::AngleAxisd;
using Eigen::Translation3d;
using Eigen::Vector3d;
constexpr double kDegree = std::numbers::pi / 180;

double difference(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff(); }

/// Flange of the arm by Denavit-Hartenberg parameters: Rz(q) Tz(d) Rx(alpha), joint by joint.
Pose flange_of(const std::vector<double>& q) {
  constexpr std::array<double, 7> kOffset{0.3105, 0, 0.400, 0, 0.390, 0, 0.078};
  constexpr std::array<double, 7> kTwist{90, -90, -90, 90, 90, -90, 0};
  Pose pose = Pose::Identity();
  for (std::size_t i = 0; i < 7; ++i) {
    pose = pose * AngleAxisd(q[i], Vector3d::UnitZ()) * Translation3d(0, 0, kOffset[i]) *
           AngleAxisd(kTwist[i] * kDegree, Vector3d::UnitX());
  }
  return pose;
}

TEST(Kinematics, KukaFollowsItsPublishedDimensions) {
  const RobotModel model = kuka_lwr4();
  ASSERT_EQ(model.joints().size(), 7U);
  const std::size_t flange = model.link_index("lwr_7_link");
  EXPECT_NEAR((link_poses(model, std::vector<double>(7, 0.0))[flange].translation() - Vector3d(0, 0, 1.1785)).norm(), 0,
              1e-12);
  const test::RandomRun run = test::random_run(500);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::vector<double> q = random.positions(model);
    const Pose T_world_base = random.pose(2);
    ASSERT_LT(difference(link_poses(model, q, T_world_base)[flange], T_world_base * flange_of(q)), 1e-9)
        << "case " << i << "; " << run.reproduce();
  }
  for (std::size_t j = 0; j < 7; ++j) {
    EXPECT_NEAR(model.joints()[j].upper, (j % 2 == 0 ? 170 : 120) * kDegree, 1e-8);
    EXPECT_NEAR(model.joints()[j].lower, -model.joints()[j].upper, 1e-12);
  }
}

/// A random tree of links, as a file and as this test's own list of transforms.
struct RandomTree {
  struct Item {
    int parent;
    JointType type;
    Pose origin;
    Vector3d axis;
    int mimics = -1;
    double multiplier = 1;
    double offset = 0;
  };
  std::vector<Item> items;  ///< item i carries link i + 1
  std::string text;

  explicit RandomTree(Random& random) {
    std::ostringstream out;
    out.precision(17);
    out << "<robot name='tree'><link name='link0'/>";
    const int count = random.integer(1, 9);
    for (int i = 0; i < count; ++i) {
      constexpr std::array<JointType, 4> kTypes{JointType::fixed, JointType::revolute, JointType::continuous,
                                                JointType::prismatic};
      constexpr std::array<const char*, 4> kNames{"fixed", "revolute", "continuous", "prismatic"};
      const auto type = static_cast<std::size_t>(random.integer(0, 3));
      Item item{random.integer(0, i), kTypes[type], Pose::Identity(), random.unit()};
      const Vector3d rpy(random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3));
      const Vector3d xyz = random.in_cube(0.5);
      item.origin = Translation3d(xyz) * AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
                    AngleAxisd(rpy.y(), Vector3d::UnitY()) * AngleAxisd(rpy.x(), Vector3d::UnitX());
      out << "<link name='link" << i + 1 << "'/><joint name='joint" << i << "' type='" << kNames[type]
          << "'><parent link='link" << item.parent << "'/><child link='link" << i + 1 << "'/><origin xyz='"
          << xyz.transpose() << "' rpy='" << rpy.transpose() << "'/><axis xyz='" << (2 * item.axis).transpose()
          << "'/><limit lower='-2' upper='2' velocity='1' effort='1'/>";
      const int master = random.integer(-8, i - 1);
      if (master >= 0 && item.type != JointType::fixed && items[static_cast<std::size_t>(master)].mimics < 0 &&
          items[static_cast<std::size_t>(master)].type != JointType::fixed) {
        item.mimics = master;
        item.multiplier = random.uniform(-2, 2);
        item.offset = random.uniform(-1, 1);
        out << "<mimic joint='joint" << master << "' multiplier='" << item.multiplier << "' offset='" << item.offset
            << "'/>";
      }
      out << "</joint>";
      items.push_back(item);
    }
    out << "</robot>";
    text = out.str();
  }

  /// Pose of link i (of this list) where joint k stands at position[k].
  [[nodiscard]] Pose pose(int i, const std::vector<double>& position) const {
    if (i == 0) {
      return Pose::Identity();
    }
    const Item& item = items[static_cast<std::size_t>(i - 1)];
    const double at = item.mimics < 0 ? position[static_cast<std::size_t>(i - 1)]
                                      : item.multiplier * position[static_cast<std::size_t>(item.mimics)] + item.offset;
    Pose moved = Pose::Identity();
    if (item.type == JointType::prismatic) {
      moved.translation() = at * item.axis;
    } else if (item.type != JointType::fixed) {
      moved.linear() = AngleAxisd(at, item.axis).toRotationMatrix();
    }
    return pose(item.parent, position) * item.origin * moved;
  }
};

TEST(Kinematics, RandomTreesAgreeWithAProductOfTransforms) {
  const test::RandomRun run = test::random_run(300);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const RandomTree tree(random);
    const RobotModel model(parse_urdf(tree.text, "tree.urdf"));
    const std::vector<double> q = random.positions(model);
    std::vector<double> position(tree.items.size());
    for (std::size_t j = 0; j < model.joints().size(); ++j) {
      position[std::stoul(model.joints()[j].name.substr(5))] = q[j];
    }
    const std::vector<Pose> poses = link_poses(model, q);
    for (std::size_t link = 0; link < poses.size(); ++link) {
      const int named = std::stoi(model.links()[link].name.substr(4));
      ASSERT_LT(difference(poses[link], tree.pose(named, position)), 1e-9)
          << "link " << named << " of case " << i << "; " << run.reproduce() << "\n"
          << tree.text;
    }
  }
}

/// Columns of the Jacobian by central differences: the point's own, and the link's turn.
void expect_differences(const RobotModel& model, Random& random, const std::string& what) {
  const std::vector<double> q = random.positions(model);
  const Pose T_world_base = random.pose(1);
  const std::vector<Pose> poses = link_poses(model, q, T_world_base);
  const auto link = static_cast<std::size_t>(random.integer(0, static_cast<int>(poses.size()) - 1));
  const Vector3d p_link = random.in_cube(0.5);
  Jacobian jacobian(6, static_cast<Eigen::Index>(q.size()));
  ASSERT_TRUE(model.jacobian(q, poses, link, poses[link] * p_link, jacobian));
  constexpr double kStep = 1e-6;
  for (std::size_t j = 0; j < q.size(); ++j) {
    std::vector<double> low = q;
    std::vector<double> high = q;
    low[j] -= kStep;
    high[j] += kStep;
    const Pose before = link_poses(model, low, T_world_base)[link];
    const Pose after = link_poses(model, high, T_world_base)[link];
    const AngleAxisd turn(after.linear() * before.linear().transpose());
    Eigen::Matrix<double, 6, 1> expected;
    expected << (after * p_link - before * p_link) / (2 * kStep), turn.angle() * turn.axis() / (2 * kStep);
    ASSERT_LT((jacobian.col(static_cast<Eigen::Index>(j)) - expected).cwiseAbs().maxCoeff(), 1e-6) << what;
  }
}

TEST(Kinematics, JacobiansAgreeWithDifferences) {
  const RobotModel kuka = kuka_lwr4();
  const test::RandomRun run = test::random_run(300);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    expect_differences(kuka, random, what);
    const RandomTree tree(random);
    const RobotModel model(parse_urdf(tree.text, "tree.urdf"));
    if (!model.joints().empty()) {
      expect_differences(model, random, what + "\n" + tree.text);
    }
  }
}

TEST(Kinematics, ArmsOfTheDataFolderStandWhereTheyAreKnownTo) {
  DEPTHGRID_REQUIRE_ROBOT_DATA();
  const RobotModel lwr(load_urdf(robot_data() / "kuka_lwr/lwr_simplified.urdf"));
  const std::size_t flange = lwr.link_index("lwr_arm_7_link");
  std::vector<double> q(7, 0.0);
  EXPECT_LT((link_poses(lwr, q)[flange].translation() - Vector3d(0, 0, 1.1985)).norm(), 1e-9);
  q[1] = std::numbers::pi / 2;
  EXPECT_LT((link_poses(lwr, q)[flange].translation() - Vector3d(-0.868, 0, 0.3305)).norm(), 1e-9);
  UrdfOptions options;
  options.packages["franka_description"] = robot_data() / "franka_panda";
  const RobotModel panda(load_urdf(robot_data() / "franka_panda/franka_panda.urdf", options));
  const auto at_zero = link_poses(panda, std::vector<double>(8, 0.0));
  EXPECT_LT((at_zero[panda.link_index("panda_hand")].translation() - Vector3d(0.088, 0, 0.926)).norm(), 1e-9);
  std::vector<double> open(8, 0.0);
  open[7] = 0.03;  // both fingers move, away from each other
  const auto opened = link_poses(panda, open);
  EXPECT_NEAR((opened[panda.link_index("panda_leftfinger")].translation() -
               opened[panda.link_index("panda_rightfinger")].translation())
                  .norm(),
              0.06, 1e-12);
}

// One model for the threads of several cameras: each gets the poses of its own joint positions.
TEST(Kinematics, ManyThreadsAskOneModel) {
  const RobotModel model = kuka_lwr4();
  const test::RandomRun run = test::random_run(20000);
  const auto ask = [&](double q) {
    const std::vector<double> positions(7, q);
    const std::vector<Pose> expected = link_poses(kuka_lwr4(), positions);
    long wrong = 0;
    for (std::int64_t i = 0; i < run.count; ++i) {
      const std::vector<Pose> poses = link_poses(model, positions);
      wrong += difference(poses.back(), expected.back()) > 0 ? 1 : 0;
    }
    return wrong;
  };
  long wrong_beside = 0;
  std::thread beside([&] { wrong_beside = ask(0.3); });
  EXPECT_EQ(ask(-0.7), 0);
  beside.join();
  EXPECT_EQ(wrong_beside, 0);
}

TEST(Kinematics, AllocatesNothingAndRefusesWrongSizes) {
  const RobotModel model = kuka_lwr4();
  const std::vector<double> q(7, 0.3);
  std::vector<Pose> poses(8);
  Jacobian jacobian(6, 7);
  EXPECT_FALSE(model.link_poses(std::vector<double>(6, 0.0), Pose::Identity(), poses));
  EXPECT_FALSE(model.link_poses(q, Pose::Identity(), std::span(poses).first(7)));
  EXPECT_FALSE(model.jacobian(q, poses, 8, Vector3d::Zero(), jacobian));
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const test::AllocationGuard guard;
  const bool posed = model.link_poses(q, Pose::Identity(), poses);
  const bool differentiated = model.jacobian(q, poses, 7, poses[7].translation(), jacobian);
  const auto allocations = guard.allocations();
  EXPECT_EQ(allocations, 0);
  EXPECT_TRUE(posed && differentiated);
}

}  // namespace
}  // namespace depthgrid::robot
