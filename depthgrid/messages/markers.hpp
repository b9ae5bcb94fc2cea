// visualization_msgs/msg/MarkerArray: shapes for rviz2 and other viewers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/messages/compressed_image.hpp"
#include "depthgrid/messages/geometry.hpp"

namespace depthgrid::messages {

/// visualization_msgs/msg/UVCoordinate.
struct TexturePoint {
  float u = 0;
  float v = 0;
};

/// visualization_msgs/msg/MeshFile. `data` is not owned.
struct MeshFile {
  std::string filename;
  std::span<const std::byte> data;
};

/// visualization_msgs/msg/Marker. What `scale`, `points` and `colors` mean depends on `type`; metres.
struct Marker {
  enum Type : std::int32_t {
    arrow = 0,
    cube = 1,
    sphere = 2,
    cylinder = 3,
    line_strip = 4,
    line_list = 5,
    cube_list = 6,
    sphere_list = 7,
    points_type = 8,
    text_view_facing = 9,
    mesh_resource_type = 10,
    triangle_list = 11,
  };
  enum Action : std::int32_t { add = 0, remove = 2, remove_all = 3 };

  Header header;
  std::string ns;       ///< with `id` the marker's name
  std::int32_t id = 0;  ///< a second marker of the same name replaces the first
  std::int32_t type = arrow;
  std::int32_t action = add;
  PoseMessage pose;
  Vector3 scale;
  Color color;
  Duration lifetime;  ///< 0: until it is removed
  bool frame_locked = false;
  std::vector<Point> points;
  std::vector<Color> colors;
  std::string texture_resource;
  CompressedImage texture;
  std::vector<TexturePoint> uv_coordinates;
  std::string text;
  std::string mesh_resource;
  MeshFile mesh_file;
  bool mesh_use_embedded_materials = false;
};

struct Markers {
  std::vector<Marker> markers;
};

}  // namespace depthgrid::messages
