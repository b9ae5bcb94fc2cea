// What an evaluator has answered, column by column.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "depthgrid/core/proximity.hpp"
#include "distances.hpp"
#include "parts.hpp"

namespace depthgrid::python {
namespace {

/// Arrays own what they hold.
constexpr auto kOwned = nb::rv_policy::move;

template <class Get>
Doubles column(const Distances& distances, const Get& get) {
  std::vector<double> values;
  values.reserve(distances.answers.size());
  for (const Answer& answer : distances.answers) {
    values.push_back(get(answer));
  }
  return doubles(std::move(values), 1);
}

template <class Get>
Doubles places(const Distances& distances, const Get& get) {
  std::vector<double> values;
  values.reserve(3 * distances.answers.size());
  for (const Answer& answer : distances.answers) {
    const Eigen::Vector3d place = get(answer);
    values.insert(values.end(), place.begin(), place.end());
  }
  return doubles(std::move(values), 3);
}

template <class Get>
auto list(const Distances& distances, const Get& get) {
  std::vector<decltype(get(distances.answers.front()))> values;
  for (const Answer& answer : distances.answers) {
    values.push_back(get(answer));
  }
  return values;
}

std::optional<std::string> camera_of(const Distances& distances, const Answer& answer) {
  return answer.nearest.camera ? std::optional(distances.cameras[*answer.nearest.camera]) : std::nullopt;
}

}  // namespace

void add_answers(nb::module_& module) {
  nb::class_<Distances>(
      module, "Distances",
      "One answer a capsule; metres, world frame. NaN where there is no number, and then `states` says why.")
      .def("__len__", [](const Distances& d) { return d.answers.size(); })
      .def_prop_ro(
          "distance_m",
          [](const Distances& d) { return column(d, [](const Answer& a) { return a.nearest.distance_m; }); }, kOwned,
          "N: a lower bound at the time of the images, from the capsule's surface; rho where nothing is nearer.")
      .def_prop_ro(
          "distance_now_m",
          [](const Distances& d) { return column(d, [](const Answer& a) { return a.distance_now_m; }); }, kOwned,
          "N: a lower bound at the time that was asked for: less v_max times the age of the images. NaN: nothing is "
          "known.")
      .def_prop_ro(
          "clear_m", [](const Distances& d) { return column(d, [](const Answer& a) { return clear_of_layer_m(a); }); },
          kOwned,
          "N: distance_now_m less the blind layer around the robot, at least 0. What a robot is to keep above 0.")
      .def_prop_ro(
          "blind_m", [](const Distances& d) { return column(d, [](const Answer& a) { return a.blind_m; }); }, kOwned,
          "N: how thick the layer around the robot is in which nothing is seen.")
      .def_prop_ro(
          "known_to_m",
          [](const Distances& d) { return column(d, [](const Answer& a) { return a.nearest.known_to_m; }); }, kOwned,
          "N: how far the border of the space of interest is, where the space outside is ignored.")
      .def_prop_ro(
          "nearest_world",
          [](const Distances& d) { return places(d, [](const Answer& a) { return a.nearest.nearest_world; }); }, kOwned,
          "N x 3: the nearest point where something may be.")
      .def_prop_ro(
          "direction_world",
          [](const Distances& d) { return places(d, [](const Answer& a) { return a.nearest.direction_world; }); },
          kOwned, "N x 3: unit vector to it.")
      .def_prop_ro(
          "on_axis_world",
          [](const Distances& d) { return places(d, [](const Answer& a) { return a.on_axis_world; }); }, kOwned,
          "N x 3: the capsule's axis' point that is nearest to it.")
      .def_prop_ro(
          "states",
          [](const Distances& d) {
            return list(d, [](const Answer& a) { return std::string(to_string(a.nearest.state)); });
          },
          "What stands there: measured, occluded, unmeasured, unobserved, outside, beyond_rho, not_evaluated.")
      .def_prop_ro(
          "cameras", [](const Distances& d) { return list(d, [&d](const Answer& a) { return camera_of(d, a); }); },
          "Who measured it, by id; None where nobody did.")
      .def_prop_ro(
          "stale", [](const Distances& d) { return list(d, [](const Answer& a) { return a.nearest.stale; }); },
          "An image behind the answer is older than allowed.")
      .def_ro("reasons", &Distances::reasons, "Words for each, where they were asked for.")
      .def("__repr__",
           [](const Distances& d) { return "<depthgrid.Distances of " + std::to_string(d.answers.size()) + ">"; });
}

}  // namespace depthgrid::python
