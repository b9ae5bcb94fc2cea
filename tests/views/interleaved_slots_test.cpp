// The protocol of snapshots in every order of its steps that a few switches between threads make: what is held is
// whole, stays as it is, and was the newest of all cameras at one instant.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "depthgrid/views/held_slots.hpp"
#include "support/interleaving.hpp"
#include "support/random_run.hpp"

namespace depthgrid::views {
namespace {

using test::step;
using test::SteppedAtomic;
using test::Switch;

constexpr std::size_t kCameras = 2;
constexpr std::size_t kSlots = 1 + kSpareSlots;  ///< one snapshot may be held

/// An image of two words, so that half of one can be seen.
struct Image {
  int first = 0;
  int second = 0;
};

/// As ViewStore::State has it, with steps instead of atomics.
struct Store {
  SteppedAtomic<std::uint64_t> newest{0};
  std::array<std::array<SteppedAtomic<std::uint32_t>, kSlots>, kCameras> references;
  std::array<std::array<Image, kSlots>, kCameras> images{};
  std::array<int, kCameras> published{};
  std::set<std::array<int, kCameras>> instants{{0, 0}};  ///< what was the newest at once, by the order of the steps
  int dropped = 0;
  int wrong = 0;

  void write(std::size_t camera, int number) {
    const std::size_t slot = free_slot(references[camera], kSlots, slot_of(newest.load(), camera));
    if (slot == kSlots) {
      ++dropped;
      return;
    }
    images[camera][slot].first = number;
    step();
    images[camera][slot].second = number;
    make_newest(newest, camera, slot);
    published[camera] = number;  // the same step: nobody runs in between
    instants.insert(published);
  }

  void read() {
    const auto each = [this](std::uint64_t slots, auto&& change) {
      for (std::size_t k = 0; k < kCameras; ++k) {
        change(references[k][slot_of(slots, k)]);
      }
    };
    const auto release = [&](std::uint64_t slots) { each(slots, [](auto& count) { count.fetch_sub(1); }); };
    const std::uint64_t held = hold_newest(
        newest, [&](std::uint64_t slots) { each(slots, [](auto& count) { count.fetch_add(1); }); }, release);
    std::array<int, kCameras> seen{};
    for (int look = 0; look < 2; ++look) {
      for (std::size_t k = 0; k < kCameras; ++k) {
        const Image& image = images[k][slot_of(held, k)];
        const int first = image.first;
        step();
        wrong += image.second != first || (look > 0 && first != seen[k]) ? 1 : 0;
        seen[k] = first;
      }
    }
    wrong += instants.contains(seen) ? 0 : 1;
    release(held);
  }
};

using Bodies = std::vector<std::function<void()>>;

/// Runs the bodies in all orders of so many switches within the first steps; gives the number of orders.
std::int64_t try_all(int switches, int steps, const std::function<Bodies(Store&)>& bodies_of) {
  Store unused;
  std::int64_t plans = 0;
  test::for_plans(switches, steps, bodies_of(unused).size(), [&](std::span<const Switch> plan) {
    if (testing::Test::HasFailure()) {
      return;
    }
    Store store;
    (void)test::run_interleaved(plan, bodies_of(store));
    ++plans;
    std::string text;
    for (const Switch& one : plan) {
      text += " " + std::to_string(one.step) + ":" + std::to_string(one.to);
    }
    EXPECT_EQ(store.wrong, 0) << "with the switches (step:thread)" << text;
    EXPECT_EQ(store.dropped, 0) << "there is room for what one reader holds; switches (step:thread)" << text;
    for (std::size_t k = 0; k < kCameras; ++k) {
      const Image& newest = store.images[k][slot_of(store.newest.load(), k)];
      EXPECT_EQ(newest.first, store.published[k]) << "an image was lost with the switches (step:thread)" << text;
    }
  });
  return plans;
}

/// Fewer in instrumented builds.
int switches(int most) { return test::random_run(1000).count < 1000 ? most - 1 : most; }

// The reader stops after it has read the word, or between the cameras, while images come.
TEST(InterleavedSlots, ASnapshotIsWholeHoweverAnImageComesBetween) {
  const std::int64_t plans = try_all(switches(3), 22, [](Store& store) {
    return Bodies{[&store] { store.read(); },
                  [&store] {
                    for (int number = 1; number <= 3; ++number) {
                      store.write(0, number);
                    }
                  }};
  });
  EXPECT_GT(plans, 100);
}

TEST(InterleavedSlots, AndOfOneInstantWithTwoCameras) {
  const auto bodies = [](Store& store) {
    const auto writer = [&store](std::size_t camera) {
      return [&store, camera] {
        store.write(camera, 1);
        store.write(camera, 2);
      };
    };
    return Bodies{[&store] {
                    store.read();
                    store.read();
                  },
                  writer(0), writer(1)};
  };
  EXPECT_GT(try_all(switches(2), 36, bodies), 36);
}

TEST(InterleavedSlots, TwoWritersOfTwoCamerasLoseNothing) {
  const std::int64_t plans = try_all(switches(2), 14, [](Store& store) {
    return Bodies{[&store] { store.write(0, 1); }, [&store] { store.write(1, 1); }, [&store] { store.read(); }};
  });
  EXPECT_GT(plans, 10);
}

}  // namespace
}  // namespace depthgrid::views
