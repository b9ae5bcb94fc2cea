#include "depthgrid/core/cpp_text.hpp"

#include <cmath>

#include "depthgrid/core/number_parsing.hpp"

namespace depthgrid {

std::string cpp_text(double value) {
  if (std::isnan(value)) {
    return "std::numeric_limits<double>::quiet_NaN()";
  }
  if (std::isinf(value)) {
    return std::string(value < 0 ? "-" : "") + "std::numeric_limits<double>::infinity()";
  }
  const std::string text = number_text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;  // -0 would be an int without a sign
}

std::string cpp_text(int value) { return std::to_string(value); }
std::string cpp_text(bool value) { return value ? "true" : "false"; }

std::string cpp_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || code < 0x20 || code >= 0x7F) {
      quoted += '\\';
      for (const unsigned shift : {6U, 3U, 0U}) {
        quoted += static_cast<char>('0' + ((code >> shift) & 7U));
      }
    } else {
      quoted += c;
    }
  }
  quoted += '"';
  // A zero would end the text.
  return text.find('\0') == std::string_view::npos ? quoted
                                                   : "std::string(" + quoted + ", " + std::to_string(text.size()) + ")";
}

std::string cpp_text(const Eigen::Vector3d& value) { return cpp_list(value.x(), value.y(), value.z()); }

std::string cpp_text(const Pose& pose) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      text += (text.empty() ? "" : ", ") + cpp_text(pose.matrix()(row, column));
    }
  }
  return "depthgrid::Pose((Eigen::Matrix4d() << " + text + ").finished())";
}

std::string cpp_text(const CameraMargins& margins) {
  const auto& [sensor, translation_m, rotation_rad, half_exposure_s, time_uncertainty_s, smallest_m, second_view_x_m] =
      margins;
  const auto& [constant_m, linear, quadratic_per_m, lateral_px] = sensor;
  return "depthgrid::CameraMargins{" + cpp_list(constant_m, linear, quadratic_per_m, lateral_px) + ", " +
         cpp_text(translation_m) + ", " + cpp_text(rotation_rad) + ", " + cpp_text(half_exposure_s) + ", " +
         cpp_text(time_uncertainty_s) + ", " + cpp_text(smallest_m) + ", " + cpp_text(second_view_x_m) + "}";
}

}  // namespace depthgrid
