#include "depthgrid/monitor/cell_recording.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/whole_file.hpp"
#include "depthgrid/files/mcap_reader.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/monitor/asked_cell.hpp"
#include "depthgrid/monitor/recorded_format.hpp"

namespace depthgrid::monitor {
namespace {

std::string text_of(const std::map<std::string, std::string>& texts, const std::string& key) {
  const auto found = texts.find(key);
  return found == texts.end() ? std::string() : found->second;
}

}  // namespace

struct CellRecording::State {
  explicit State(const std::filesystem::path& path) : file(path), reader(path) {
    const auto& metadata = reader.metadata();
    const auto told = metadata.find(std::string(kRecordedMetadata));
    if (told == metadata.end() || text_of(told->second, "cell").empty()) {
      fail(file.string(),
           ": holds no cell: depthgrid run --record makes such recordings. Of others, name the topics in ",
           "a cell file: {source: recording, recording: ", file.filename().string(), ", topic: ...}");
    }
    texts = told->second;
    const std::string ahead = text_of(texts, "clock_ahead_ns");
    const auto [end, error] = std::from_chars(ahead.data(), ahead.data() + ahead.size(), clock.ahead_ns);
    if (text_of(texts, "version") != "1" || error != std::errc{} || end != ahead.data() + ahead.size()) {
      fail(file.string(), ": was recorded by another version of depthgrid");
    }
  }

  [[nodiscard]] std::vector<files::McapEntry> entries(std::string_view topic) {
    const files::McapChannel* const channel = reader.channel(topic);
    return channel == nullptr ? std::vector<files::McapEntry>() : reader.entries(channel->id);
  }
  [[nodiscard]] std::string description() {
    const auto found = entries(kRecordedDescription);
    return found.empty() ? std::string() : messages::from_bytes<messages::Text>(reader.read(found.front()).data).data;
  }

  std::filesystem::path file;
  mutable files::McapReader reader;
  std::map<std::string, std::string> texts;
  RecordedClock clock;
};

CellRecording::CellRecording(const std::filesystem::path& file) : state_(std::make_unique<State>(file)) {}
CellRecording::~CellRecording() = default;

cell::Cell CellRecording::cell() const {
  constexpr std::uint64_t kLargestUrdf = std::uint64_t{16} << 20U;
  std::error_code ignored;
  const std::filesystem::path was = text_of(state_->texts, "cell_file");
  const bool is_there = std::filesystem::exists(was, ignored);
  const std::filesystem::path name = was.empty() ? std::filesystem::path("cell.yaml") : was.filename();
  cell::Cell cell =
      cell::parse_cell(text_of(state_->texts, "cell"), is_there ? was : state_->file.parent_path() / name);
  if (cell.robot && !cell.robot->is_built_in &&
      read_whole_file(cell.robot->urdf, kLargestUrdf) != state_->description()) {
    fail(state_->file.string(), ": was recorded with another robot than ", cell.robot->urdf, " describes now");
  }
  const std::string rig = text_of(state_->texts, "rig");  // empty: of an earlier version
  const auto with_rig_file = std::find_if(cell.cameras.begin(), cell.cameras.end(),
                                          [](const auto& camera) { return !camera.rig_file.empty(); });
  if (!rig.empty() && with_rig_file != cell.cameras.end() && to_string(cell::setup(cell).rig) != rig) {
    fail(state_->file.string(), ": was recorded with another calibration than ", with_rig_file->rig_file.string(),
         " states now");
  }
  return cell;
}

cell::Cell CellRecording::played() const {
  cell::Cell cell = this->cell();
  for (const files::McapEntry& entry : state_->entries(kRecordedFrames)) {
    const auto moved = messages::from_bytes<messages::Transforms>(state_->reader.read(entry).data);
    if (!moved.transforms.empty()) {
      fail(state_->file.string(), ": camera '", moved.transforms.front().child_frame_id,
           "' moves, and only cameras that stand are played; --again asks the recorded answers");
    }
  }
  for (cell::CameraEntry& camera : cell.cameras) {
    camera.source = cell::SourceKind::recording;
    camera.recording = state_->file;
    camera.recorded_as = camera.name;
    camera.device = recorded_images(camera.name);
    camera.is_silent = state_->entries(camera.device).empty();
    camera.rig_file.clear();
    camera.repeat = false;
    camera.info_topic.clear();
    camera.intrinsics.reset();  // as recorded
  }
  cell.outputs = {};  // nobody steers a robot by what was
  if (cell.robot) {
    cell::JointsEntry& joints = cell.robot->joints;
    joints.source = cell::SourceKind::recording;
    joints.file = state_->file;
    joints.topic = kRecordedJoints;
    joints.repeat = false;
  }
  return cell;
}

std::string CellRecording::damage() const {
  std::string words = state_->reader.damage();
  const auto end = state_->reader.metadata().find(std::string(kRecordedEnd));
  if (end == state_->reader.metadata().end()) {
    return words.empty() ? "its end is missing" : words;
  }
  for (const auto& [key, what] : std::map<std::string, std::string>{
           {"dropped_images", " images"}, {"dropped_joint_states", " joint states"}, {"dropped_answers", " answers"}}) {
    const std::string count = text_of(end->second, key);
    if (!count.empty() && count != "0") {
      words.append(words.empty() ? "" : "; ").append(count).append(what).append(" were dropped when it was recorded");
    }
  }
  return words;
}

AskedAgain CellRecording::ask_again(
    const cell::Cell& cell, const cell::CellSetup& setup,
    const std::function<void(const messages::Distances&, const messages::Distances&)>& heard) {
  if (cell.memory) {
    fail(state_->file.string(),
         ": the cell has a memory, so that its answers stand on every image before, and cannot be ",
         "asked again one by one");
  }
  AskedAgain counts;
  try {
    AskedCell asked(setup, cell.ages.joints_s, state_->reader, state_->clock);
    for (const files::McapEntry& entry : state_->entries(kRecordedDistances)) {
      ++counts.answers;
      const auto recorded = messages::from_bytes<messages::Distances>(state_->reader.read(entry).data);
      const std::optional<messages::Distances> now = asked.ask(recorded, counts);
      if (!now) {
        continue;
      }
      const std::string other = difference(recorded, *now);
      ++(other.empty() ? counts.equal : counts.differ);
      if (counts.first_difference.empty()) {
        counts.first_difference = other;
      }
      if (heard) {
        heard(recorded, *now);
      }
    }
  } catch (const Error& error) {
    fail(state_->file.string(), ": ", error.what());
  }
  return counts;
}

}  // namespace depthgrid::monitor
