#include "lab/peers/cloud_objects.hpp"

#include <pcl/common/io.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

namespace depthgrid::lab {
namespace {

constexpr int kMostPlanes = 6;

PclCloud::Ptr part_of(const PclCloud& cloud, const pcl::Indices& indices) {
  PclCloud::Ptr part{new PclCloud};
  pcl::copyPointCloud(cloud, indices, *part);
  return part;
}

PclCloud::Ptr without(const PclCloud& cloud, const pcl::Indices& indices) {
  std::vector<bool> taken(cloud.size(), false);
  for (const int index : indices) {
    taken[static_cast<std::size_t>(index)] = true;
  }
  PclCloud::Ptr rest{new PclCloud};
  rest->reserve(cloud.size() - indices.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!taken[i]) {
      rest->push_back(cloud[i]);
    }
  }
  return rest;
}

void add_clusters(const PclCloud::Ptr& cloud, double apart_m, std::vector<PclCloud::Ptr>& objects) {
  if (cloud->empty()) {
    return;
  }
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree{new pcl::search::KdTree<pcl::PointXYZ>};
  tree->setInputCloud(cloud);
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setClusterTolerance(apart_m);
  extraction.setMinClusterSize(1);
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(cloud);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  objects.reserve(objects.size() + clusters.size());
  for (const pcl::PointIndices& cluster : clusters) {
    objects.push_back(part_of(*cloud, cluster.indices));
  }
}

}  // namespace

std::vector<PclCloud::Ptr> objects_of(PclCloud::Ptr cloud, const ObjectSettings& settings) {
  std::vector<PclCloud::Ptr> objects;
  pcl::SACSegmentation<pcl::PointXYZ> planes;
  planes.setModelType(pcl::SACMODEL_PLANE);
  planes.setMethodType(pcl::SAC_RANSAC);
  planes.setDistanceThreshold(settings.plane_m);
  planes.setMaxIterations(100);
  const auto enough = static_cast<std::size_t>(settings.planes_to * static_cast<double>(cloud->size()));
  for (int n = 0; n < kMostPlanes && cloud->size() > enough; ++n) {
    pcl::PointIndices inliers;
    pcl::ModelCoefficients plane;
    planes.setInputCloud(cloud);
    planes.segment(inliers, plane);
    if (std::ssize(inliers.indices) < settings.least) {
      break;
    }
    add_clusters(part_of(*cloud, inliers.indices), settings.apart_m, objects);
    cloud = without(*cloud, inliers.indices);
  }
  add_clusters(cloud, settings.apart_m, objects);
  return objects;
}

}  // namespace depthgrid::lab
