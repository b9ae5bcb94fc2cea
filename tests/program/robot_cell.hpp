// A recording of two cameras and an arm, as files: the images are those of an analytic scene, which knows what is
// robot; where the links stand is worked out by hand.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "depthgrid/files/rig_file.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "program/command.hpp"

namespace depthgrid::test::robot_cell {

/// Two turning links of capsules, and a hand of two balls.
inline const std::string kUrdf = R"(<robot name="arm">
  <link name="foot"/>
  <link name="upper"><collision><origin xyz="0.2 0 0" rpy="0 1.5707963267948966 0"/>
    <geometry><capsule radius="0.06" length="0.4"/></geometry></collision></link>
  <link name="fore"><collision><origin xyz="0.15 0 0" rpy="0 1.5707963267948966 0"/>
    <geometry><capsule radius="0.05" length="0.3"/></geometry></collision></link>
  <link name="hand">
    <collision><origin xyz="0 0.06 0"/><geometry><sphere radius="0.05"/></geometry></collision>
    <collision><origin xyz="0 -0.06 0"/><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <joint name="pan" type="revolute"><origin xyz="0 0 0.3"/><parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-1.6" upper="1.6" velocity="0"/></joint>
  <joint name="tilt" type="revolute"><origin xyz="0.5 0 0"/><parent link="upper"/><child link="fore"/><axis xyz="0 1 0"/>
    <limit lower="-1.6" upper="1.6" velocity="1"/></joint>
  <joint name="grip" type="fixed"><origin xyz="0.4 0 0"/><parent link="fore"/><child link="hand"/></joint>
</robot>)";
inline const std::string kBase = "--base 0.1,0,0.2,0,0,0.5 ";

/// Of the joints, radians.
struct Position {
  double pan, tilt;
};
inline const std::map<int, Position> kFrames{{3, {0.2, -0.3}}, {4, {-0.6, 0.4}}};
inline const Capsule kObstacle = Capsule::sphere({0.775, 0.568, 0.93}, 0.1);

/// upper, fore, and the hand's two, in the world.
std::vector<Capsule> links_at(const Position& q);
/// From a point to the nearest surface of them, metres.
double distance_m(const std::vector<Capsule>& links, const Eigen::Vector3d& p);
simulation::Scene scene(const std::vector<Capsule>& robot, bool obstacle);

files::RigFile rig_file();
/// Rig, images, arm.urdf, and joints.csv by frame number.
void write_cell(const TemporaryFolder& folder);

inline const std::string kQuestion =
    "distances . --method search --margin-constant 0.002 --unobserved ignored --outside ignored --robot-pockets "
    "ignored "
    "--ignored-pocket 0.6 --v-max 0 --box=-0.8,-0.8,-0.4,1.6,1.9,1.7 --rho 0.6 ";
inline const std::string kRobot = "--urdf arm.urdf --joints joints.csv " + kBase;

/// "frame,point" to the cell of a column.
std::map<std::string, std::string> column(const CommandResult& result, const std::string& name);
/// The number that follows this text the first time; "nan" where there is none.
std::string after(const std::string& text, const std::string& words);

}  // namespace depthgrid::test::robot_cell
