// Meshes as the tests know them: random ones that are written in every format, and slow plain readers.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "robot/robot_support.hpp"

namespace depthgrid::robot {

using Triangles = std::vector<Eigen::Vector3d>;  ///< three corners after the other

/// Of an OBJ or a binary STL, word by word.
inline Triangles plain_read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  Triangles result;
  if (file.extension() == ".stl") {
    in.seekg(80);
    std::uint32_t count = 0;
    in.read(reinterpret_cast<char*>(&count), 4);
    for (std::uint32_t i = 0; i < count; ++i) {
      float numbers[12];
      in.read(reinterpret_cast<char*>(numbers), 48);
      in.ignore(2);
      for (int k = 3; k < 12; k += 3) {
        result.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
      }
    }
    return result;
  }
  std::vector<Eigen::Vector3d> corners;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Eigen::Vector3d p;
      words >> p.x() >> p.y() >> p.z();
      corners.push_back(p);
    } else if (word == "f") {
      std::vector<Eigen::Vector3d> face;
      while (words >> word) {
        face.push_back(corners[std::stoul(word) - 1]);
      }
      for (std::size_t k = 2; k < face.size(); ++k) {
        result.insert(result.end(), {face[0], face[k - 1], face[k]});
      }
    }
  }
  return result;
}

/// A surface of polygons with shared corners.
struct RandomSurface {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::vector<std::size_t>> faces;  ///< indices of corners

  RandomSurface(Random& random, bool triangles) {
    const int count = random.integer(3, 12);
    for (int i = 0; i < count; ++i) {
      corners.push_back(random.in_cube(1));
    }
    for (int i = random.integer(1, 6); i > 0; --i) {
      std::vector<std::size_t> face;
      for (int k = triangles ? 3 : random.integer(3, 5); k > 0; --k) {
        face.push_back(static_cast<std::size_t>(random.integer(0, count - 1)));
      }
      faces.push_back(face);
    }
    faces.push_back({0, 1, 2});  // there is some area
  }

  /// Corners that a face uses.
  [[nodiscard]] std::vector<Eigen::Vector3d> used() const {
    std::vector<Eigen::Vector3d> result;
    for (const auto& face : faces) {
      for (const std::size_t corner : face) {
        result.push_back(corners[corner]);
      }
    }
    return result;
  }
};

inline std::ostringstream exact_text() {
  std::ostringstream text;
  text.precision(17);
  return text;
}

inline std::string obj_text(const RandomSurface& surface, Random& random) {
  std::ostringstream text = exact_text();
  text << "# made by a test\r\nmtllib none.mtl\no thing\n";
  for (const auto& p : surface.corners) {
    text << "v  " << p.transpose() << (random.integer(0, 1) == 0 ? " 1 0 0" : "") << "\nvn 0 0 1\nvt 0 0\n";
  }
  for (const auto& face : surface.faces) {
    text << "f";
    for (const std::size_t corner : face) {
      const auto from_end = static_cast<long>(corner) - static_cast<long>(surface.corners.size());
      const char* const rest[] = {"", "/1", "//1", "/1/1"};
      text << (random.integer(0, 3) == 0 ? " \\\n " : " ")
           << (random.integer(0, 1) == 0 ? static_cast<long>(corner) + 1 : from_end) << rest[random.integer(0, 3)];
    }
    text << (random.integer(0, 1) == 0 ? "\n" : "\r\n");
  }
  return text.str();
}

inline std::string ascii_stl_text(const RandomSurface& surface, Random& random) {
  std::ostringstream text = exact_text();
  const bool capitals = random.integer(0, 1) == 0;
  text << "solid facet vertex 1 2 3\n";
  for (const auto& face : surface.faces) {
    text << (capitals ? "  FACET NORMAL" : "  facet normal") << " nan nan nan\n outer loop\n";
    for (const std::size_t corner : face) {
      text << (capitals ? "VERTEX " : "\tvertex ") << surface.corners[corner].transpose() << "\r\n";
    }
    text << (capitals ? "endloop\nENDFACET\n" : "endloop\nendfacet\n");
  }
  text << "endsolid facet vertex\n";
  return text.str();
}

/// Of triangles; the header may begin like that of a text, and some bytes too many may follow.
inline std::string binary_stl_text(const RandomSurface& surface, Random& random) {
  std::string text = random.integer(0, 1) == 0 ? "solid facet normal" : "exported";
  text.resize(80, random.integer(0, 1) == 0 ? ' ' : '\0');
  const auto count = static_cast<std::uint32_t>(surface.faces.size());
  text.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& face : surface.faces) {
    text.append(12, '\x7f');  // a normal that is no number
    for (const std::size_t corner : face) {
      const Eigen::Vector3f p = surface.corners[corner].cast<float>();
      text.append(reinterpret_cast<const char*>(p.data()), 12);
    }
    text.append(2, '\x55');
  }
  return text.append(static_cast<std::size_t>(random.integer(0, 3)), '?');
}

}  // namespace depthgrid::robot
