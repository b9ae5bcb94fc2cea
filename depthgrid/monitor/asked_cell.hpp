// A cell that is asked again by recorded answers. Internal.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/files/mcap_reader.hpp"
#include "depthgrid/messages/distances.hpp"
#include "depthgrid/messages/image.hpp"
#include "depthgrid/monitor/cell_recording.hpp"
#include "depthgrid/monitor/part_places.hpp"
#include "depthgrid/monitor/recorded_format.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/search/search_evaluator.hpp"

namespace depthgrid::messages {
struct JointState;
}

namespace depthgrid::monitor {

/// Where answers differ first, in words, however little; empty: nowhere. Words are not compared. `now` has the parts of
/// `recorded`.
[[nodiscard]] std::string difference(const messages::Distances& recorded, const messages::Distances& now);

/// The recorded joint states, and a history that gets them one after the other.
class RecordedStates {
 public:
  RecordedStates(std::size_t joints, double longest_s);

  void add(const messages::JointState& state);
  /// The moment at which this state was the newest, which the history holds from now on. A stamp of 0: none was known.
  /// Nothing: it is not in the recording.
  [[nodiscard]] std::optional<robot::JointMoment> moment(std::int64_t stamp_ns, const RecordedClock& clock);
  [[nodiscard]] const robot::JointHistory& history() const noexcept { return history_; }

 private:
  std::size_t joints_;
  robot::JointHistory history_;
  std::size_t added_ = 0;
  std::vector<std::int64_t> stamps_ns_;
  std::vector<double> positions_;
};

/// One thread. Throws Error where the recording is broken, or not of this cell.
class AskedCell {
 public:
  /// All but the clock outlive it. `longest_s`: how long a joint state counts.
  AskedCell(const cell::CellSetup& setup, double longest_s, files::McapReader& reader, const RecordedClock& clock);

  /// As recorded, with the distances of now. Nothing: what it stands on is not there, which is counted.
  [[nodiscard]] std::optional<messages::Distances> ask(const messages::Distances& recorded, AskedAgain& counts);

 private:
  /// The images of one camera, and the one that is asked just now.
  struct Images {
    std::map<std::int64_t, files::McapEntry> by_stamp;
    std::map<std::int64_t, messages::Transform> places;  ///< of a camera that moves
    messages::DepthPixels pixels;
    std::optional<std::int64_t> asked_ns = 0;  ///< 0: none; nothing: not known
  };
  [[nodiscard]] std::vector<files::McapEntry> entries(std::string_view topic);
  [[nodiscard]] std::optional<robot::JointMoment> moment(const messages::Time& stamp);
  void check(const messages::Distances& recorded) const;
  /// Whether the camera's image of that time is what is asked from now on; 0: that there is none.
  [[nodiscard]] bool show(std::size_t camera, std::int64_t stamp_ns, const robot::JointMoment& known);

  const cell::CellSetup& setup_;
  files::McapReader& reader_;
  RecordedClock clock_;
  search::SearchEvaluator evaluator_;
  std::optional<RecordedStates> states_;
  std::optional<robot::FrameIntake> intake_;
  PartPlaces places_;
  std::vector<Capsule> parts_world_;
  std::vector<Answer> parts_;
  std::vector<Images> images_;
};

}  // namespace depthgrid::monitor
