// Random COLLADA scenes: as a file, and as the corners that they show, multiplied out here.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "robot/mesh_twin.hpp"

namespace depthgrid::robot {

class RandomScene {
 public:
  std::string text;
  std::vector<Eigen::Vector3d> corners;  ///< metres

  explicit RandomScene(Random& random) : random_(random) {
    for (int i = pick(1, 3); i > 0; --i) {
      surfaces_.emplace_back(random, flip());
    }
    const double unit_m = flip() ? 1.0 : random.uniform(0.001, 2);
    std::ostringstream out = exact_text();
    out << "<?xml version='1.0'?>\n<COLLADA version='1.4.1'><asset><unit name='unit' meter='" << unit_m
        << "'/><up_axis>" << (flip() ? "Y_UP" : "Z_UP") << "</up_axis></asset><library_geometries>";
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      write_geometry(i, out);
    }
    const Node shared = random_node(1, "shared");
    shared_corners_ = shared.corners;
    Node all{"<node><instance_geometry url='#g0'/></node>", surfaces_[0].used()};
    for (int i = pick(1, 3); i > 0; --i) {
      const Node node = random_node(3, "node" + std::to_string(i));
      all.text += node.text;
      all.corners.insert(all.corners.end(), node.corners.begin(), node.corners.end());
    }
    out << "</library_geometries><library_nodes>" << shared.text << "</library_nodes><library_visual_scenes>"
        << "<visual_scene id='other'><node><instance_geometry url='#g0'/></node></visual_scene><visual_scene id='s'>"
        << all.text << "<node><lookat>0 0 1 0 0 0 0 1 0</lookat><instance_camera url='#c'/></node></visual_scene>"
        << "</library_visual_scenes><scene><instance_visual_scene url='#s'/></scene></COLLADA>";
    text = out.str();
    for (const Eigen::Vector3d& corner : all.corners) {
      corners.push_back(unit_m * corner);
    }
  }

 private:
  struct Node {
    std::string text;
    std::vector<Eigen::Vector3d> corners;  ///< in the parent's frame
  };

  int pick(int low, int high) { return random_.integer(low, high); }
  bool flip() { return pick(0, 1) == 0; }
  /// Often so little that a reader may take it for nothing.
  double amount() { return random_.uniform(-1, 1) * std::pow(10.0, -pick(0, 5)); }

  Node random_node(int depth, const std::string& id) {
    Node node;
    std::ostringstream out = exact_text();
    out << "<node id='" << id << "'>";
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    for (int i = pick(0, 3); i > 0; --i) {
      T = T * transform(out);
    }
    for (int i = pick(0, 2); i > 0; --i) {
      const auto surface = static_cast<std::size_t>(pick(0, static_cast<int>(surfaces_.size()) - 1));
      out << "<instance_geometry url='#g" << surface << "'><bind_material/></instance_geometry>";
      const auto used = surfaces_[surface].used();
      node.corners.insert(node.corners.end(), used.begin(), used.end());
    }
    if (depth > 1 && flip()) {
      out << "<instance_node url='#shared'/>";
      node.corners.insert(node.corners.end(), shared_corners_.begin(), shared_corners_.end());
    }
    for (int i = depth > 1 ? pick(0, 2) : 0; i > 0; --i) {
      const Node child = random_node(depth - 1, id + "_" + std::to_string(i));
      out << child.text;
      node.corners.insert(node.corners.end(), child.corners.begin(), child.corners.end());
    }
    out << "</node>";
    node.text = out.str();
    for (Eigen::Vector3d& p : node.corners) {
      p = (T * p.homogeneous()).head<3>();
    }
    return node;
  }

