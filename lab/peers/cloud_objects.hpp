// A cloud as objects, by PCL: planes, and clusters of what is left.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <vector>

namespace depthgrid::lab {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

struct ObjectSettings {
  double apart_m = 0.04;   ///< points farther than this from all others of an object are not of it
  double plane_m = 0.02;   ///< how far a plane's points lie from it
  double planes_to = 0.5;  ///< planes are taken out until this share of the points is left
  int least = 20;          ///< points of a plane
};

/// Every point is in one of them. A plane is no object either: it falls apart where its points do.
[[nodiscard]] std::vector<PclCloud::Ptr> objects_of(PclCloud::Ptr cloud, const ObjectSettings& settings);

}  // namespace depthgrid::lab
