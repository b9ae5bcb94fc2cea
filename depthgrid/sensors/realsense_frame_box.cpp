#include "depthgrid/sensors/realsense_frame_box.hpp"

#include <algorithm>
#include <chrono>
#include <map>

namespace depthgrid::sensors::rs2 {

void FrameBox::put(Frame* frame) noexcept {
  std::unique_lock lock(mutex_);
  if (keeps_order_) {
    has_room_.wait(lock, [this] { return is_closed_ || frames_.size() < kRoom; });
  }
  if (is_closed_) {
    library_->functions().release_frame(frame);
    return;
  }
  if (!keeps_order_ && !frames_.empty()) {  // the newest wins
    library_->functions().release_frame(frames_.front());
    frames_.pop_front();
  }
  frames_.push_back(frame);
  has_frame_.notify_one();
}

Frame* FrameBox::take(double longest_s) {
  std::unique_lock lock(mutex_);
  has_frame_.wait_for(lock, std::chrono::duration<double>(std::max(longest_s, 0.0)),
                      [this] { return !frames_.empty(); });
  if (frames_.empty()) {
    return nullptr;
  }
  Frame* const frame = frames_.front();
  frames_.pop_front();
  has_room_.notify_one();
  return frame;
}

void FrameBox::close() noexcept {
  const std::scoped_lock lock(mutex_);
  is_closed_ = true;
  for (Frame* const frame : frames_) {
    library_->functions().release_frame(frame);
  }
  frames_.clear();
  has_room_.notify_all();
}

namespace {

/// Never destroyed: the library's threads may be there until the process ends.
struct Boxes {
  std::mutex mutex;
  std::uintptr_t last = 0;
  std::map<std::uintptr_t, std::shared_ptr<FrameBox>> by_number;
  std::deque<std::uintptr_t> outliving;
};

Boxes& boxes() {
  // NOLINTNEXTLINE(*owning-memory, *avoid-non-const-global-variables): see above; its mutex guards it
  static auto* const all = new Boxes;
  return *all;
}

}  // namespace

NumberedBox::NumberedBox(std::shared_ptr<FrameBox> box) : box_(std::move(box)) {
  const std::scoped_lock lock(boxes().mutex);
  number_ = ++boxes().last;  // NOLINT(cppcoreguidelines-prefer-member-initializer): under the lock
  boxes().by_number.emplace(number_, box_);
}

NumberedBox::~NumberedBox() {
  constexpr std::size_t kMost = 64;
  box_->close();
  const std::scoped_lock lock(boxes().mutex);
  if (!outlives_) {
    boxes().by_number.erase(number_);
    return;
  }
  boxes().outliving.push_back(number_);
  if (boxes().outliving.size() > kMost) {
    boxes().by_number.erase(boxes().outliving.front());
    boxes().outliving.pop_front();
  }
}

void* NumberedBox::number() const noexcept {
  return reinterpret_cast<void*>(number_);  // NOLINT(*reinterpret-cast,*int-to-ptr): a number, no pointer
}

void NumberedBox::on_frame(Frame* frame, void* number) noexcept {
  std::shared_ptr<FrameBox> box;
  {
    const std::scoped_lock lock(boxes().mutex);
    const auto at = boxes().by_number.find(reinterpret_cast<std::uintptr_t>(number));  // NOLINT(*reinterpret-cast)
    if (at == boxes().by_number.end()) {
      return;  // the frame stays: with its stream the way to the library has gone
    }
    box = at->second;
  }
  box->put(frame);
}

}  // namespace depthgrid::sensors::rs2
