#include "depthgrid/simulation/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/image_bounds.hpp"

namespace depthgrid::simulation {

namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// The ray through the centre of pixel (u, v) in the camera frame, scaled so that its parameter is the depth.
Line centre_ray(const PinholeCamera& camera, int u, int v) {
  return {Eigen::Vector3d::Zero(), deproject(camera, {u + 0.5, v + 0.5, 1.0})};
}

/// Calls visit(pixel index, depth interval in front of the camera) for all pixels whose ray meets `shape` (camera
/// frame).
template <class Shape, class Visit>
void cast(const PinholeCamera& camera, const Shape& shape, Visit&& visit) {
  const PixelBounds bounds = image_bounds(camera, shape);
  for (int v = bounds.v_begin; v < bounds.v_end; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width_px);
    for (int u = bounds.u_begin; u < bounds.u_end; ++u) {
      const Interval z = intersect(shape, centre_ray(camera, u, v));
      if (!z.empty() && z.exit > 0) {
        visit(row + static_cast<std::size_t>(u), z);
      }
    }
  }
}

struct PixelInterval {
  std::size_t pixel;
  Interval z_m;
};

/// For each pixel the contiguous part of the union of its intervals that holds the first surface of the robot itself;
/// the first part where the ray meets the padding only. Reorders `intervals`. An infinite surface means none.
void merge(std::vector<PixelInterval>& intervals, const std::vector<double>& robot_surface_m, DepthImage& near_m,
           DepthImage& far_m) {
  std::sort(intervals.begin(), intervals.end(), [](const PixelInterval& a, const PixelInterval& b) {
    return a.pixel != b.pixel ? a.pixel < b.pixel : a.z_m.entry < b.z_m.entry;
  });
  for (std::size_t i = 0; i < intervals.size();) {
    const std::size_t pixel = intervals[i].pixel;
    Interval part = intervals[i].z_m;
    for (++i; i < intervals.size() && intervals[i].pixel == pixel; ++i) {
      const Interval& next = intervals[i].z_m;
      if (next.entry <= part.exit) {
        part.exit = std::max(part.exit, next.exit);
      } else if (std::isfinite(robot_surface_m[pixel]) && part.exit < robot_surface_m[pixel]) {
        part = next;  // the ray left this part before it met the robot itself
      } else {
        break;
      }
    }
    while (i < intervals.size() && intervals[i].pixel == pixel) {
      ++i;
    }
    near_m.data()[pixel] = static_cast<float>(std::max<double>(part.entry, std::numeric_limits<float>::min()));
    far_m.data()[pixel] = static_cast<float>(part.exit);
  }
}

}  // namespace

void Scene::add(const Plane& plane, Body body) {
  validate(plane);
  planes_.push_back({plane, body});
}
void Scene::add(const Box& box, Body body) {
  validate(box);
  boxes_.push_back({box, body});
}
void Scene::add(const Sphere& sphere, Body body) {
  validate(sphere);
  spheres_.push_back({sphere, body});
}
void Scene::add(const Capsule& capsule, Body body) {
  validate(capsule);
  capsules_.push_back({capsule, body});
}

template <class Visit>
void Scene::for_each(Visit&& visit) const {
  const auto each = [&visit](const auto& items) {
    for (const auto& item : items) {
      visit(item.shape, item.body);
    }
  };
  each(planes_);
  each(boxes_);
  each(spheres_);
  each(capsules_);
}

View Scene::render(const PinholeCamera& camera, const Pose& T_world_camera, double robot_padding_m) const {
  depthgrid::validate(camera);
  if (!(std::isfinite(robot_padding_m) && robot_padding_m >= 0)) {
    fail("robot padding is ", robot_padding_m, " m, must be finite and not negative");
  }
  const Pose T_camera_world = T_world_camera.inverse(Eigen::Isometry);
  View view{DepthImage(camera.width_px, camera.height_px), DepthImage(camera.width_px, camera.height_px),
            DepthImage(camera.width_px, camera.height_px)};
  const std::size_t pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  float* const depth_m = view.depth_m.data();
  std::fill_n(depth_m, pixels, kNothing);

  bool inside = false;
  std::vector<PixelInterval> robot;
  std::vector<double> robot_surface_m(pixels, std::numeric_limits<double>::infinity());
  for_each([&](const auto& shape_world, Body body) {
    const auto shape = transformed(T_camera_world, shape_world);
    inside = inside || simulation::contains(shape, Eigen::Vector3d::Zero());
    cast(camera, shape, [depth_m](std::size_t pixel, const Interval& z) {
      depth_m[pixel] = std::min(depth_m[pixel], static_cast<float>(z.entry));
    });
    if (body == Body::robot) {
      cast(camera, shape, [&robot_surface_m](std::size_t pixel, const Interval& z) {
        robot_surface_m[pixel] = std::min(robot_surface_m[pixel], z.entry);
      });
      cast(camera, grown(shape, robot_padding_m), [&robot](std::size_t pixel, const Interval& z) {
        robot.push_back({pixel, z});
      });
    }
  });
  std::for_each(depth_m, depth_m + pixels, [inside](float& z) { z = !inside && z > 0 && z < kNothing ? z : 0.0F; });
  merge(robot, robot_surface_m, view.robot_near_m, view.robot_far_m);
  return view;
}

SceneDistance Scene::distance(const Eigen::Vector3d& p_world) const noexcept {
  SceneDistance result{std::numeric_limits<double>::infinity(),
                       Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  for_each([&](const auto& shape, Body body) {
    if (body == Body::obstacle) {
      const Eigen::Vector3d nearest = nearest_point(shape, p_world);
      const double distance_m = (nearest - p_world).norm();
      if (distance_m < result.distance_m) {
        result = {distance_m, nearest};
      }
    }
  });
  return result;
}

bool Scene::contains(const Eigen::Vector3d& p_world, Body body) const noexcept {
  bool inside = false;
  for_each([&](const auto& shape, Body shape_body) {
    inside = inside || (shape_body == body && simulation::contains(shape, p_world));
  });
  return inside;
}

}  // namespace depthgrid::simulation
