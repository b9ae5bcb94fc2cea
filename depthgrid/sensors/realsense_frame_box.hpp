// Frames on their way from librealsense2's threads to the source's. Private.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

#include "depthgrid/sensors/realsense_library.hpp"

namespace depthgrid::sensors::rs2 {

/// Frames on their way from the library's thread to the source's. Either the newest one, or, for recordings, some in
/// order: then the library's thread waits.
class FrameBox {
 public:
  FrameBox(std::shared_ptr<const Library> library, bool keeps_order)
      : library_(std::move(library)), keeps_order_(keeps_order) {}
  ~FrameBox() { close(); }
  FrameBox(const FrameBox&) = delete;
  FrameBox& operator=(const FrameBox&) = delete;

  void put(Frame* frame) noexcept;  ///< takes the frame
  [[nodiscard]] Frame* take(double longest_s);
  void close() noexcept;  ///< frames that come from now on are given back at once

 private:
  static constexpr std::size_t kRoom = 8;
  std::shared_ptr<const Library> library_;
  const bool keeps_order_;
  std::mutex mutex_;
  std::condition_variable has_frame_;
  std::condition_variable has_room_;
  std::deque<Frame*> frames_;
  bool is_closed_ = false;
};

/// The box that a number stands for, since the library may put a frame in when the stream has ended. A box whose stream
/// the library was seen to stop is forgotten with it; of the others, which give frames back at once, the newest stay.
class NumberedBox {
 public:
  explicit NumberedBox(std::shared_ptr<FrameBox> box);
  ~NumberedBox();
  NumberedBox(const NumberedBox&) = delete;
  NumberedBox& operator=(const NumberedBox&) = delete;

  [[nodiscard]] FrameBox& operator*() const noexcept { return *box_; }
  [[nodiscard]] FrameBox* operator->() const noexcept { return box_.get(); }
  /// What the library is to be given.
  [[nodiscard]] void* number() const noexcept;
  /// The library may call from now on although its stream ends.
  void outlives(bool it_does) noexcept { outlives_ = it_does; }
  static void on_frame(Frame* frame, void* number) noexcept;

 private:
  std::shared_ptr<FrameBox> box_;
  std::uintptr_t number_ = 0;
  bool outlives_ = false;
};

}  // namespace depthgrid::sensors::rs2
