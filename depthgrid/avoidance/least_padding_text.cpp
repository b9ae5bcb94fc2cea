#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "depthgrid/avoidance/least_padding.hpp"
#include "depthgrid/core/reason_text.hpp"

namespace depthgrid::avoidance {

namespace {

std::string metres(double value_m) {
  std::array<char, 64> text{};
  char* const end = std::to_chars(text.data(), text.data() + text.size(), value_m, std::chars_format::fixed, 3).ptr;
  return {text.data(), end};
}

std::string place_text(const Eigen::Vector3d& place) {
  return metres(place.x()) + ", " + metres(place.y()) + ", " + metres(place.z());
}

std::string words_of(const CameraSays& says) {
  if (says.state == ProximityState::unobserved) {
    return "not in its view";
  }
  if (says.state == ProximityState::beyond_rho) {
    return "seen free";
  }
  if (says.behind_robot) {
    return "hidden behind the robot";
  }
  Proximity proximity;
  proximity.state = says.state;
  proximity.unmeasured = says.unmeasured;
  std::array<char, 240> words{};
  return std::string(reason_text(proximity, {}, 0, words));
}

/// "'left': a surface, 'right': hidden behind the robot".
std::string words_of(const NotClear& why, const Rig& rig) {
  std::string text;
  for (const CameraSays& says : why.cameras) {
    text += (text.empty() ? "'" : ", '") + rig.cameras[says.camera].id + "': " + words_of(says);
  }
  return text;
}

/// What is nearest: a clause.
std::string nearest_text(const NotClear& why, const Rig& rig, const Pose& T_output_world) {
  const Proximity& nearest = why.answer.nearest;
  if (why.at_the_border) {
    const double border_m = std::isnan(nearest.known_to_m) ? nearest.distance_m : nearest.known_to_m;
    if (std::isnan(border_m)) {
      return "it reaches out of the space of interest";
    }
    return "the border of the space of interest is " + metres(border_m) + " m from it";
  }
  if (!nearest.nearest_world.allFinite()) {
    return "nothing is known of its distance";
  }
  std::array<char, 240> words{};
  return std::string(reason_text(nearest, {}, 0, words)) + " is " + metres(nearest.distance_m) + " m from it at (" +
         place_text(T_output_world * nearest.nearest_world) + "), " +
         (nearest.distance_m > why.answer.blind_m ? "beside" : "within") + " the layer of " +
         metres(why.answer.blind_m) + " m (" + words_of(why, rig) + ")";
}

std::string decider_text(const NotClear& why, const Rig& rig) {
  return why.decides ? "'" + rig.cameras[*why.decides].id + "'" : "no camera";
}

/// Cells of a table, padded to a width.
std::string wide(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string table(const LeastPadding& found, const Rig& rig, const Pose& T_output_world) {
  std::vector<std::array<std::string, 4>> rows{{"link", "least padding", "decided by", "where"}};
  for (const LinkPadding& link : found.links) {
    const std::optional<NotClear>& before = link.before;
    const bool has_place = before && !before->at_the_border && before->answer.nearest.nearest_world.allFinite();
    rows.push_back({link.name,
                    link.least_m ? metres(*link.least_m) + " m" : "none to " + metres(link.tested_to_m) + " m",
                    link.least_m && before ? decider_text(*before, rig) : "-",
                    has_place ? place_text(T_output_world * before->answer.nearest.nearest_world) : "-"});
  }
  std::array<std::size_t, 4> widths{};
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths.at(i) = std::max(widths.at(i), row.at(i).size());
    }
  }
  std::string text;
  for (const auto& row : rows) {
    text += wide(row[0], widths[0]) + "  " + wide(row[1], widths[1]) + "  " + wide(row[2], widths[2]) + "  " + row[3] +
            "\n";
  }
  return text;
}

std::string decision(const LeastPadding& found, const Rig& rig, const Pose& T_output_world) {
  const LinkPadding& link = found.links[*found.decides];
  if (!found.padding_m) {
    return "No padding clears all links at once: " + link.name + " needs " + metres(*link.least_m) + " m.\n";
  }
  std::string text = "Padding " + metres(*found.padding_m) + " m, a layer of " + metres(found.blind_m) + " m: ";
  if (!link.before) {
    return text + "the smallest that was tested; no link decides.\n";
  }
  return text + link.name + " decides, by " + (link.before->decides ? "camera " : "") +
         decider_text(*link.before, rig) + ". With " + metres(link.before->padding_m) + " m " +
         nearest_text(*link.before, rig, T_output_world) + ".\n";
}

/// What else has to be said of a link.
std::string remark(const LinkPadding& link, const LeastPadding& found, const Rig& rig, const Pose& T_output_world) {
  std::string text;
  if (!link.least_m && link.before) {
    text = link.name + " is not clear up to " + metres(link.tested_to_m) + " m. With " +
           metres(link.before->padding_m) + " m " + nearest_text(*link.before, rig, T_output_world) + ".";
    if (link.covers_from_m && !link.before->at_the_border) {
      text += " From " + metres(*link.covers_from_m) + " m on a layer hides what is farther than " +
              metres(found.robot_within_m) + " m from the link, and so no part of the robot.";
    }
    text += "\n";
  }
  if (link.after) {
    text = link.name + " is clear up to " + metres(link.clear_to_m) + " m only. With " + metres(link.after->padding_m) +
           " m " + nearest_text(*link.after, rig, T_output_world) + ".\n";
  }
  return text;
}

}  // namespace

std::string to_string(const LeastPadding& found, const Rig& rig, const Pose& T_output_world) {
  std::string text = table(found, rig, T_output_world);
  text += found.decides ? decision(found, rig, T_output_world) : "No tested padding clears any link.\n";
  for (const LinkPadding& link : found.links) {
    text += remark(link, found, rig, T_output_world);
  }
  return text;
}

}  // namespace depthgrid::avoidance
