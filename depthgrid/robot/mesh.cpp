#include "depthgrid/robot/mesh.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

std::vector<Eigen::Vector3d> mesh_points(const std::filesystem::path& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_PreTransformVertices);
  if (scene == nullptr) {
    fail(file.string(), ": no mesh can be read: ", importer.GetErrorString());
  }
  std::vector<Eigen::Vector3d> points;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      points.emplace_back(p.x, p.y, p.z);
      if (!points.back().allFinite()) {
        fail(file.string(), ": a corner is (", points.back().transpose(), "), must be finite");
      }
    }
  }
  if (points.empty()) {
    fail(file.string(), ": the mesh has no corner");
  }
  return points;
}

}  // namespace depthgrid::robot