  /// Writes one transform and gives its matrix.
  Eigen::Matrix4d transform(std::ostringstream& out) {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    const Eigen::Vector3d v(amount(), amount(), amount());
    switch (pick(0, 3)) {
      case 0:
        T.topRightCorner<3, 1>() = v;
        out << "<translate sid='t'>" << v.transpose() << "</translate>";
        break;
      case 1:
        T.diagonal().head<3>() += v;
        out << "<scale>" << T.diagonal().head<3>().transpose() << "</scale>";
        break;
      case 2: {  // about one axis, written out
        const int axis = pick(0, 2);
        const double degrees = 90 * amount();
        const double c = std::cos(degrees * std::numbers::pi / 180);
        const double s = std::sin(degrees * std::numbers::pi / 180);
        const int j = (axis + 1) % 3;
        const int k = (axis + 2) % 3;
        T(j, j) = T(k, k) = c;
        T(j, k) = -s;
        T(k, j) = s;
        out << "<rotate>" << 3 * Eigen::Vector3d::Unit(axis).transpose() << " " << degrees << "</rotate>";
        break;
      }
      default:
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 4; ++column) {
            T(row, column) += amount();
          }
        }
        out << "<matrix>" << T.row(0) << " " << T.row(1) << "\n" << T.row(2) << " " << T.row(3) << "</matrix>";
    }
    return T;
  }

  void write_geometry(std::size_t index, std::ostringstream& out) {
    const RandomSurface& surface = surfaces_[index];
    const std::string id = "g" + std::to_string(index);
    const int before = pick(0, 2);  // numbers in the array that are no coordinates
    const int beside = pick(0, 1);
    out << "<geometry id='" << id << "'><mesh><source id='" << id << "n'><float_array id='" << id
        << "na' count='3'>0 0 1</float_array></source><source id='" << id << "p'><float_array id='" << id
        << "pa' count='" << before + static_cast<int>(surface.corners.size()) * (3 + beside) << "'>";
    for (int i = 0; i < before; ++i) {
      out << "77 ";
    }
    const bool turned = flip();  // z before x and y
    for (const Eigen::Vector3d& p : surface.corners) {
      out << (turned ? Eigen::Vector3d(p.z(), p.x(), p.y()) : p).transpose() << (beside == 1 ? " 88\n" : "\n");
    }
    out << "</float_array><technique_common><accessor source='#" << id << "pa' count='" << surface.corners.size()
        << "' stride='" << 3 + beside << "' offset='" << before << "'>";
    for (const char* name : {turned ? "Z" : "X", turned ? "X" : "Y", turned ? "Y" : "Z"}) {
      out << "<param name='" << name << "' type='float'/>";
    }
    out << "</accessor></technique_common></source><vertices id='" << id << "v'><input semantic='POSITION' source='#"
        << id << "p'/></vertices>";
    write_faces(surface, id, out);
    out << "<lines count='0'/></mesh></geometry>";
  }

  void write_faces(const RandomSurface& surface, const std::string& id, std::ostringstream& out) {
    const int offset = pick(0, 2);
    const int stride = pick(offset + 1, 3);
    const auto inputs = [&] {
      for (int i = 0; i < stride; ++i) {
        out << "<input semantic='" << (i == offset ? "VERTEX" : "NORMAL") << "' source='#" << id
            << (i == offset ? "v" : "n") << "' offset='" << i << "'/>";
      }
    };
    const auto corners_of = [&](const std::vector<std::size_t>& face) {
      for (const std::size_t corner : face) {
        for (int i = 0; i < stride; ++i) {
          out << (i == offset ? corner : 0) << " ";
        }
      }
    };
    const char* const many[] = {"polygons", "trifans"};
    if (flip()) {  // each face in an element <p> of its own, or with a hole
      const char* const kind = many[pick(0, 1)];
      out << "<" << kind << " count='" << surface.faces.size() << "'>";
      inputs();
      for (const auto& face : surface.faces) {
        const bool holed = kind == many[0] && flip();
        out << (holed ? "<ph><p>" : "<p>");
        corners_of(face);
        out << (holed ? "</p><h>0 0 0</h></ph>" : "</p>");
      }
      out << "</" << kind << ">";
      return;
    }
    out << "<polylist count='" << surface.faces.size() << "'>";
    inputs();
    out << "<vcount>";
    for (const auto& face : surface.faces) {
      out << face.size() << " ";
    }
    out << "</vcount><p>";
    for (const auto& face : surface.faces) {
      corners_of(face);
    }
    out << "</p></polylist>";
  }

  Random& random_;
  std::vector<RandomSurface> surfaces_;
  std::vector<Eigen::Vector3d> shared_corners_;
};

}  // namespace depthgrid::robot
