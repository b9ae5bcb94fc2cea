#include "lab/peers/hull_peer.hpp"

#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>
extern "C" {
#include <libqhull_r/libqhull_r.h>
}

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

#include "depthgrid/core/error.hpp"
#include "lab/peers/cloud_objects.hpp"

namespace depthgrid::lab {
namespace {

using Object = fcl::CollisionObject<double>;

constexpr double kPointRadius = 1e-3;  ///< a point has no shape in FCL; taken off the distance again
constexpr std::size_t kLeast = 5;      ///< points of a hull; fewer count for themselves

Eigen::Vector3d point_of(const PclCloud& cloud, std::size_t index) {
  return cloud[index].getVector3fMap().cast<double>();
}

/// Joggled, so that flat objects have a hull, too.
std::unique_ptr<Object> hull_of(const PclCloud& cloud) {
  std::vector<double> coordinates;
  coordinates.reserve(3 * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p_world = point_of(cloud, i);
    coordinates.insert(coordinates.end(), p_world.data(), p_world.data() + 3);
  }
  qhT hull;
  qh_zero(&hull, stderr);
  std::array<char, 16> command{"qhull QJ Pp"};
  if (qh_new_qhull(&hull, 3, static_cast<int>(cloud.size()), coordinates.data(), False, command.data(), nullptr,
                   stderr) != 0) {
    fail("qhull: no hull of ", cloud.size(), " points");
  }
  std::map<std::size_t, int> number_of;
  auto corners = std::make_shared<std::vector<fcl::Vector3d>>();
  auto faces = std::make_shared<std::vector<int>>();
  int facets = 0;
  for (const facetT* facet = hull.facet_list; facet->next != nullptr; facet = facet->next, ++facets) {
    faces->push_back(3);
    for (const setelemT* element = &facet->vertices->e[0]; element->p != nullptr; ++element) {
      const auto* vertex = static_cast<const vertexT*>(element->p);
      const auto index = static_cast<std::size_t>(qh_pointid(&hull, vertex->point));
      const auto [at, added] = number_of.try_emplace(index, static_cast<int>(corners->size()));
      if (added) {
        corners->push_back(point_of(cloud, index));
      }
      faces->push_back(at->second);
    }
  }
  qh_freeqhull(&hull, qh_ALL);
  return std::make_unique<Object>(std::make_shared<fcl::Convex<double>>(corners, facets, faces));
}

}  // namespace

struct HullPeer::State {
  std::vector<std::unique_ptr<Object>> hulls;
  std::vector<Eigen::Vector3d> single_world;
  Object sphere{std::make_shared<fcl::Sphere<double>>(kPointRadius)};

  void add(const PclCloud& cloud) {
    if (cloud.size() >= kLeast) {
      hulls.push_back(hull_of(cloud));
      return;
    }
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      single_world.push_back(point_of(cloud, i));
    }
  }
};

HullPeer::HullPeer(const PeerSetting& setting, double voxel_m)
    : cell_(setting.cell),
      rho_m_(setting.rho_m),
      deprojector_(setting.rig),
      voxels_(setting.cell, voxel_m),
      state_(std::make_unique<State>()) {}

HullPeer::~HullPeer() = default;

void HullPeer::prepare(std::span<const Frame> frames, const Region& /*region*/) {
  state_->hulls.clear();
  state_->single_world.clear();
  voxels_.clear();
  const PclCloud::Ptr cloud{new PclCloud};
  deprojector_.run(frames, &cell_, [&](float x, float y, float z) {
    if (voxels_.first(x, y, z)) {
      cloud->push_back({x, y, z});
    }
  });
  for (const PclCloud::Ptr& object : objects_of(cloud, {})) {
    state_->add(*object);
  }
}

void HullPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    const Eigen::Vector3d& p_world = points_world[i];
    double& nearest_m = distances_m[i];
    nearest_m = rho_m_;
    for (const Eigen::Vector3d& q_world : state_->single_world) {
      nearest_m = std::min(nearest_m, (p_world - q_world).norm());
    }
    state_->sphere.setTranslation(p_world);
    state_->sphere.computeAABB();
    for (const auto& hull : state_->hulls) {
      if (hull->getAABB().distance(state_->sphere.getAABB()) >= nearest_m) {
        continue;
      }
      fcl::DistanceResult<double> result;
      const double distance_m = fcl::distance(&state_->sphere, hull.get(), fcl::DistanceRequest<double>(), result);
      nearest_m = std::min(nearest_m, distance_m > 0 ? distance_m + kPointRadius : 0.0);
    }
  }
}

}  // namespace depthgrid::lab
