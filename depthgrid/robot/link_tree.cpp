#include "depthgrid/robot/link_tree.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

namespace {

template <class Item>
std::map<std::string, std::size_t> index_of_names(const std::vector<Item>& items, const char* what,
                                                  const std::string& source) {
  std::map<std::string, std::size_t> indices;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!indices.emplace(items[i].name, i).second) {
      fail(source, ": ", what, " '", items[i].name, "' stands there twice");
    }
  }
  return indices;
}

}  // namespace

std::vector<TreeLink> link_tree(const RobotDescription& robot) {
  const auto links = index_of_names(robot.links, "link", robot.source);
  const auto joints = index_of_names(robot.joints, "joint", robot.source);
  if (links.empty()) {
    fail(robot.source, ": the robot has no link");
  }
  const auto link_named = [&](const std::string& name, const JointDescription& joint, const char* end) {
    const auto found = links.find(name);
    if (found == links.end()) {
      fail(robot.source, ": joint '", joint.name, "': its ", end, " is link '", name, "', which is not there");
    }
    return found->second;
  };
  std::vector<std::optional<std::size_t>> joint_of_link(robot.links.size());
  std::vector<std::vector<std::size_t>> joints_from_link(robot.links.size());
  for (const auto& [name, index] : joints) {  // by name
    const JointDescription& joint = robot.joints[index];
    auto& carrier = joint_of_link[link_named(joint.child_link, joint, "child")];
    if (carrier) {
      fail(robot.source, ": link '", joint.child_link, "' hangs on two joints, '", robot.joints[*carrier].name,
           "' and '", joint.name, "'; a robot is a tree");
    }
    carrier = index;
    joints_from_link[link_named(joint.parent_link, joint, "parent")].push_back(index);
  }

  std::vector<TreeLink> tree;
  const auto grow = [&](const TreeLink& root) {
    std::vector<TreeLink> next{root};  // not by recursion: a chain may be longer than the program's stack
    while (!next.empty()) {
      tree.push_back(next.back());
      next.pop_back();
      const std::size_t here = tree.size() - 1;
      const std::vector<std::size_t>& children = joints_from_link[tree[here].link];
      for (std::size_t k = children.size(); k-- > 0;) {
        next.push_back({links.at(robot.joints[children[k]].child_link), children[k], here});
      }
    }
  };
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (joint_of_link[i]) {
      continue;
    }
    if (!tree.empty()) {
      fail(robot.source, ": links '", robot.links[tree[0].link].name, "' and '", robot.links[i].name,
           "' both hang on no joint; a robot has one root");
    }
    grow({i, std::nullopt, std::nullopt});
  }
  if (tree.empty()) {
    fail(robot.source, ": every link hangs on a joint; a robot needs a root, so there is a loop");
  }
  if (tree.size() < robot.links.size()) {
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
      if (std::none_of(tree.begin(), tree.end(), [i](const TreeLink& link) { return link.link == i; })) {
        fail(robot.source, ": link '", robot.links[i].name, "' is not reached from the root '",
             robot.links[tree[0].link].name, "'; it is part of a loop or hangs on one");
      }
    }
  }
  return tree;
}

}  // namespace depthgrid::robot
