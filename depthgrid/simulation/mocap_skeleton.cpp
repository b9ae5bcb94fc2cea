#include "depthgrid/simulation/mocap_skeleton.hpp"

#include <Eigen/Geometry>
#include <cctype>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/simulation/mocap_words.hpp"

namespace depthgrid::simulation {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kInch = 0.0254;
constexpr double kLeastUnit = 1e-4;       ///< of length: inches / metres_per_unit; 254 m a unit
constexpr double kLongestBone = 2.0;      ///< [m]: a longer one means that the units are wrong
constexpr double kFarthestRoot = 1000.0;  ///< [m] from the origin of the recording, likewise
constexpr std::size_t kMaxFrames = 1000000;

/// About fixed x, then y, then z.
Eigen::Matrix3d turn(const Eigen::Vector3d& angles_rad) {
  return (Eigen::AngleAxisd(angles_rad.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles_rad.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles_rad.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// A skeleton while it is read: bones by name, without their parents.
class Bones {
 public:
  std::unordered_map<std::string, MocapBone> by_name;
  std::unordered_map<std::string, std::string> parent_of;
  std::vector<std::string> order;  ///< of the hierarchy: parents first
};

void read_units(MocapWords& words, MocapSkeleton& skeleton) {
  while (!words.at_end() && words.peek().front() != ':') {
    const std::string key = words.take();
    if (key == "length") {
      const double length = words.take_number();
      if (!(length >= kLeastUnit)) {
        words.refuse("unit of length is " + std::to_string(length) + ", must be positive, at least 0.0001");
      }
      skeleton.metres_per_unit = kInch / length;
    } else if (key == "angle") {
      const std::string angle = words.take();
      if (angle != "deg" && angle != "rad") {
        words.refuse("unit of angles is '" + printable_excerpt(angle) + "', must be deg or rad");
      }
      skeleton.degrees = angle == "deg";
    } else {
      (void)words.take();
    }
  }
}

std::vector<int> read_turns(MocapWords& words, const std::string& bone) {
  std::vector<int> turns;
  while (words.on_same_line()) {
    const std::string dof = words.take();
    if (dof != "rx" && dof != "ry" && dof != "rz") {
      words.refuse("bone '" + printable_excerpt(bone) + "' moves in '" + printable_excerpt(dof) +
                   "', must be rx, ry or rz");
    }
    turns.push_back(dof[1] - 'x');
  }
  return turns;
}

/// What follows a key: the rest of its line, and lines of limits in brackets.
void skip_value(MocapWords& words) {
  while (!words.at_end() && words.peek() != "end" && (words.on_same_line() || words.peek().front() == '(')) {
    (void)words.take();
  }
}

MocapBone read_bone(MocapWords& words, const MocapSkeleton& skeleton) {
  MocapBone bone;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length_m = 0;
  while (!words.take_if("end")) {
    const std::string key = words.take();
    if (key == "name") {
      bone.name = words.take();
    } else if (key == "direction") {
      direction = words.take_vector();
    } else if (key == "length") {
      length_m = words.take_number() * skeleton.metres_per_unit;
    } else if (key == "axis") {
      bone.axis_rad = words.take_vector() * (skeleton.degrees ? kDegree : 1.0);
      if (!words.take_if("XYZ")) {
        words.refuse("axis of bone '" + printable_excerpt(bone.name) + "' is not in the order XYZ");
      }
    } else if (key == "dof") {
      bone.turns = read_turns(words, bone.name);
    } else {
      skip_value(words);  // id, limits, masses
    }
  }
  if (bone.name.empty() || !(length_m >= 0 && length_m <= kLongestBone) || !(direction.norm() > 0.5)) {
    words.refuse("bone '" + printable_excerpt(bone.name) + "' has no name, no direction, or is not 0 to " +
                 std::to_string(kLongestBone) + " m long");
  }
  bone.along_m = direction.normalized() * length_m;
  return bone;
}

void read_hierarchy(MocapWords& words, Bones& bones) {
  if (!words.take_if("begin")) {
    words.refuse("the hierarchy does not begin");
  }
  while (!words.take_if("end")) {
    const std::string parent = words.take();
    if (parent != "root" && bones.parent_of.find(parent) == bones.parent_of.end()) {
      words.refuse("'" + printable_excerpt(parent) + "' has children before it has a parent");
    }
    while (words.on_same_line()) {
      const std::string child = words.take();
      if (bones.by_name.find(child) == bones.by_name.end() || !bones.parent_of.emplace(child, parent).second) {
        words.refuse("'" + printable_excerpt(child) + "' is no bone, or has two parents");
      }
      bones.order.push_back(child);
    }
  }
}

/// What stands before the frames: whether their angles are degrees, where it is said. What else a keyword might change
/// about the angles is not known here.
std::optional<bool> read_degrees(MocapWords& words) {
  std::optional<bool> degrees;
  while (!words.at_end() && words.peek().front() == ':') {
    const std::string keyword = words.take();
    const bool is_unit = keyword == ":DEGREES" || keyword == ":RADIANS";
    if (!is_unit && keyword != ":FULLY-SPECIFIED") {
      words.refuse("'" + printable_excerpt(keyword) + "' is not known, must be :FULLY-SPECIFIED, :DEGREES or :RADIANS");
    }
    if (is_unit && degrees.value_or(keyword == ":DEGREES") != (keyword == ":DEGREES")) {
      words.refuse("says :DEGREES and :RADIANS, must say one of them");
    }
    degrees = is_unit ? keyword == ":DEGREES" : degrees;
  }
  return degrees;
}

}  // namespace

MocapSkeleton parse_asf(std::string_view text, const std::string& name) {
  MocapWords words(text, name);
  MocapSkeleton skeleton;
  Bones bones;
  while (!words.at_end()) {
    const std::string section = words.take();
    if (section == ":units") {
      if (!bones.by_name.empty()) {
        words.refuse("the units stand behind the bones that are measured in them, must stand before");
      }
      read_units(words, skeleton);
    } else if (section == ":bonedata") {
      while (words.take_if("begin")) {
        MocapBone bone = read_bone(words, skeleton);
        const std::string bone_name = bone.name;
        if (!bones.by_name.emplace(bone_name, std::move(bone)).second) {
          words.refuse("two bones are called '" + printable_excerpt(bone_name) + "'");
        }
      }
    } else if (section == ":hierarchy") {
      read_hierarchy(words, bones);
    }
  }
  if (bones.order.empty()) {
    words.refuse("has no bones, or no hierarchy of them");
  }
  std::unordered_map<std::string, std::size_t> index_of;
  for (const std::string& bone : bones.order) {
    index_of[bone] = skeleton.bones.size();
    skeleton.bones.push_back(bones.by_name[bone]);
    const std::string& parent = bones.parent_of[bone];
    if (parent != "root") {
      skeleton.bones.back().parent = index_of[parent];
    }
  }
  return skeleton;
}

std::vector<MocapFrame> parse_amc(std::string_view text, const MocapSkeleton& skeleton, const std::string& name) {
  MocapWords words(text, name);
  std::unordered_map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < skeleton.bones.size(); ++i) {
    index_of[skeleton.bones[i].name] = i;
  }
  const double to_rad = read_degrees(words).value_or(skeleton.degrees) ? kDegree : 1.0;
  std::vector<MocapFrame> frames;
  while (!words.at_end()) {
    if (words.take_number() != static_cast<double>(frames.size() + 1) || frames.size() >= kMaxFrames) {
      words.refuse("expected frame " + std::to_string(frames.size() + 1) + " of at most " + std::to_string(kMaxFrames));
    }
    MocapFrame& frame = frames.emplace_back();
    frame.turn_rad.assign(skeleton.bones.size(), Eigen::Vector3d::Zero());
    if (!words.take_if("root")) {
      words.refuse("a frame must begin with the root");
    }
    frame.root_m = words.take_vector() * skeleton.metres_per_unit;
    if (!(frame.root_m.cwiseAbs().maxCoeff() <= kFarthestRoot)) {
      words.refuse("the root is more than " + std::to_string(kFarthestRoot) +
                   " m away; are the units of length right?");
    }
    frame.root_rad = words.take_vector() * to_rad;
    while (!words.at_end() && std::isdigit(static_cast<unsigned char>(words.peek().front())) == 0) {
      const std::string bone = words.take();
      const auto found = index_of.find(bone);
      if (found == index_of.end()) {
        words.refuse("'" + printable_excerpt(bone) + "' is no bone of the skeleton");
      }
      for (const int axis : skeleton.bones[found->second].turns) {
        frame.turn_rad[found->second][axis] = words.take_number() * to_rad;
      }
    }
  }
  if (frames.empty()) {
    words.refuse("has no frame");
  }
  return frames;
}

MocapJoints joints(const MocapSkeleton& skeleton, const MocapFrame& frame) {
  MocapJoints result;
  std::vector<Eigen::Matrix3d> rotations;
  const Eigen::Matrix3d root = turn(frame.root_rad);
  for (std::size_t i = 0; i < skeleton.bones.size(); ++i) {
    const MocapBone& bone = skeleton.bones[i];
    const Eigen::Matrix3d axis = turn(bone.axis_rad);
    const Eigen::Matrix3d& parent = bone.parent ? rotations[*bone.parent] : root;
    const Eigen::Vector3d start_m = bone.parent ? result.end_m[*bone.parent] : frame.root_m;
    rotations.emplace_back(parent * axis * turn(frame.turn_rad[i]) * axis.transpose());
    result.start_m.push_back(start_m);
    result.end_m.emplace_back(start_m + rotations.back() * bone.along_m);
  }
  return result;
}

}  // namespace depthgrid::simulation
