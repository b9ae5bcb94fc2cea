// Images arrive while others ask: what a snapshot shows is whole, and stays as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <iostream>
#include <thread>

#include "depthgrid/views/prepared_image.hpp"
#include "depthgrid/views/view_store.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"

namespace depthgrid::views {
namespace {

constexpr int kWidth = 37;
constexpr int kHeight = 21;
constexpr std::size_t kCameras = 3;
constexpr int kReaders = 3;

ViewStore make_store() {
  Rig rig{.name = "cell", .cameras = std::vector<RigCamera>(kCameras), .T_floor_world = {}};
  for (std::size_t k = 0; k < kCameras; ++k) {
    rig.cameras[k].id = std::to_string(k);
    rig.cameras[k].intrinsics = {kWidth, kHeight, 30, 30, 18, 10};
  }
  Settings settings;
  settings.space = BoxSpace{{-1, -1, 0}, {1, 1, 2}};
  settings.policies = {Policy::obstacle, Policy::ignored, Policy::obstacle, 0};
  settings.margins.resize(kCameras);
  for (CameraMargins& margins : settings.margins) {
    margins.sensor.lateral_px = 0;
    margins.smallest_obstacle_m = 0;
  }
  settings.v_max_m_s = 2;
  return ViewStore(rig, settings, kReaders);
}

/// Depth, robot, pose and time of frame n; all of them tell n.
class NumberedFrame {
 public:
  NumberedFrame() : metres_(kWidth * kHeight), near_m_(metres_.size()), far_m_(metres_.size()) {}
  Frame set(int n) {
    std::fill(metres_.begin(), metres_.end(), static_cast<float>(n));
    // An island behind the wall.
    std::fill(near_m_.begin(), near_m_.end(), static_cast<float>(n) + 0.25F);
    std::fill(far_m_.begin(), far_m_.end(), static_cast<float>(n) + 0.5F);
    return {depth_view(metres_, kWidth, kHeight), {near_m_.data(), far_m_.data(), kWidth}, 0.001 * n};
  }
  static Pose pose(int n) {
    Pose pose = Pose::Identity();
    pose.translation().x() = 0.001 * n;
    return pose;
  }

 private:
  std::vector<float> metres_, near_m_, far_m_;
};

/// The frame's number; -1 when parts of the view come from different frames.
int number_of(const View& view) {
  if (!view.present()) {
    return 0;
  }
  const PreparedImage& image = prepared(view);
  const float depth_m = view.free_m(0, 0);
  const int number = static_cast<int>(depth_m);
  bool whole =
      view.time_s() == 0.001 * number && view.T_world_camera().translation().x() == 0.001 * number && image.has_islands;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      whole = whole && view.free_m(u, v) == depth_m && view.measured_m(u, v) == depth_m &&
              image.island_near_m.at(u, v) == depth_m + 0.25F && image.island_far_m.at(u, v) == depth_m + 0.5F;
    }
  }
  const PyramidLevel& top = image.levels.back();
  const std::size_t texels = top.offset + static_cast<std::size_t>(top.width) * static_cast<std::size_t>(top.height);
  for (std::size_t i = 0; i < texels; ++i) {
    whole = whole && image.minima_m[i] == depth_m && image.second_near_maxima_m[i] == depth_m + 0.25F &&
            image.second_far_minima_m[i] == depth_m + 0.5F;
  }
  return whole ? number : -1;
}

struct Tally {
  std::int64_t broken = 0;     ///< views made of several frames
  std::int64_t backwards = 0;  ///< views older than in the snapshot before
  std::int64_t changed = 0;    ///< views that were overwritten while held
  std::int64_t wrong_margins = 0;
};

/// Takes snapshots until told to stop, holding each for a while.
void read(const ViewStore& store, const std::atomic<bool>& stop, std::atomic<std::int64_t>& taken, Tally& tally) {
  std::array<int, kCameras> newest{};
  while (!stop.load()) {
    const Snapshot snapshot = store.snapshot();
    std::array<int, kCameras> numbers{};
    for (std::size_t k = 0; k < kCameras; ++k) {
      numbers[k] = number_of(snapshot.view(k));
      tally.broken += numbers[k] < 0 ? 1 : 0;
      tally.backwards += numbers[k] < newest[k] ? 1 : 0;
      newest[k] = numbers[k];
    }
    std::this_thread::yield();
    const int last = *std::max_element(numbers.begin(), numbers.end());
    for (std::size_t k = 0; k < kCameras; ++k) {
      tally.changed += number_of(snapshot.view(k)) != numbers[k] ? 1 : 0;
      const double time_m = 2 * 0.001 * (last - numbers[k]);
      tally.wrong_margins += numbers[k] > 0 && std::abs(snapshot.pose_margin(k).time_m - time_m) > 1e-9 ? 1 : 0;
    }
    ++taken;
  }
}

TEST(ViewStoreThreads, SnapshotsAreWholeWhileImagesArrive) {
  // Fewer images than that are over before a reader has begun.
  const std::int64_t images = std::max<std::int64_t>(test::random_run(5000).count, 1000);
  ViewStore store = make_store();
  std::atomic<bool> stop = false;
  std::atomic<std::int64_t> taken = 0;
  std::atomic<std::int64_t> dropped = 0;
  std::array<Tally, kReaders> tallies;
  std::array<std::int64_t, kCameras> allocations{};
  std::array<int, kCameras> last{};
  std::vector<std::thread> readers;
  for (Tally& tally : tallies) {
    readers.emplace_back([&store, &stop, &taken, &tally] { read(store, stop, taken, tally); });
  }
  std::vector<std::thread> writers;
  for (std::size_t k = 0; k < kCameras; ++k) {
    writers.emplace_back([&, k] {
      NumberedFrame frame;
      const test::AllocationGuard guard;
      // Goes on until the readers have had their share of the processor, too.
      for (int n = 1; n <= images || (taken < images / 10 && n < 1'000'000); ++n) {
        dropped += store.update(k, frame.set(n), NumberedFrame::pose(n)).result == UpdateResult::dropped ? 1 : 0;
        last[k] = n;
      }
      allocations[k] = guard.allocations();
    });
  }
  for (std::thread& writer : writers) {
    writer.join();
  }
  stop = true;
  for (std::thread& reader : readers) {
    reader.join();
  }
  for (const Tally& tally : tallies) {
    EXPECT_EQ(tally.broken, 0);
    EXPECT_EQ(tally.backwards, 0);
    EXPECT_EQ(tally.changed, 0);
    EXPECT_EQ(tally.wrong_margins, 0);
  }
  EXPECT_GT(taken.load(), 0);
  // Each reader pins one buffer, and passing threads more for an instant only, so frames are seldom dropped.
  EXPECT_LT(dropped.load(), (std::int64_t{last[0]} + last[1] + last[2]) / 20);
  if (test::AllocationGuard::available()) {
    EXPECT_EQ(allocations, (std::array<std::int64_t, kCameras>{}));
  }
  for (std::size_t k = 0; k < kCameras && dropped == 0; ++k) {
    EXPECT_EQ(number_of(store.snapshot().view(k)), last[k]);
  }
  RecordProperty("snapshots", std::to_string(taken.load()));
  RecordProperty("dropped", std::to_string(dropped.load()));
  std::cout << taken << " snapshots, " << dropped << " frames dropped\n";
}

}  // namespace
}  // namespace depthgrid::views
