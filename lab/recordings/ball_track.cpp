#include "lab/recordings/ball_track.hpp"

#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {

BallTrack load_ball_track(const std::filesystem::path& file) {
  constexpr const char* kWhat = "track of the ball";
  const Json json = read_json_file(file, kWhat, {"radius_m", "frames"});
  return taken_apart(file.string(), kWhat, [&json] {
    const auto position = [](const Json& p_m) {
      return Eigen::Vector3d(p_m.at(0).get<double>(), p_m.at(1).get<double>(), p_m.at(2).get<double>());
    };
    BallTrack track;
    track.radius_m = json["radius_m"];
    for (const Json& frame : json["frames"]) {
      const int number = frame.at("frame");
      const Json centre = frame.value("centre_world_m", Json());
      if (centre.is_array() && centre.size() == 3) {
        track.centre_world[number] = position(centre);
      }
      for (const auto& [camera, own] : frame.at("seen").items()) {
        track.fits[number][camera] = {position(own.at("centre_world_m")), own.at("fitted_radius_m").get<double>()};
      }
    }
    return track;
  });
}

std::optional<BallFit> BallTrack::fit(int frame, const std::string& camera) const {
  const auto of_frame = fits.find(frame);
  if (of_frame == fits.end()) {
    return std::nullopt;
  }
  const auto found = of_frame->second.find(camera);
  return found == of_frame->second.end() ? std::nullopt : std::optional<BallFit>(found->second);
}

}  // namespace depthgrid::lab
