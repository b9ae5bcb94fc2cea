// Images that wait for each other, and where the robot surely was in an image.
#include "depthgrid/memory/image_intake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "depthgrid/memory/memory_store.hpp"
#include "memory/small_cell.hpp"

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;

std::vector<bool> bits(const VoxelSet& voxels) {
  std::vector<bool> result;
  for (int z = 0; z < voxels.voxels()[2]; ++z) {
    for (int y = 0; y < voxels.voxels()[1]; ++y) {
      for (int x = 0; x < voxels.voxels()[0]; ++x) {
        result.push_back(voxels.contains(x, y, z));
      }
    }
  }
  return result;
}

/// A memory of which everything is unknown, and images for it.
struct Fed {
  Fed()
      : views(small_rig(2), small_settings(2), 4),
        intake(views, small_memory()),
        space{make()},
        history(space.voxels) {}
  static PossibleSpace make() {
    const MemorySettings settings = small_memory();
    PossibleSpace space{.voxels = VoxelSet(settings.low_world, settings.high_world, settings.voxel_m)};
    space.is_everything = true;
    return space;
  }
  void update(std::size_t camera, const Wall& wall, double time_s) {
    EXPECT_TRUE(views.update(camera, wall.frame(time_s)).taken());
  }
  std::int64_t take(std::uint32_t cameras) { return intake.take(views.snapshot(), cameras, space, history).images; }

  views::ViewStore views;
  ImageIntake intake;
  PossibleSpace space;
  History history;
};

// The second camera's image is the earlier one: it shows everything free, and 6 cm come in until the first's.
TEST(ImageIntake, TakesTheEarlierExposureFirst) {
  const Wall far(3.0F);
  const Wall hidden(0.5F);
  Fed together;
  together.update(0, hidden, 5.06);
  together.update(1, far, 5.0);
  EXPECT_EQ(together.take(0b11), 2);
  Fed apart;
  apart.update(1, far, 5.0);
  EXPECT_EQ(apart.take(0b10), 1);
  apart.update(0, hidden, 5.06);
  EXPECT_EQ(apart.take(0b01), 1);
  EXPECT_EQ(together.space.time_s, 5.06);
  EXPECT_EQ(together.space.pending_m, apart.space.pending_m);
  EXPECT_GT(together.space.voxels.count(), 0);
  EXPECT_FALSE(together.space.is_everything);
  EXPECT_EQ(bits(together.space.voxels), bits(apart.space.voxels));
}

/// A robot's image without one reading that frees anything: its links are all that takes voxels out.
struct Robot {
  Frame frame(double time_s) {
    Frame frame = hidden.frame(time_s);
    frame.robot = {nothing_m.data(), nothing_m.data(), kWidth, 0, 5};
    frame.robot.links_world = links;
    return frame;
  }

  Wall hidden{0.5F};
  std::vector<float> nothing_m = std::vector<float>(std::size_t{kWidth} * kHeight, 0.0F);
  std::vector<Capsule> links{Capsule::sphere({0.01, 0, 0.02}, 0.15)};
};

/// Which voxels of a set lie wholly in the robot's first link, and uncertain_m away from its surface.
std::vector<bool> without_the_link(const VoxelSet& before, const Capsule& link, double uncertain_m) {
  std::vector<bool> result = bits(before);
  std::size_t n = 0;
  const double half_m = before.voxel_m() * std::sqrt(3.0) / 2;
  for (int z = 0; z < before.voxels()[2]; ++z) {
    for (int y = 0; y < before.voxels()[1]; ++y) {
      for (int x = 0; x < before.voxels()[0]; ++x, ++n) {
        if ((before.centre_world(x, y, z) - link.a).norm() + half_m + uncertain_m <= link.radius_m) {
          result[n] = false;
        }
      }
    }
  }
  return result;
}

// At 1 m/s it may be 3 cm beside the place that a clock 30 ms off gives it.
TEST(ImageIntake, KnowsTheRobotsPlaceAsWellAsItsTime) {
  for (const double uncertain_s : {0.0, 0.03}) {
    views::Settings settings = small_settings(1);
    settings.margins[0].time_uncertainty_s = uncertain_s;
    views::ViewStore views(small_rig(1), settings, 4);
    MemoryStore store(views, small_memory());
    const std::vector<bool> expected = [&] {
      const MemorySnapshot before = store.snapshot();
      return without_the_link(before.voxels(), Robot().links[0], kFastest * uncertain_s);
    }();
    Robot robot;
    ASSERT_TRUE(views.update(0, robot.frame(5)).taken());
    store.take(0);
    EXPECT_EQ(bits(store.snapshot().voxels()), expected) << uncertain_s;
  }
}

// Where the robot was 30 ms ago something may be by now that came 3 cm.
TEST(ImageIntake, AgesTheRobotsPlaceOfALateImage) {
  Wall half(3.0F);
  half.put(0, 0, kWidth / 2, kHeight, 0.5F);
  for (const double late_s : {0.0, 0.03}) {
    views::ViewStore views(small_rig(2), small_settings(2), 4);
    MemoryStore store(views, small_memory());
    ASSERT_TRUE(views.update(1, half.frame(5 + late_s)).taken());
    store.take(1);
    const std::vector<bool> expected = [&] {
      const MemorySnapshot before = store.snapshot();
      return without_the_link(before.voxels(), Robot().links[0], kFastest * late_s);
    }();
    Robot robot;
    ASSERT_TRUE(views.update(0, robot.frame(5)).taken());
    store.take(0);
    const MemorySnapshot after = store.snapshot();
    EXPECT_EQ(after.time_s(), 5 + late_s);
    EXPECT_EQ(bits(after.voxels()), expected) << late_s;
  }
}

}  // namespace
}  // namespace depthgrid::memory
