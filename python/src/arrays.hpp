// numpy arrays in and out: what is taken without a copy, and what is refused with the reason.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::python {

namespace nb = nanobind;

using AnyArray = nb::ndarray<nb::ro, nb::device::cpu>;
using Doubles = nb::ndarray<nb::numpy, double>;

/// A depth image of H x W, uint16 (times metres_per_unit) or float32 (metres), in the caller's memory: rows may be
/// apart, the pixels of a row may not. Throws Error with what is wrong and the way out.
[[nodiscard]] DepthView depth_of(const AnyArray& image, double metres_per_unit);

/// Points (N x 3), spheres (N x 4: centre, radius) or capsules (N x 7: one end, the other end, radius): world frame,
/// metres. Anything that numpy makes such an array of. Throws Error.
[[nodiscard]] std::vector<Capsule> capsules_of(nb::handle array);

/// 4 x 4, from anything that numpy makes such an array of. Throws Error as pose_from_matrix().
[[nodiscard]] Pose pose_of(nb::handle matrix, const char* name);
[[nodiscard]] Eigen::Vector3d vector_of(nb::handle array, const char* name);

/// N, or N x columns, that Python owns.
[[nodiscard]] Doubles doubles(std::vector<double> values, std::size_t columns);

}  // namespace depthgrid::python
