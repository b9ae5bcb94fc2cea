// The sound search: images in, distances out.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/reason_text.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "distances.hpp"
#include "parts.hpp"

namespace depthgrid::python {
namespace {

using namespace nb::literals;

using RobotImage = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using RobotImages = std::tuple<RobotImage, RobotImage, double>;

views::Policy policy_of(const std::string& word, const char* name) {
  if (word == "obstacle") {
    return views::Policy::obstacle;
  }
  if (word == "ignored") {
    return views::Policy::ignored;
  }
  fail(name, " is '", word, "'; it is 'obstacle' or 'ignored'");
}

/// An evaluator that any thread may use: one asks at a time, one updates at a time, side by side.
class Evaluator {
 public:
  Evaluator(const Rig& rig, const views::Settings& settings, const search::EvaluatorOptions& options)
      : state_(std::make_unique<State>(rig, settings, options)) {}

  [[nodiscard]] const Rig& rig() const { return state_->evaluator.store().rig(); }

  [[nodiscard]] std::size_t camera(const std::variant<std::int64_t, std::string>& which) const {
    if (const auto* id = std::get_if<std::string>(&which)) {
      return camera_index(rig(), *id);
    }
    const std::int64_t index = std::get<std::int64_t>(which);
    if (index < 0 || index >= static_cast<std::int64_t>(rig().cameras.size())) {
      fail("camera ", index, ": there are ", rig().cameras.size(), ", counted from 0");
    }
    return static_cast<std::size_t>(index);
  }

  void update(std::size_t k, const Frame& frame, const std::optional<Pose>& T_world_camera) {
    FrameUpdate result;
    double before_s = 0;
    {
      const nb::gil_scoped_release others_run;
      const std::scoped_lock alone(state_->updating);
      before_s = state_->image_s[k];
      if (frame.time_s < before_s) {
        result = {UpdateResult::dropped, ""};
      } else {
        result = take(k, frame, T_world_camera);
      }
    }
    if (frame.time_s < before_s) {
      fail("camera '", rig().cameras[k].id, "': an image of ", frame.time_s, " s comes after one of ", before_s,
           " s; images come in the order of their times");
    }
    if (!result.taken()) {
      fail("camera '", rig().cameras[k].id, "': ", result.reason);
    }
  }

  [[nodiscard]] Distances ask(nb::handle array, std::optional<double> now_s, bool reasons) {
    const std::vector<Capsule> capsules = capsules_of(array);
    Distances result;
    result.answers.resize(capsules.size());
    {
      const nb::gil_scoped_release others_run;
      const std::scoped_lock alone(state_->asking);
      const double asked_s = now_s.value_or(state_->newest_s.load());
      state_->evaluator.evaluate(capsules, asked_s, result.answers);
      if (reasons) {
        std::array<char, 240> words{};
        for (const Answer& answer : result.answers) {
          result.reasons.emplace_back(
              reason_text(answer.nearest, state_->evaluator.past(answer.nearest), asked_s, words));
        }
      }
    }
    for (const RigCamera& camera : rig().cameras) {
      result.cameras.push_back(camera.id);
    }
    return result;
  }

 private:
  [[nodiscard]] FrameUpdate take(std::size_t k, const Frame& frame,
                                 const std::optional<Pose>& T_world_camera) noexcept {
    search::SearchEvaluator& evaluator = state_->evaluator;
    const FrameUpdate result =
        T_world_camera ? evaluator.update(k, frame, *T_world_camera) : evaluator.update(k, frame);
    if (result.taken()) {
      state_->image_s[k] = frame.time_s;
      if (!(frame.time_s <= state_->newest_s)) {
        state_->newest_s = frame.time_s;
      }
    }
    return result;
  }

