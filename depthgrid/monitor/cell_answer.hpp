// One answer of a running cell: distances, and what they stand on.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/avoidance/motion_reason.hpp"
#include "depthgrid/core/answer.hpp"
#include "depthgrid/core/capsule.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::monitor {

/// What a camera does just now.
enum class CameraState : std::uint8_t {
  opening,      ///< not open yet, or being opened again
  waiting,      ///< open, and no image so far
  live,         ///< its newest image is used
  no_reading,   ///< it is used, and shows nothing: not one of its pixels has a reading
  unusable,     ///< its newest image cannot be used: another size, another scale
  wrong_clock,  ///< its images are from the future, or older than counts: refused
  frozen,       ///< it repeats the same pixels with new times: refused
  failed,       ///< lost; it is opened again after a while
  ended,        ///< a recording is at its end
  silent,       ///< open, and no image for longer than images count
};

/// "opening", "waiting", "live", ...
[[nodiscard]] std::string_view to_string(CameraState state) noexcept;

/// What an answer stands on of one camera. Seconds.
struct CameraBasis {
  CameraState state = CameraState::opening;
  double image_s = Proximity::kNaN;          ///< when its image was exposed; NaN: there is none
  double age_s = Proximity::kNaN;            ///< of its image; NaN: there is none
  double without_reading = Proximity::kNaN;  ///< share of that image's pixels
  bool late = true;                          ///< it frees nothing: no image, or too old a one
};

/// Why an answer is what it is, as numbers: sentence() makes words of it.
struct Reason {
  avoidance::MotionLimit limit = avoidance::MotionLimit::no_images;
  std::optional<std::size_t> part{};  ///< the one with least room, or the first without a distance
  Proximity nearest{};                ///< of that part
  double distance_m = Proximity::kNaN;
  double clear_m = Proximity::kNaN;  ///< the distance less the blind layer, not below 0
  double blind_m = Proximity::kNaN;
  double stop_m = 0;
  double clear_s = 0;  ///< above 0: nothing is too near any more since then, the stop is held
  double v_max_m_s = 0;
  double reaction_s = Proximity::kNaN;      ///< from the newest exposure to the answer
  double part_motion_m = Proximity::kNaN;   ///< how far the part may have moved since its joint state
  double part_speed_m_s = Proximity::kNaN;  ///< of its ends, over the last 0.1 to 0.2 s; NaN: not known yet
  std::optional<std::size_t> camera{};      ///< the first that is not live or whose image is late
  CameraState camera_state = CameraState::live;
  double camera_age_s = Proximity::kNaN;
  double joints_age_s = Proximity::kNaN;
};

/// - Units and frame: metres, seconds on the sources' clock, world.
/// - Vectors have one element a part, in the order of the settings, whose names they are.
struct CellAnswer {
  std::uint64_t sequence = 0;           ///< from 1; gaps are answers that this output passed over
  double time_s = Proximity::kNaN;      ///< that the answers are for
  double done_s = Proximity::kNaN;      ///< when they were there
  double exposure_s = Proximity::kNaN;  ///< the newest one behind them
  bool stop = true;                     ///< unless every part's clear distance is above stop_m
  double distance_m = Proximity::kNaN;  ///< the least of all parts; NaN when one has none
  double clear_m = Proximity::kNaN;     ///< the least distance less blind layer; NaN likewise
  double blind_m = Proximity::kNaN;     ///< the thickest layer
  double skew_s = Proximity::kNaN;      ///< between the oldest and the newest image that count
  double joints_s = Proximity::kNaN;    ///< of the newest joint state; NaN: there is none
  double joints_age_s = 0;              ///< its age; 0 without a robot
  std::size_t camera_count = 0;
  std::array<CameraBasis, views::kMaxCameras> cameras{};
  Reason reason;
  std::vector<Answer> parts;
  std::vector<Capsule> parts_world;
};

/// What the numbers of answers and events are called.
struct Names {
  std::string cell;
  std::vector<std::string> cameras;
  std::vector<std::string> parts;
};

/// One sentence: "lwr_5_link is 0.052 m from a surface seen by left, ...". At most as long as the buffer; 480
/// characters and the names are enough. Locks and allocates nothing.
[[nodiscard]] std::string_view sentence(const Reason& reason, const Names& names, std::span<char> buffer) noexcept;

}  // namespace depthgrid::monitor
