// depthgrid_msgs/msg/Distances: what a controller stops by, and what a plot shows.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/core/answer.hpp"
#include "depthgrid/messages/geometry.hpp"

namespace depthgrid::messages {

/// depthgrid_msgs/msg/Distance: of one point, sphere or capsule. Metres, in the frame of the message's header. What is
/// not known is NaN, and never a number that compares well.
struct Distance {
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  std::string id;             ///< of the control point or link
  double distance = kNaN;     ///< a lower bound, at the time of the images
  double distance_now = kNaN; /**< the same at the header's stamp, obstacles having moved since; a controller compares
                                   this one, so that NaN stops it: !(distance_now >= limit) */
  std::uint8_t state = 0;     ///< what stands at the nearest point: a ProximityState
  std::string reason;         ///< in words; may be empty
  Point nearest{kNaN, kNaN, kNaN};
  Vector3 direction{kNaN, kNaN, kNaN};  ///< unit vector to the obstacle; 0 where they touch
  Point on_axis{kNaN, kNaN, kNaN};      ///< the capsule's point nearest to `nearest`
  std::string camera;                   ///< that measured it; empty where none did
  double known_to = kNaN;               ///< obstacles farther than this may be missing; NaN: none are
  double blind = kNaN;                  ///< what is nearer to the robot may be missing
  bool stale = false;                   ///< an image behind it was too old
  bool budget = false;                  ///< the search ended early: still a lower bound
};

struct Distances {
  Header header;  ///< the time that distance_now is of, and the frame of all coordinates
  std::vector<Distance> distances;
  std::vector<std::string> cameras;
  std::vector<double> image_ages;  ///< one a camera: seconds from its newest image to the stamp; NaN: there was none
  // What the answer stands on: with it a recording is asked again. A time of 0: there was none, or it is not told.
  std::vector<Time> image_stamps;        ///< one a camera: of its image
  std::vector<Time> image_joint_stamps;  ///< one a camera: the newest joint state known when the robot was taken out
  Time joint_stamp;                      ///< the newest joint state known
  std::uint64_t sequence = 0;            ///< counts answers; gaps are answers that nobody sent
  bool stop = true;
};

/// The same of an answer in the frame of the message. `camera` is the id of nearest.camera, empty where there is none.
[[nodiscard]] Distance distance_of(const Answer& answer, std::string_view id, std::string_view camera,
                                   std::string_view reason = {});

}  // namespace depthgrid::messages
