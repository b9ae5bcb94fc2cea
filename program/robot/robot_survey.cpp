#include "program/robot/robot_survey.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <span>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "program/robot/shape_surface.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

using Eigen::Vector3d;

/// Links in the model's order: all, or those from the root to the tip.
std::vector<std::size_t> links_asked_for(const robot::RobotModel& model, std::optional<std::size_t> tip) {
  std::vector<std::size_t> links;
  if (!tip) {
    for (std::size_t i = 0; i < model.links().size(); ++i) {
      links.push_back(i);
    }
    return links;
  }
  for (std::optional<std::size_t> at = tip; at; at = model.joint_of_link(*at).parent) {
    links.push_back(*at);
  }
  std::reverse(links.begin(), links.end());
  return links;
}

/// The joints whose child is one of the links, in their order.
std::vector<std::size_t> joints_above(const RobotSurvey& survey, const std::vector<std::size_t>& links) {
  std::vector<std::size_t> result;
  for (const std::size_t link : links) {
    const std::string& name = survey.model.links()[link].name;
    for (std::size_t j = 0; j < survey.description.joints.size(); ++j) {
      if (survey.description.joints[j].child_link == name) {
        result.push_back(j);
      }
    }
  }
  return result;
}

/// Meshes of the link that are no files.
std::vector<MissingMesh> missing_of(const robot::LinkDescription& link) {
  std::vector<MissingMesh> result;
  for (const robot::LinkShape& item : link.shapes) {
    std::error_code ignored;
    const auto* mesh = std::get_if<robot::MeshShape>(&item.shape);
    if (mesh != nullptr && !std::filesystem::is_regular_file(mesh->file, ignored)) {
      const bool unknown = mesh->file == mesh->name && mesh->name.find("://") != std::string::npos;
      result.push_back({link.name, mesh->name, unknown ? std::string() : mesh->file.string()});
    }
  }
  return result;
}

/// How deep the outermost of the points lies in the capsules together.
std::optional<double> least_depth_m(const std::vector<Capsule>& capsules, std::span<const Vector3d> points) {
  if (capsules.empty() || points.empty()) {
    return std::nullopt;
  }
  double least_m = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : points) {
    double depth_m = -std::numeric_limits<double>::infinity();
    for (const Capsule& capsule : capsules) {
      depth_m = std::max(depth_m, capsule.radius_m - distance_to_axis(capsule, p));
    }
    least_m = std::min(least_m, depth_m);
  }
  return least_m;
}

void measure(const robot::LinkDescription& link, LinkSurvey& result) {
  std::optional<double> shape_m3;
  for (const robot::LinkShape& shape : link.shapes) {
    const auto triangles = surface_triangles(shape);
    shape_m3 = shape_volume_m3(shape, triangles);
    std::string text = shape_text(shape);
    if (std::holds_alternative<robot::MeshShape>(shape.shape)) {
      text += ", " + std::to_string(triangles.size() / 3) + " triangles";
    }
    result.shapes.push_back(std::move(text));
    result.triangles.insert(result.triangles.end(), triangles.begin(), triangles.end());
  }
  double capsules_m3 = 0;
  for (const Capsule& capsule : result.capsules) {
    capsules_m3 += capsule_volume_m3(capsule);
  }
  if (link.shapes.size() == 1 && shape_m3 && *shape_m3 > 0) {  // several may overlap
    result.volume_ratio = capsules_m3 / *shape_m3;
  }
  result.inside_m = least_depth_m(result.capsules, result.triangles);
}

/// Reads the shapes of the other kind, where a link has both, and sets them against the capsules.
void compare_other_shapes(const RobotFileOptions& options, const robot::UrdfOptions& urdf, RobotSurvey& survey) {
  robot::UrdfOptions other = urdf;
  other.shapes = urdf.shapes == robot::ShapeKind::visual ? robot::ShapeKind::collision : robot::ShapeKind::visual;
  try {
    const robot::RobotModel model(robot::load_urdf(options.file, other));
    for (LinkSurvey& link : survey.links) {
      const robot::LinkDescription& shown = survey.model.links()[link.link];
      const robot::LinkDescription& compared = model.links()[model.link_index(shown.name)];
      if (compared.kind == shown.kind || compared.shapes.empty()) {
        continue;
      }
      if (const auto missing = missing_of(compared); !missing.empty()) {
        survey.other_note = missing.front().name + " is not there";
        continue;
      }
      for (const robot::LinkShape& shape : compared.shapes) {
        const auto triangles = surface_triangles(shape);
        link.other_triangles.insert(link.other_triangles.end(), triangles.begin(), triangles.end());
      }
      link.other_inside_m = least_depth_m(link.capsules, link.other_triangles);
    }
  } catch (const Error& error) {
    survey.other_note = error.what();
  }
}

}  // namespace

RobotSurvey survey_robot(const RobotFileOptions& options, const std::string& tip) {
  robot::UrdfOptions urdf = urdf_options(options);
  urdf.require_meshes = false;
  robot::RobotDescription description = robot::load_urdf(options.file, urdf);
  robot::RobotModel model(description);
  RobotSurvey survey{.description = std::move(description),
                     .model = std::move(model),
                     .links = {},
                     .joints = {},
                     .missing_meshes = {},
                     .other_note = {},
                     .tip = {}};
  if (!tip.empty()) {
    survey.tip = as_usage([&] { return survey.model.link_index(tip); });
  }
  const std::vector<std::size_t> links = links_asked_for(survey.model, survey.tip);
  survey.joints = joints_above(survey, links);
  robot::CapsuleOptions capsules;
  std::vector<bool> whole(survey.model.links().size(), false);
  for (const std::size_t link : links) {
    const auto missing = missing_of(survey.model.links()[link]);
    survey.missing_meshes.insert(survey.missing_meshes.end(), missing.begin(), missing.end());
    whole[link] = missing.empty();
  }
  for (std::size_t link = 0; link < whole.size(); ++link) {
    if (!whole[link]) {
      capsules.left_out.push_back(survey.model.links()[link].name);
    }
  }
  const auto around = robot::link_capsules(survey.model, capsules);
  for (const std::size_t link : links) {
    LinkSurvey& result = survey.links.emplace_back();
    result.link = link;
    for (const robot::LinkCapsule& item : around) {
      if (item.link == link) {
        result.capsules.push_back(item.capsule);
      }
    }
    if (whole[link]) {
      measure(survey.model.links()[link], result);
    } else {
      for (const robot::LinkShape& shape : survey.model.links()[link].shapes) {
        result.shapes.push_back(shape_text(shape));
      }
    }
  }
  compare_other_shapes(options, urdf, survey);
  return survey;
}

}  // namespace depthgrid::program
