#include "program/distances/search_options.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "depthgrid/core/number_parsing.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

CLI::Option* add_policy(CLI::App& command, const char* option, std::optional<std::string>& target,
                        const char* description) {
  return command.add_option(option, target, description)
      ->check(CLI::IsMember({"obstacle", "ignored"}))
      ->group("Search");
}

views::Policy policy_of(const std::optional<std::string>& text) {
  return !text ? views::Policy::undeclared : text == "ignored" ? views::Policy::ignored : views::Policy::obstacle;
}

/// "x0,y0,z0,x1,y1,z1", metres.
views::BoxSpace box_of(const std::string& text) {
  std::array<double, 6> numbers{};
  std::string_view rest = text;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const std::size_t comma = rest.find(',');
    const auto number = parse_number<double>(rest.substr(0, comma));
    if (!number || !std::isfinite(*number) || (comma == std::string_view::npos) != (k + 1 == numbers.size())) {
      fail_usage("--box ", text, ": must be six numbers x0,y0,z0,x1,y1,z1, metres: the low and the high corner");
    }
    numbers[k] = *number;
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
  }
  return {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
}

/// Everything that has to be said and was not, in one message.
void check_stated(const SearchOptions& options, const EvaluationOptions& evaluation) {
  std::string missing;
  const auto need = [&missing](bool stated, const char* option) {
    if (!stated) {
      missing.append(missing.empty() ? "" : ", ").append(option);
    }
  };
  need(options.unobserved.has_value(), "--unobserved obstacle|ignored");
  need(evaluation.outside.has_value(), "--outside obstacle|ignored");
  need(options.robot_pockets.has_value(), "--robot-pockets obstacle|ignored");
  need(options.v_max_m_s.has_value(), "--v-max M/S");
  need(options.box || (evaluation.d_min_m && options.d_max_m),
       "the space of interest (--box x0,y0,z0,x1,y1,z1 or --d-min and --d-max)");
  if (!missing.empty()) {
    fail_usage("--method search needs ", missing,
               ": nothing that decides what counts as an obstacle has a default (docs/search.md)");
  }
}

}  // namespace

void add_search_options(CLI::App& command, SearchOptions& options) {
  add_policy(command, "--unobserved", options.unobserved, "space that no camera looks at");
  add_policy(command, "--robot-pockets", options.robot_pockets, "the shadow right behind the robot");
  command
      .add_option("--ignored-pocket", options.ignored_pocket_m,
                  "how deep the ignored shadow behind the robot is, metres (default 0)")
      ->group("Search");
  command.add_option("--v-max", options.v_max_m_s, "fastest obstacle, metres a second; 0: nothing moves")
      ->group("Search");
  command
      .add_option("--smallest-obstacle", options.smallest_obstacle_m,
                  "no obstacle is smaller, metres: small holes count as what surrounds them; 0: they are obstacles "
                  "(default: of the rig file, else recommended for the sensor, else 0)")
      ->group("Search");
  command.add_option("--box", options.box, "space of interest: x0,y0,z0,x1,y1,z1, metres, in the frame of --in")
      ->group("Search");
  command
      .add_option("--d-max", options.d_max_m,
                  "space of interest: what the principal camera sees from --d-min to this depth, metres")
      ->group("Search");
  command.add_option("--resolution", options.resolution_m, "tightness, metres (default 0.005)")->group("Search");
  command
      .add_option("--budget-nodes", options.budget_nodes,
                  "cells that the answers of one frame may open; what is not finished is a lower bound (default: all)")
      ->group("Search");
  command
      .add_option("--memory", options.memory,
                  "what was seen free in earlier frames stays free until something could have come there by --v-max; "
                  "before the first frame something may be anywhere (unknown) or nothing is hidden (empty)")
      ->check(CLI::IsMember({"unknown", "empty"}))
      ->group("Search");
  command.add_option("--memory-voxel", options.memory_voxel_m, "side of the memory's voxels, metres (default 0.025)")
      ->group("Search");
}

void refuse_search_options(const SearchOptions& options, const std::string& method) {
  const std::array<std::pair<bool, const char*>, 11> options_given{
      {{options.unobserved.has_value(), "--unobserved"},
       {options.robot_pockets.has_value(), "--robot-pockets"},
       {options.ignored_pocket_m.has_value(), "--ignored-pocket"},
       {options.v_max_m_s.has_value(), "--v-max"},
       {options.smallest_obstacle_m.has_value(), "--smallest-obstacle"},
       {options.resolution_m.has_value(), "--resolution"},
       {options.box.has_value(), "--box"},
       {options.d_max_m.has_value(), "--d-max"},
       {options.budget_nodes.has_value(), "--budget-nodes"},
       {options.memory.has_value(), "--memory"},
       {options.memory_voxel_m.has_value(), "--memory-voxel"}}};
  for (const auto& [given, name] : options_given) {
    if (given) {
      fail_usage(name, " has no effect with --method ", method, "; use --method search");
    }
  }
}

views::Settings search_settings(const SearchOptions& options, const EvaluationOptions& evaluation,
                                std::size_t principal, const std::vector<CameraMargins>& margins) {
  check_stated(options, evaluation);
  views::Settings settings;
  if (options.box) {
    if (options.d_max_m || evaluation.d_min_m) {
      fail_usage("--box and --d-min, --d-max exclude each other: the space of interest is a box or a camera's view");
    }
    settings.space = box_of(*options.box);
  } else {
    settings.space = views::FrustumSpace{principal, *evaluation.d_min_m, *options.d_max_m};
  }
  settings.policies.unobserved = policy_of(options.unobserved);
  settings.policies.outside = policy_of(evaluation.outside);
  settings.policies.robot_pockets = policy_of(options.robot_pockets);
  settings.policies.ignored_pocket_m = options.ignored_pocket_m.value_or(0.0);
  settings.margins = margins;
  settings.rho_m = evaluation.rho_m;
  settings.resolution_m = options.resolution_m.value_or(settings.resolution_m);
  settings.v_max_m_s = *options.v_max_m_s;
  return settings;
}

std::optional<memory::MemorySettings> search_memory(const SearchOptions& options) {
  if (!options.memory) {
    if (options.memory_voxel_m) {
      fail_usage("--memory-voxel has no effect without --memory unknown|empty");
    }
    return std::nullopt;
  }
  if (!options.box) {
    fail_usage("--memory remembers a box: give the space of interest as --box x0,y0,z0,x1,y1,z1");
  }
  const views::BoxSpace box = box_of(*options.box);
  memory::MemorySettings settings;
  settings.low_world = box.low_world;
  settings.high_world = box.high_world;
  settings.voxel_m = options.memory_voxel_m.value_or(settings.voxel_m);
  if (*options.memory == "empty") {
    settings.start = memory::StartEmpty{};
  } else {
    settings.start = memory::StartUnknown{};
  }
  as_usage([&] { memory::validate(settings); });
  return settings;
}

search::Budget search_budget(const SearchOptions& options) {
  if (options.budget_nodes && *options.budget_nodes < 1) {
    fail_usage("--budget-nodes ", *options.budget_nodes, " must be at least 1");
  }
  return {.nodes = options.budget_nodes};
}

}  // namespace depthgrid::program
