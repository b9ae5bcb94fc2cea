#include "arrays.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::python {
namespace {

using DoublesIn = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

constexpr std::size_t kLargestSide = static_cast<std::size_t>(kLargestImageSide);

std::string shape_of(const DoublesIn& array) {
  std::string text = "(";
  for (std::size_t i = 0; i < array.ndim(); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return text + (array.ndim() == 1 ? ",)" : ")");
}

/// As it is where it is double and in one piece, else a copy.
DoublesIn as_doubles(nb::handle array, const char* name) {
  DoublesIn result;
  if (nb::try_cast(array, result, false)) {
    return result;
  }
  try {
    const nb::object copied =
        nb::module_::import_("numpy").attr("ascontiguousarray")(array, nb::arg("dtype") = "float64");
    return nb::cast<DoublesIn>(copied);
  } catch (const nb::python_error& error) {
    fail(name, ": ", error.what());
  } catch (const nb::cast_error&) {
    fail(name, ": is no array of numbers");
  }
}

/// Of a float image, by some of its pixels: whether it is in millimetres. Nothing that is measured is so far away.
bool is_in_millimetres(const DepthView& view) {
  constexpr int kSteps = 16;
  constexpr float kFarthest_m = 100;
  int far = 0;
  int all = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const std::ptrdiff_t v = static_cast<std::ptrdiff_t>(i / kSteps) * view.height_px / kSteps;
    const std::ptrdiff_t u = static_cast<std::ptrdiff_t>(i % kSteps) * view.width_px / kSteps;
    const float depth = reinterpret_cast<const float*>(static_cast<const char*>(view.data) + v * view.stride_bytes)[u];
    all += std::isfinite(depth) && depth > 0 ? 1 : 0;
    far += std::isfinite(depth) && depth > kFarthest_m ? 1 : 0;
  }
  return 2 * far > all;
}

}  // namespace

DepthView depth_of(const AnyArray& image, double metres_per_unit) {
  if (image.ndim() != 2) {
    fail("depth has ", image.ndim(), " dimensions; it is an image of H x W: depth[:, :, 0] of one with channels");
  }
  const bool is_units = image.dtype() == nb::dtype<std::uint16_t>();
  if (!is_units && image.dtype() != nb::dtype<float>()) {
    fail(
        "depth is neither uint16 (in units of metres_per_unit) nor float32 (metres): depth.astype(numpy.float32) where "
        "it is metres");
  }
  const auto size = static_cast<std::ptrdiff_t>(is_units ? sizeof(std::uint16_t) : sizeof(float));
  const auto width = static_cast<std::ptrdiff_t>(image.shape(1));
  if (image.shape(0) == 0 || width == 0 || image.shape(0) > kLargestSide || image.shape(1) > kLargestSide) {
    fail("depth has a shape of (", image.shape(0), ", ", image.shape(1), "); sides are 1 to ", kLargestSide);
  }
  if ((width > 1 && image.stride(1) != 1) || (image.shape(0) > 1 && image.stride(0) < width)) {
    fail("depth's pixels do not lie side by side, row below row: numpy.ascontiguousarray(depth)");
  }
  DepthView view;
  view.data = image.data();
  view.format = is_units ? DepthFormat::uint16_units : DepthFormat::float32_metres;
  view.width_px = static_cast<int>(width);
  view.height_px = static_cast<int>(image.shape(0));
  view.stride_bytes = (image.shape(0) > 1 ? image.stride(0) : width) * size;
  view.metres_per_unit = metres_per_unit;
  if (!is_units && is_in_millimetres(view)) {
    fail("depth is float32, so metres, and most of it is farther than 100 m: is it in millimetres? depth / 1000");
  }
  return view;
}

std::vector<Capsule> capsules_of(nb::handle array) {
  const DoublesIn values = as_doubles(array, "capsules");
  const std::size_t columns = values.ndim() == 2 ? values.shape(1) : 0;
  if (columns != 3 && columns != 4 && columns != 7) {
    fail("capsules have the shape ", shape_of(values),
         "; points are N x 3, spheres N x 4 (centre, radius), capsules N x 7 (one end, the other end, radius), metres");
  }
  std::vector<Capsule> capsules(values.shape(0));
  const double* row = values.data();
  for (Capsule& capsule : capsules) {
    const Eigen::Vector3d a(row[0], row[1], row[2]);
    capsule = columns == 3   ? Capsule::point(a)
              : columns == 4 ? Capsule::sphere(a, row[3])
                             : Capsule{a, {row[3], row[4], row[5]}, row[6]};
    row += columns;
  }
  return capsules;
}

Pose pose_of(nb::handle matrix, const char* name) {
  const DoublesIn values = as_doubles(matrix, name);
  if (values.ndim() != 2 || values.shape(0) != 4 || values.shape(1) != 4) {
    fail(name, " has the shape ", shape_of(values), "; it is a 4 x 4 matrix, metres");
  }
  return pose_from_matrix(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data()), name);
}

Eigen::Vector3d vector_of(nb::handle array, const char* name) {
  const DoublesIn values = as_doubles(array, name);
  if (values.ndim() != 1 || values.shape(0) != 3) {
    fail(name, " has the shape ", shape_of(values), "; it is three numbers, metres");
  }
  return {values.data()[0], values.data()[1], values.data()[2]};
}

Doubles doubles(std::vector<double> values, std::size_t columns) {
  auto* const kept = new std::vector<double>(std::move(values));
  const nb::capsule owner(kept, [](void* data) noexcept { delete static_cast<std::vector<double>*>(data); });
  const std::size_t shape[2] = {kept->size() / columns, columns};
  return {kept->data(), columns == 1 ? std::size_t{1} : std::size_t{2}, shape, owner};
}

}  // namespace depthgrid::python