  struct State {
    State(const Rig& rig, const views::Settings& settings, const search::EvaluatorOptions& options)
        : evaluator(rig, settings, options) {
      image_s.fill(-std::numeric_limits<double>::infinity());
    }
    search::SearchEvaluator evaluator;
    std::array<double, views::kMaxCameras> image_s{};  ///< exposure of each camera's newest; of none -infinity
    std::mutex updating;
    std::mutex asking;
    std::atomic<double> newest_s{std::numeric_limits<double>::quiet_NaN()};  ///< exposure; NaN: no image yet
  };
  std::unique_ptr<State> state_;
};

Evaluator make_evaluator(const Rig& rig, nb::handle low, nb::handle high, const std::string& unobserved,
                         const std::string& outside, const std::string& robot_pockets, double ignored_pocket_m,
                         double v_max_m_s, std::optional<double> smallest_obstacle_m, double rho_m, double resolution_m,
                         double max_image_age_s, const std::optional<memory::MemorySettings>& memory) {
  views::Settings settings;
  settings.space = views::BoxSpace{vector_of(low, "low"), vector_of(high, "high")};
  settings.policies = {.unobserved = policy_of(unobserved, "unobserved"),
                       .outside = policy_of(outside, "outside"),
                       .robot_pockets = policy_of(robot_pockets, "robot_pockets"),
                       .ignored_pocket_m = ignored_pocket_m};
  settings.margins = camera_margins(rig);
  for (CameraMargins& margins : settings.margins) {
    margins.smallest_obstacle_m = smallest_obstacle_m.value_or(margins.smallest_obstacle_m);
  }
  settings.rho_m = rho_m;
  settings.resolution_m = resolution_m;
  settings.v_max_m_s = v_max_m_s;
  search::EvaluatorOptions options;
  options.max_image_age_s = max_image_age_s;
  options.memory = memory;
  return {rig, settings, options};
}

/// `robot`: None, or near and far images with the layer's thickness.
void update_camera(Evaluator& self, const std::variant<std::int64_t, std::string>& camera, const AnyArray& depth,
                   double time_s, nb::handle T_world_camera, const std::optional<RobotImages>& robot) {
  const std::size_t k = self.camera(camera);
  const RigCamera& seen_by = self.rig().cameras[k];
  Frame frame;
  frame.depth = depth_of(depth, seen_by.metres_per_unit);
  frame.time_s = time_s;
  if (!std::isfinite(time_s)) {
    fail("camera '", seen_by.id, "': time_s is ", time_s, "; it is the middle of the exposure, in seconds");
  }
  const auto has_size = [&](std::size_t height, std::size_t width) {
    return height == static_cast<std::size_t>(seen_by.intrinsics.height_px) &&
           width == static_cast<std::size_t>(seen_by.intrinsics.width_px);
  };
  if (!has_size(depth.shape(0), depth.shape(1))) {
    fail("camera '", seen_by.id, "': depth has the shape (", depth.shape(0), ", ", depth.shape(1), "), the camera (",
         seen_by.intrinsics.height_px, ", ", seen_by.intrinsics.width_px, ")");
  }
  if (robot) {
    const auto& [near_m, far_m, padding_m] = *robot;
    if (!has_size(near_m.shape(0), near_m.shape(1)) || !has_size(far_m.shape(0), far_m.shape(1))) {
      fail("camera '", seen_by.id, "': the robot's near and far images have another shape than the depth image");
    }
    frame.robot.near_m = near_m.data();
    frame.robot.far_m = far_m.data();
    frame.robot = with_layer(frame.robot, seen_by.intrinsics, padding_m);
  }
  self.update(k, frame,
              T_world_camera.is_none() ? std::nullopt : std::optional(pose_of(T_world_camera, "T_world_camera")));
}

}  // namespace

void add_evaluator(nb::module_& module) {
  nb::class_<Evaluator>(
      module, "SearchEvaluator",
      "Depth images in, distances out: the sound search. Any thread may call any of it; while one computes, "
      "other Python threads run.")
      .def(
          "__init__",
          [](Evaluator* self, const Rig& rig, nb::object low, nb::object high, const std::string& unobserved,
             const std::string& outside, const std::string& robot_pockets, double v_max_m_s, double ignored_pocket_m,
             std::optional<double> smallest_obstacle_m, double rho_m, double resolution_m, double max_image_age_s,
             const std::optional<memory::MemorySettings>& memory) {
            new (self)
                Evaluator(make_evaluator(rig, low, high, unobserved, outside, robot_pockets, ignored_pocket_m,
                                         v_max_m_s, smallest_obstacle_m, rho_m, resolution_m, max_image_age_s, memory));
          },
          "rig"_a, nb::kw_only(), "low"_a, "high"_a, "unobserved"_a, "outside"_a, "robot_pockets"_a, "v_max_m_s"_a,
          "ignored_pocket_m"_a = 0.0, "smallest_obstacle_m"_a = nb::none(), "rho_m"_a = kDefaultRho,
          "resolution_m"_a = 0.005, "max_image_age_s"_a = 0.5, "memory"_a = nb::none(),
          "low, high: corners of the space where obstacles count, world frame, metres.\n"
          "unobserved, outside, robot_pockets: 'obstacle' or 'ignored', for space that no camera looks at, that lies "
          "outside, and that lies right behind the robot (ignored_pocket_m thick).\n"
          "v_max_m_s: nothing moves faster. smallest_obstacle_m: in place of the cameras' own; 0 says nothing.\n"
          "rho_m: nothing farther is looked for. resolution_m: how tight answers are.\n"
          "max_image_age_s: what older images have shown free counts no more. memory: Memory, or None.\n"
          "Raises Error with the value, the rule and a hint.")
      .def("update", &update_camera, "camera"_a, "depth"_a, "time_s"_a, "T_world_camera"_a = nb::none(),
           "robot"_a = nb::none(),
           nb::sig("def update(self, camera: int | str, depth: numpy.typing.NDArray[numpy.uint16] | "
                   "numpy.typing.NDArray[numpy.float32], "
                   "time_s: float, T_world_camera: numpy.typing.ArrayLike | None = None, "
                   "robot: tuple[numpy.typing.NDArray[numpy.float32], numpy.typing.NDArray[numpy.float32], float] | "
                   "None = None) -> None"),
           "A camera's newest image, H x W: uint16 in units of metres_per_unit, float32 in metres; not copied, and not "
           "kept. time_s: the middle of its exposure. T_world_camera: 4 x 4, of a camera that has moved.\n"
           "robot: images of where the padded robot begins and ends in each pixel (0: it is not there), float32 "
           "metres, and "
           "its padding, metres.\n"
           "Raises Error where the image is not taken: of a time before the last one, too. Then the one before counts, "
           "or "
           "nothing of this camera.")
      .def("distances", &Evaluator::ask, "capsules"_a, "now_s"_a = nb::none(), nb::kw_only(), "reasons"_a = false,
           nb::sig("def distances(self, capsules: numpy.typing.ArrayLike, now_s: float | None = None, *, reasons: bool "
                   "= False) -> Distances"),
           "Points (N x 3), spheres (N x 4: centre, radius) or capsules (N x 7: one end, the other end, radius), world "
           "frame, metres.\n"
           "now_s: the time that distance_now_m is for, on the images' clock; None: of the newest image.\n"
           "reasons: makes words for each.")
      .def_prop_ro("rig", &Evaluator::rig);
}

}  // namespace depthgrid::python
