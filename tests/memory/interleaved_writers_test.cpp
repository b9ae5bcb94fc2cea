// The memory's hand-over in every order of its steps that a few switches between threads make: one writes at a time, no
// image is forgotten, nothing that was written gets lost, and what somebody asks is whole.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "depthgrid/memory/one_writer.hpp"
#include "depthgrid/views/held_slots.hpp"
#include "support/interleaving.hpp"
#include "support/random_run.hpp"

namespace depthgrid::memory {
namespace {

using test::step;
using test::SteppedAtomic;
using test::Switch;

constexpr std::size_t kCameras = 3;
constexpr std::size_t kSlots = 1 + views::kSpareSlots;  ///< one snapshot may be held

/// What one buffer knows: of each camera the image that was looked at last, and how often something was let go. And
/// the sum of that, so that half of it can be told.
struct Space {
  std::array<int, kCameras> images{};
  int let_go = 0;
  int twin = 0;
};

/// As MemoryStore::State has it, with steps instead of atomics.
struct Store {
  OneWriter<SteppedAtomic<bool>, SteppedAtomic<std::uint32_t>> writer;
  SteppedAtomic<std::uint32_t> newest{0};
  std::array<SteppedAtomic<std::uint32_t>, kSlots> references;
  std::array<Space, kSlots> slots{};
  std::array<int, kCameras> fed{};
  int let_go = 0;
  int writing = 0;
  int wrong = 0;

  template <class Change>
  void write(Change&& change) {
    wrong += ++writing > 1 ? 1 : 0;
    const bool written = write_newest(newest, references, kSlots, [&](std::size_t before, std::size_t slot) {
      slots[slot] = slots[before];
      change(slots[slot]);
      step();
      slots[slot].twin = sum(slots[slot]);
    });
    wrong += written ? 0 : 1;  // there is room for what one reader holds
    --writing;
  }

  void look_at(std::uint32_t cameras) {
    write([this, cameras](Space& space) {
      for (std::size_t k = 0; k < kCameras; ++k) {
        space.images[k] = ((cameras >> k) & 1U) != 0 ? fed[k] : space.images[k];
      }
    });
  }

  void feed(std::size_t camera) {
    step();
    ++fed[camera];
    static_cast<void>(writer.leave(std::uint32_t{1} << camera));
    writer.look_at_waiting([this](std::uint32_t cameras) { look_at(cameras); });
  }

  void put_down() {
    if (writer.try_write([this] { write([](Space& space) { ++space.let_go; }); },
                         [this](std::uint32_t cameras) { look_at(cameras); })) {
      ++let_go;
    }
  }

  void ask() {
    const std::uint32_t held = views::hold_newest(
        newest, [this](std::uint32_t slot) { references[slot].fetch_add(1); },
        [this](std::uint32_t slot) { references[slot].fetch_sub(1); });
    const Space first = slots[held];
    step();
    wrong += first.twin != sum(first) || slots[held].twin != first.twin ? 1 : 0;
    references[held].fetch_sub(1);
  }

  [[nodiscard]] static int sum(const Space& space) {
    return space.images[0] + space.images[1] + space.images[2] + space.let_go;
  }
};

using Body = void (*)(Store&);

/// Runs the bodies in all orders of so many switches within the first steps; gives the number of orders.
std::int64_t try_all(int switches, int steps, const std::vector<Body>& bodies,
                     const std::function<void(Store&)>& check) {
  std::int64_t plans = 0;
  test::for_plans(switches, steps, bodies.size(), [&](std::span<const Switch> plan) {
    if (testing::Test::HasFailure()) {
      return;
    }
    Store store;
    std::vector<std::function<void()>> bound;
    bound.reserve(bodies.size());
    for (const Body body : bodies) {
      bound.emplace_back([&store, body] { body(store); });
    }
    (void)test::run_interleaved(plan, bound);
    ++plans;
    std::string text = "switches (step:thread)";
    for (const Switch& one : plan) {
      text += " " + std::to_string(one.step) + ":" + std::to_string(one.to);
    }
    SCOPED_TRACE(text);
    EXPECT_EQ(store.wrong, 0) << "two wrote at once, or what was asked was half written";
    EXPECT_EQ(store.slots[store.newest.load()].let_go, store.let_go) << "what was let go was lost";
    check(store);
  });
  return plans;
}

void expect_nothing_forgotten(Store& store) { EXPECT_EQ(store.slots[store.newest.load()].images, store.fed); }

/// Fewer in instrumented builds.
int switches(int most) { return test::random_run(1000).count < 1000 ? most - 1 : most; }

// The second camera's image comes while the first's is looked at, and while the writer lets go.
TEST(InterleavedWriters, ForgetNoImageOfTwoCameras) {
  const std::vector<Body> bodies{[](Store& store) { store.feed(0); }, [](Store& store) { store.feed(1); }};
  EXPECT_GT(try_all(switches(3), 18, bodies, expect_nothing_forgotten), 100);
}

TEST(InterleavedWriters, ForgetNothingThatIsPutDownBetweenImages) {
  const std::vector<Body> bodies{[](Store& store) { store.feed(0); }, [](Store& store) { store.put_down(); }};
  EXPECT_GT(try_all(switches(3), 18, bodies, expect_nothing_forgotten), 100);
}

TEST(InterleavedWriters, KeepWhatIsAskedWhole) {
  const std::vector<Body> bodies{[](Store& store) { store.ask(); },
                                 [](Store& store) {
                                   store.feed(0);
                                   store.feed(0);
                                   store.feed(0);
                                 }};
  EXPECT_GT(try_all(switches(3), 18, bodies, expect_nothing_forgotten), 100);
}

// A writer that has had its rounds may leave one; the next image brings it along.
TEST(InterleavedWriters, LeaveNothingBehindTheNextImageOfThreeCameras) {
  const std::vector<Body> bodies{[](Store& store) { store.feed(0); }, [](Store& store) { store.feed(1); },
                                 [](Store& store) { store.feed(2); }};
  const auto check = [](Store& store) {
    store.feed(0);
    expect_nothing_forgotten(store);
  };
  EXPECT_GT(try_all(switches(2), 20, bodies, check), 20);
}

}  // namespace
}  // namespace depthgrid::memory
