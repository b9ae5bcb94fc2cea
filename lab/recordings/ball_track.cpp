#include "lab/recordings/ball_track.hpp"

#include <rapidjson/document.h>
#include <rapidjson/istreamwrapper.h>

#include <cstdlib>
#include <fstream>

#include "depthgrid/core/error.hpp"

namespace depthgrid::lab {

BallTrack load_ball_track(const std::filesystem::path& file) {
  std::ifstream stream(file);
  rapidjson::IStreamWrapper wrapper(stream);
  rapidjson::Document json;
  json.ParseStream(wrapper);
  if (!stream.is_open() || json.HasParseError() || !json.IsObject() || !json.HasMember("radius_m") ||
      !json.HasMember("frames")) {
    fail("cannot read the ball's track from ", file.string());
  }
  BallTrack track;
  track.radius_m = json["radius_m"].GetDouble();
  for (const auto& frame : json["frames"].GetArray()) {
    const auto& centre = frame["centre_world_m"];
    if (centre.IsArray() && centre.Size() == 3) {
      track.centre_world[frame["frame"].GetInt()] = {centre[0].GetDouble(), centre[1].GetDouble(),
                                                     centre[2].GetDouble()};
    }
    for (const auto& seen : frame["seen"].GetObject()) {
      const auto& own = seen.value["centre_world_m"];
      track.fits[frame["frame"].GetInt()][seen.name.GetString()] = {
          {own[0].GetDouble(), own[1].GetDouble(), own[2].GetDouble()}, seen.value["fitted_radius_m"].GetDouble()};
    }
  }
  return track;
}

std::optional<BallFit> BallTrack::fit(int frame, const std::string& camera) const {
  const auto of_frame = fits.find(frame);
  if (of_frame == fits.end()) {
    return std::nullopt;
  }
  const auto found = of_frame->second.find(camera);
  return found == of_frame->second.end() ? std::nullopt : std::optional<BallFit>(found->second);
}

std::filesystem::path recording_folder(const std::string& name) {
  const char* data = std::getenv("DEPTHGRID_DATA");
  return std::filesystem::path(data != nullptr && *data != '\0' ? data : "../shared/data") / name;
}

}  // namespace depthgrid::lab
