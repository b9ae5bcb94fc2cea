// A recording that a running cell made: the cell in it, and its answers asked again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "depthgrid/cell/cell.hpp"
#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/messages/distances.hpp"

namespace depthgrid::monitor {

/// What became of a recording's answers that were asked again.
struct AskedAgain {
  std::uint64_t answers = 0;  ///< in the recording
  std::uint64_t equal = 0;    ///< every number of every part the same, to the bit
  std::uint64_t differ = 0;
  std::uint64_t without_images = 0;  ///< an image that they stand on is not in the recording
  std::uint64_t without_joints = 0;  ///< the same of a joint state
  std::string first_difference{};    ///< "answer 12: lwr_5_link: 0.105 m, recorded 0.107 m"; empty: none
};

/// - Threads: one.
/// - Errors: Error, one line with the file.
class CellRecording {
 public:
  /// Throws Error: no MCAP file, or none of a cell's.
  explicit CellRecording(const std::filesystem::path& file);
  ~CellRecording();
  CellRecording(const CellRecording&) = delete;
  CellRecording& operator=(const CellRecording&) = delete;

  /// The cell as it ran. Relative paths in it begin where its file was, or where that is gone, beside the recording.
  /// Throws Error as parse_cell(), and where the robot's file, or what a rig file states, is another one than the
  /// recorded.
  [[nodiscard]] cell::Cell cell() const;

  /// The same with the recording in place of its cameras and joints. Throws Error where a camera moves.
  [[nodiscard]] cell::Cell played() const;

  /// What is missing of the file, of images and of joint states, in words; empty: nothing.
  [[nodiscard]] std::string damage() const;

  /// Asks each recorded answer again at its own time, with the images and the joint states that it stood on. `heard`,
  /// which may be empty, gets each answer as recorded and as answered now. `setup`: of cell(). Throws Error for a cell
  /// with a memory, whose answers stand on all images before, too.
  [[nodiscard]] AskedAgain ask_again(
      const cell::Cell& cell, const cell::CellSetup& setup,
      const std::function<void(const messages::Distances&, const messages::Distances&)>& heard = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace depthgrid::monitor
