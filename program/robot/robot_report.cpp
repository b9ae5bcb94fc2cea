#include "program/robot/robot_report.hpp"

#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "depthgrid/core/printable_text.hpp"
#include "report/number_text.hpp"

namespace depthgrid::program {

namespace {

using Table = std::vector<std::vector<std::string>>;

/// Columns two blanks apart, each as wide as its widest cell; characters are counted as bytes.
std::string aligned(const Table& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t k = 0; k < row.size(); ++k) {
      widths[k] = std::max(widths[k], row[k].size());
    }
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) {
      line += (k > 0 ? "  " : "") + row[k] + std::string(widths[k] - row[k].size(), ' ');
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

const char* type_text(robot::JointType type) {
  constexpr std::array<const char*, 4> kNames{"fixed", "revolute", "continuous", "prismatic"};
  return kNames.at(static_cast<std::size_t>(type));
}

std::string mimic_text(const robot::Mimic& mimic) {
  std::string text = report::exact_text(mimic.multiplier) + " x " + mimic.joint;
  if (mimic.offset != 0) {
    text += (mimic.offset > 0 ? " + " : " - ") + report::exact_text(std::abs(mimic.offset));
  }
  return text;
}

std::string joints_text(const RobotSurvey& survey) {
  Table rows{{"joint", "type", "from", "to", "speed", "link", "mimics"}};
  for (const std::size_t j : survey.joints) {
    const robot::JointDescription& joint = survey.description.joints[j];
    const bool moves = joint.type != robot::JointType::fixed;
    const bool limited = moves && joint.type != robot::JointType::continuous;
    const std::string unit = unit_of(joint.type);
    rows.push_back({joint.name, type_text(joint.type),
                    limited ? report::fixed(joint.lower, 3)
                    : moves ? "no limit"
                            : "",
                    limited ? report::fixed(joint.upper, 3) + " " + unit
                    : moves ? "no limit"
                            : "",
                    !moves                           ? ""
                    : std::isfinite(joint.max_speed) ? report::fixed(joint.max_speed, 3) + " " + unit + "/s"
                                                     : "not stated",
                    joint.child_link, joint.mimic ? mimic_text(*joint.mimic) : ""});
  }
  return rows.size() > 1 ? aligned(rows) : std::string("no joints\n");
}

std::string depth_text(const std::optional<double>& inside_m) {
  if (!inside_m) {
    return "-";
  }
  const std::string text = report::fixed(1e3 * std::abs(*inside_m), 1);
  return text == "0.0" ? "touches" : text + (*inside_m < 0 ? " mm outside" : " mm inside");
}

const char* kind_text(robot::ShapeKind kind) { return kind == robot::ShapeKind::visual ? "visual" : "collision"; }

std::string shapes_text(const LinkSurvey& link, robot::ShapeKind kind) {
  if (link.shapes.empty()) {
    return "none";
  }
  const std::string more = link.shapes.size() > 1 ? " and " + std::to_string(link.shapes.size() - 1) + " more" : "";
  return std::string(kind_text(kind)) + " " + link.shapes.front() + more;
}

std::string volume_text(const LinkSurvey& link) {
  return link.volume_ratio        ? report::fixed(*link.volume_ratio, 2) + " times"
         : link.shapes.size() > 1 ? "-"
                                  : "mesh is open";
}

std::string count_text(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string links_text(const RobotSurvey& survey) {
  const bool others = std::any_of(survey.links.begin(), survey.links.end(),
                                  [](const LinkSurvey& link) { return link.other_inside_m.has_value(); });
  Table rows{{"link", "shapes", "capsule", "radius", "length", "volume", "outermost corner"}};
  if (others) {
    rows.front().emplace_back("of its other shapes");
  }
  for (const LinkSurvey& link : survey.links) {
    const robot::LinkDescription& description = survey.model.links()[link.link];
    std::vector<std::string> row{description.name, shapes_text(link, description.kind)};
    if (link.capsules.empty()) {
      row.emplace_back(link.shapes.empty() ? "-" : "not known");
      rows.push_back(row);
      continue;
    }
    for (std::size_t k = 0; k < link.capsules.size(); ++k) {
      const Capsule& capsule = link.capsules[k];
      if (k > 0) {
        row = {"", ""};
      }
      row.push_back(std::to_string(k + 1) + " of " + std::to_string(link.capsules.size()));
      row.push_back(report::fixed(capsule.radius_m, 3) + " m");
      row.push_back(report::fixed((capsule.b - capsule.a).norm(), 3) + " m");
      if (k == 0) {
        row.push_back(volume_text(link));
        row.push_back(depth_text(link.inside_m));
        if (others) {
          row.push_back(depth_text(link.other_inside_m));
        }
      }
      rows.push_back(row);
    }
  }
  return aligned(rows);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

std::vector<std::string> links_without_shapes(const RobotSurvey& survey) {
  std::vector<std::string> names;
  for (const LinkSurvey& link : survey.links) {
    if (survey.model.links()[link.link].shapes.empty()) {
      names.push_back(survey.model.links()[link.link].name);
    }
  }
  return names;
}

std::vector<std::string> joints_without_speed(const RobotSurvey& survey) {
  std::vector<std::string> names;
  for (const std::size_t j : survey.joints) {
    const robot::JointDescription& joint = survey.description.joints[j];
    if (joint.type != robot::JointType::fixed && !joint.mimic && !std::isfinite(joint.max_speed)) {
      names.push_back(joint.name);
    }
  }
  return names;
}

/// The package that a mesh's name begins with; empty where it has none.
std::string package_of(const MissingMesh& mesh) {
  constexpr std::string_view kScheme = "package://";
  return mesh.name.starts_with(kScheme)
             ? mesh.name.substr(kScheme.size(), mesh.name.find('/', kScheme.size()) - kScheme.size())
             : std::string();
}

std::string missing_text(const RobotSurvey& survey) {
  std::string text;
  if (const auto names = links_without_shapes(survey); !names.empty()) {
    text += "  links without shapes, so cameras see them as obstacles: " + joined(names) + '\n';
  }
  if (const auto names = joints_without_speed(survey); !names.empty()) {
    text += "  speeds not stated, needed where images and joint positions differ in time: " + joined(names) + '\n';
  }
  for (const MissingMesh& mesh : survey.missing_meshes) {
    const std::string package = package_of(mesh);
    text += "  link " + mesh.link + ": mesh " + mesh.name + " is not there" +
            (mesh.file.empty() ? std::string() : ", looked for at " + mesh.file) +
            (package.empty() ? std::string() : "; state --package " + package + "=FOLDER") + '\n';
  }
  if (!survey.other_note.empty()) {
    text += "  the other shapes of the links (visual ones, where collision shapes count) are not compared: " +
            survey.other_note + '\n';
  }
  return "missing:\n" + (text.empty() ? std::string("  nothing\n") : text);
}

using JsonWriter = rapidjson::Writer<rapidjson::StringBuffer>;

void put(JsonWriter& json, const char* key, const std::string& text) {
  json.Key(key);
  json.String(text.data(), static_cast<rapidjson::SizeType>(text.size()));
}

/// null where it is not known or not finite.
void put(JsonWriter& json, const char* key, const std::optional<double>& number) {
  json.Key(key);
  if (number && std::isfinite(*number)) {
    json.RawValue(report::exact_text(*number).data(), report::exact_text(*number).size(), rapidjson::kNumberType);
  } else {
    json.Null();
  }
}

void put(JsonWriter& json, const char* key, const std::vector<std::string>& texts) {
  json.Key(key);
  json.StartArray();
  for (const std::string& text : texts) {
    json.String(text.data(), static_cast<rapidjson::SizeType>(text.size()));
  }
  json.EndArray();
}

void put(JsonWriter& json, const char* key, const Eigen::Vector3d& v) {
  json.Key(key);
  json.StartArray();
  for (const double number : v) {
    const std::string text = report::exact_text(number);
    json.RawValue(text.data(), text.size(), rapidjson::kNumberType);
  }
  json.EndArray();
}

void put_joint(JsonWriter& json, const robot::JointDescription& joint) {
  const bool limited = joint.type == robot::JointType::revolute || joint.type == robot::JointType::prismatic;
  json.StartObject();
  put(json, "name", joint.name);
  put(json, "type", std::string(type_text(joint.type)));
  put(json, "lower", limited ? std::optional<double>(joint.lower) : std::nullopt);
  put(json, "upper", limited ? std::optional<double>(joint.upper) : std::nullopt);
  put(json, "speed", joint.type == robot::JointType::fixed ? std::nullopt : std::optional<double>(joint.max_speed));
  put(json, "parent", joint.parent_link);
  put(json, "child", joint.child_link);
  json.Key("mimic");
  if (joint.mimic) {
    json.StartObject();
    put(json, "joint", joint.mimic->joint);
    put(json, "multiplier", std::optional<double>(joint.mimic->multiplier));
    put(json, "offset", std::optional<double>(joint.mimic->offset));
    json.EndObject();
  } else {
    json.Null();
  }
  json.EndObject();
}

void put_link(JsonWriter& json, const RobotSurvey& survey, const LinkSurvey& link) {
  const robot::LinkDescription& description = survey.model.links()[link.link];
  json.StartObject();
  put(json, "name", description.name);
  json.Key("kind");
  description.shapes.empty() ? json.Null() : json.String(kind_text(description.kind));
  put(json, "shapes", link.shapes);
  json.Key("capsules");
  json.StartArray();
  for (const Capsule& capsule : link.capsules) {
    json.StartObject();
    put(json, "a_m", capsule.a);
    put(json, "b_m", capsule.b);
    put(json, "radius_m", std::optional<double>(capsule.radius_m));
    json.EndObject();
  }
  json.EndArray();
  put(json, "volume_ratio", link.volume_ratio);
  put(json, "outermost_corner_inside_m", link.inside_m);
  put(json, "outermost_corner_of_other_shapes_inside_m", link.other_inside_m);
  json.EndObject();
}

Pose tip_pose(const RobotSurvey& survey, const std::vector<double>& q) {
  std::vector<Pose> poses(survey.model.links().size(), Pose::Identity());
  (void)survey.model.link_poses(q, Pose::Identity(), poses);
  return poses[*survey.tip];
}

/// Names of files and folders come from outside.
std::string printable_lines(const std::string& text) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    result += printable(std::string_view(text).substr(begin, end - begin)) + '\n';
    begin = end + 1;
  }
  return result;
}

}  // namespace

std::string missing_meshes_text(const RobotSurvey& survey) {
  if (survey.missing_meshes.empty()) {
    return {};
  }
  std::set<std::string> packages;
  for (const MissingMesh& mesh : survey.missing_meshes) {
    if (const std::string package = package_of(mesh); !package.empty()) {
      packages.insert("--package " + package + "=FOLDER");
    }
  }
  const std::size_t count = survey.missing_meshes.size();
  const MissingMesh& first = survey.missing_meshes.front();
  return std::to_string(count) + (count == 1 ? " mesh file is" : " mesh files are") + " not there: " + first.name +
         " of link '" + first.link + "'" + (count == 1 ? "" : ", ...") +
         (packages.empty() ? std::string()
                           : "; state " + joined(std::vector<std::string>(packages.begin(), packages.end())));
}

std::string robot_text(const RobotSurvey& survey, const std::vector<double>& q) {
  const robot::RobotModel& model = survey.model;
  const bool loads = survey.missing_meshes.empty();
  std::string text = model.source() + (loads ? ": loads" : ": does not load, see what is missing") + ". Robot '" +
                     model.name() + "', root " + model.links().front().name + ", " +
                     count_text(model.links().size(), "link") + ", " + count_text(model.joints().size(), "joint") +
                     " with a position of its own\n\n";
  text += joints_text(survey) + '\n' + links_text(survey) + '\n';
  if (survey.tip) {
    const Eigen::Vector3d p = tip_pose(survey, q).translation();
    text += "tip " + model.links()[*survey.tip].name + " at these joint positions: " + report::fixed(p.x(), 4) + ", " +
            report::fixed(p.y(), 4) + ", " + report::fixed(p.z(), 4) + " m from the root\n\n";
  }
  return printable_lines(text + missing_text(survey));
}

std::string robot_json(const RobotSurvey& survey, const std::vector<double>& q) {
  rapidjson::StringBuffer buffer;
  JsonWriter json(buffer);
  json.StartObject();
  put(json, "file", survey.model.source());
  put(json, "robot", survey.model.name());
  json.Key("loads");
  json.Bool(survey.missing_meshes.empty());
  put(json, "root", survey.model.links().front().name);
  json.Key("joints");
  json.StartArray();
  for (const std::size_t j : survey.joints) {
    put_joint(json, survey.description.joints[j]);
  }
  json.EndArray();
  json.Key("links");
  json.StartArray();
  for (const LinkSurvey& link : survey.links) {
    put_link(json, survey, link);
  }
  json.EndArray();
  if (survey.tip) {
    put(json, "tip", survey.model.links()[*survey.tip].name);
    put(json, "tip_at_m", Eigen::Vector3d(tip_pose(survey, q).translation()));
  }
  put(json, "links_without_shapes", links_without_shapes(survey));
  put(json, "speeds_not_stated", joints_without_speed(survey));
  json.Key("missing_meshes");
  json.StartArray();
  for (const MissingMesh& mesh : survey.missing_meshes) {
    json.StartObject();
    put(json, "link", mesh.link);
    put(json, "mesh", mesh.name);
    put(json, "package", package_of(mesh));
    json.EndObject();
  }
  json.EndArray();
  json.EndObject();
  return std::string(buffer.GetString(), buffer.GetSize()) + '\n';
}

}  // namespace depthgrid::program
