#include "lab/day/received_images.hpp"

#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include "depthgrid/core/error.hpp"
#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {

Received received_images(std::istream& answers, double leave_out_s) {
  // Times are written to the microsecond; images are farther apart.
  constexpr double kSame_s = 1e-4;
  Received received;
  std::optional<double> begin_s;
  std::vector<double> newest_s;
  std::string line;
  for (std::uint64_t n = 1; std::getline(answers, line) && !answers.eof(); ++n) {
    try {
      const auto json = nlohmann::json::parse(line);
      const double time_s = json.at("time_s").get<double>();
      begin_s = begin_s.value_or(time_s);
      if (time_s < *begin_s + leave_out_s) {
        continue;
      }
      ++received.answers;
      received.stopped += json.at("stop").get<bool>() ? 1 : 0;
      received.seconds = time_s - *begin_s - leave_out_s;
      const auto& cameras = json.at("cameras");
      received.cameras.resize(cameras.size());
      newest_s.resize(cameras.size(), std::numeric_limits<double>::quiet_NaN());
      for (std::size_t k = 0; k < cameras.size(); ++k) {
        ReceivedImages& camera = received.cameras[k];
        camera.camera = cameras[k].at("camera").get<std::string>();
        camera.late_share += cameras[k].at("late").get<bool>() ? 1 : 0;
        if (!cameras[k].at("age_s").is_number()) {
          continue;
        }
        const double age_s = cameras[k].at("age_s").get<double>();
        const double image_s = time_s - age_s;
        if (!(image_s <= newest_s[k] + kSame_s)) {
          if (std::isfinite(newest_s[k])) {
            camera.between_s.add(image_s - newest_s[k]);
            camera.age_s.add(age_s);
            ++camera.images;
          }
          newest_s[k] = image_s;
        }
      }
    } catch (const std::exception& error) {
      fail("answers: line ", n, " is none: ", error.what());
    }
  }
  for (ReceivedImages& camera : received.cameras) {
    camera.late_share /= static_cast<double>(received.answers);
  }
  return received;
}

}  // namespace depthgrid::lab
