// What a search remembers decides how long it takes, never what it answers: neither what was asked before, nor the
// other capsules of a call, nor the room for what is remembered.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "search/answer_bits.hpp"
#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Random;
using reference::RandomProblem;

/// A store whose cameras get one of two images each, from places around where the rig says.
class MovingScene {
 public:
  MovingScene(const RandomProblem& problem, const RandomProblem& other, Random& random)
      : random_(random), setup_(make_setup(problem, random.chance(0.5) ? SpaceKind::box : SpaceKind::frustum, true)) {
    views::Policies& policies = setup_.settings.policies;
    policies.unobserved = random.chance(0.3) ? views::Policy::ignored : views::Policy::obstacle;
    policies.outside = random.chance(0.5) ? views::Policy::ignored : views::Policy::obstacle;
    for (std::size_t k = 0; k < setup_.frames.size(); ++k) {
      // The other problem's cameras have their own intrinsics, so only its images are used, on the same rig.
      Frame frame = other.frames[k % other.frames.size()];
      frame.depth.metres_per_unit = setup_.rig.cameras[k].metres_per_unit;
      frames_.push_back({setup_.frames[k], frame});
    }
    for (auto& frames : frames_) {
      frames[0].time_s = frames[1].time_s = 100;
    }
    store_ = std::make_unique<views::ViewStore>(setup_.rig, setup_.settings);
  }

  /// One camera's next image.
  void go_on() {
    const auto k = static_cast<std::size_t>(random_.integer(0, static_cast<int>(frames_.size()) - 1));
    Frame frame = random_.chance(0.05) ? Frame{} : frames_[k][random_.chance(0.5) ? 1 : 0];
    frame.time_s += 0.005 * step_++;
    Pose pose = setup_.rig.cameras[k].T_world_camera;
    if (random_.chance(0.5)) {
      pose.pretranslate(random_.in_cube(0.02));
    }
    (void)store_->update(k, frame, pose);
  }

  [[nodiscard]] views::Snapshot snapshot() const { return store_->snapshot(); }
  [[nodiscard]] const SearchSetup& setup() const { return setup_; }

  [[nodiscard]] std::vector<Capsule> some_capsules(const RandomProblem& problem) {
    std::vector<Capsule> capsules;
    for (int i = random_.integer(1, 5); i > 0; --i) {
      const auto n = static_cast<std::size_t>(random_.integer(0, static_cast<int>(problem.points_world.size()) - 1));
      const Vector3d p_world = problem.points_world[n] + random_.in_cube(0.2);
      const Capsule whole{p_world, p_world + random_.in_cube(0.3), random_.uniform(0, 0.1)};
      capsules.push_back(random_.chance(0.4)   ? Capsule::point(p_world)
                         : random_.chance(0.5) ? Capsule::sphere(p_world, whole.radius_m)
                                               : whole);
    }
    return capsules;
  }

 private:
  Random& random_;
  SearchSetup setup_;
  std::vector<std::array<Frame, 2>> frames_;
  std::unique_ptr<views::ViewStore> store_;
  int step_ = 0;
};

/// How one call is made.
struct Asking {
  Budget budget;
  bool hybrid = false;
};

std::vector<std::vector<std::uint64_t>> ask(Search& search, const views::Snapshot& snapshot,
                                            std::span<const Capsule> capsules, const Asking& how) {
  std::vector<Answer> answers(capsules.size());
  if (how.hybrid) {
    search.hybrid(snapshot, capsules, answers, how.budget);
  } else {
    search.distances(snapshot, capsules, answers, how.budget);
  }
  std::vector<std::vector<std::uint64_t>> bits;
  std::transform(answers.begin(), answers.end(), std::back_inserter(bits), bits_of);
  return bits;
}

Asking random_asking(Random& random) {
  Asking how;
  how.hybrid = random.chance(0.3);
  if (random.chance(0.3)) {
    how.budget.nodes = random.integer(1, 400);
  }
  return how;
}

RandomProblem beside(const RandomProblem& problem) {
  reference::RandomOptions options = problem.options;
  options.cameras = static_cast<int>(problem.rig.cameras.size());
  options.seed += 1000003;
  options.width_px = problem.rig.cameras[0].intrinsics.width_px;
  return reference::make_random_problem(options);
}

bool same_size(const RandomProblem& problem, const RandomProblem& other) {
  return std::all_of(problem.frames.begin(), problem.frames.end(), [&](const Frame& frame) {
    return frame.depth.width_px == other.frames[0].depth.width_px &&
           frame.depth.height_px == other.frames[0].depth.height_px;
  });
}

TEST(Memory, OfEarlierQuestionsChangesNoAnswer) {
  int compared = 0;
  for_random_problems(40, {}, [&](const RandomProblem& problem, Random& random) {
    const RandomProblem other = beside(problem);
    ASSERT_TRUE(same_size(problem, other));
    MovingScene scene(problem, other, random);
    Search used;
    Search small(40);  // soon full
    for (int step = 0; step < 20; ++step) {
      scene.go_on();
      const views::Snapshot snapshot = scene.snapshot();
      for (int call = random.integer(0, 3); call > 0; --call) {
        const std::vector<Capsule> capsules = scene.some_capsules(problem);
        const Asking how = random_asking(random);
        Search fresh;
        const auto expected = ask(fresh, snapshot, capsules, how);
        EXPECT_EQ(ask(used, snapshot, capsules, how), expected) << "step " << step;
        if (!how.budget.nodes) {
          EXPECT_EQ(ask(small, snapshot, capsules, how), expected) << "with little room, step " << step;
        }
        ++compared;
      }
    }
  });
  EXPECT_GT(compared, 0);
}

TEST(Memory, OfOtherCapsulesInACallChangesNoAnswer) {
  for_random_problems(60, {}, [&](const RandomProblem& problem, Random& random) {
    const RandomProblem other = beside(problem);
    MovingScene scene(problem, other, random);
    for (int step = 0; step < 8; ++step) {
      scene.go_on();
    }
    const views::Snapshot snapshot = scene.snapshot();
    const std::vector<Capsule> capsules = scene.some_capsules(problem);
    const Asking how{{}, random.chance(0.5)};
    Search together;
    const auto answers = ask(together, snapshot, capsules, how);
    for (std::size_t i = 0; i < capsules.size(); ++i) {
      Search alone;
      EXPECT_EQ(ask(alone, snapshot, {&capsules[i], 1}, how)[0], answers[i]) << "capsule " << i;
    }
  });
}

/// With fewer cells than one question needs as well.
TEST(Memory, WithoutRoomForAnythingChangesNoAnswer) {
  for_random_problems(60, {}, [&](const RandomProblem& problem, Random& random) {
    Asker asker(make_setup(problem, random.chance(0.5) ? SpaceKind::box : SpaceKind::frustum, true));
    for (const std::size_t cells : {1U, 2U, 9U, 100U}) {
      Search small(cells);
      for (const Vector3d& p_world : problem.points_world) {
        const Capsule capsule{p_world, p_world + Vector3d(0.05, 0, 0.02), 0.01};
        const Asking how{{}, random.chance(0.3)};
        EXPECT_EQ(ask(small, asker.snapshot(), {&capsule, 1}, how),
                  ask(asker.search(), asker.snapshot(), {&capsule, 1}, how))
            << cells << " cells";
      }
    }
  });
}

/// One camera with 8 x 6 pixels at the origin that looks along z.
struct SmallScene {
  SmallScene() {
    RigCamera camera;
    camera.id = "one";
    camera.intrinsics = {8, 6, 3, 3, 4, 3};
    rig.name = "one";
    rig.cameras = {camera};
    settings.space = views::BoxSpace{{-1, -1, 0}, {1, 1, 3}};
    settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0};
    settings.margins = {CameraMargins{.sensor = {0, 0, 0, 0}, .smallest_obstacle_m = 0}};
    settings.v_max_m_s = 0;
  }
  [[nodiscard]] static Frame wall(const std::vector<float>& image_m) { return {depth_view(image_m, 8, 6), {}, 1.0}; }
  Rig rig;
  views::Settings settings;
};

Answer asked(Search& search, const views::ViewStore& store, const Capsule& capsule) {
  Answer answer;
  search.distances(store.snapshot(), {&capsule, 1}, {&answer, 1});
  return answer;
}

/// The law of repulsion is that of the settings asked about.
TEST(Memory, OfOtherSettingsChangesNoDirection) {
  SmallScene near_scene;
  near_scene.settings.rho_m = 0.5;
  SmallScene steep_scene;
  steep_scene.settings.rho_m = 0.5;
  steep_scene.settings.repulsion_alpha = 1;
  std::vector<float> image_m(48, 1.5F);
  std::fill(image_m.begin(), image_m.begin() + 16, 1.1F);  // two walls, one before the other
  views::ViewStore near_store(near_scene.rig, near_scene.settings);
  views::ViewStore steep_store(steep_scene.rig, steep_scene.settings);
  const Capsule capsule = Capsule::point({0.1, 0.1, 1.05});
  Search used;
  std::vector<std::vector<std::vector<std::uint64_t>>> seen;
  for (views::ViewStore* store : {&near_store, &steep_store, &near_store}) {
    ASSERT_TRUE(store->update(0, SmallScene::wall(image_m)).taken());
    Search fresh;
    const views::Snapshot snapshot = store->snapshot();
    const auto expected = ask(fresh, snapshot, {&capsule, 1}, {{}, true});
    EXPECT_EQ(ask(used, snapshot, {&capsule, 1}, {{}, true}), expected);
    seen.push_back(expected);
  }
  EXPECT_NE(seen[0], seen[1]);
  EXPECT_EQ(seen[0], seen[2]);
}

/// However many images came in between, and of whichever store.
TEST(Memory, OfAnImageEndsWithTheNextOne) {
  const SmallScene scene;
  const std::array<float, 2> walls_m{1.2F, 1.3F};
  const std::array<std::vector<float>, 2> images{std::vector<float>(48, walls_m[0]),
                                                 std::vector<float>(48, walls_m[1])};
  views::ViewStore store(scene.rig, scene.settings);
  views::ViewStore other(scene.rig, scene.settings);
  Search search;
  const auto take = [&](views::ViewStore& taking, std::size_t image) {
    ASSERT_TRUE(taking.update(0, SmallScene::wall(images[image])).taken());
  };
  const auto expect = [&](const views::ViewStore& asked_store, std::size_t image, const std::string& when) {
    const double distance_m = asked(search, asked_store, Capsule::point({0, 0, 1})).nearest.distance_m;
    EXPECT_NEAR(distance_m, static_cast<double>(walls_m[image]) - 1, 0.02) << when;
  };
  take(store, 0);
  take(other, 1);
  expect(store, 0, "the first");
  expect(other, 1, "another store");
  expect(store, 0, "the first again");
  std::size_t shown = 0;
  for (const int between : {1, 2, 3, 5, 127, 128, 255, 256, 257, 511, 512, 65535, 65536, 65537}) {
    shown = 1 - shown;
    for (int n = 0; n < between; ++n) {
      take(store, shown);
    }
    expect(store, shown, "after " + std::to_string(between) + " images");
  }
}

/// A capsule before a wall that is parallel to it: many cubes are at the same distance.
TEST(Memory, ChoosesAmongEqualDistancesWithoutRegardToEarlierOnes) {
  const SmallScene scene;
  const std::vector<float> image_m(48, 1.2F);
  views::ViewStore store(scene.rig, scene.settings);
  ASSERT_TRUE(store.update(0, SmallScene::wall(image_m)).taken());
  for (const double y : {0.0, 0.0137}) {
    const Capsule link{{-0.2, y, 1}, {0.2, y, 1}, 0.03};
    Search fresh;
    const Answer expected = asked(fresh, store, link);
    for (const double x : {-0.17, -0.05, 0.0, 0.06, 0.19}) {
      Search used;
      static_cast<void>(asked(used, store, Capsule::point({x, y, 1})));
      EXPECT_EQ(bits_of(asked(used, store, link)), bits_of(expected)) << "after a question at x = " << x;
    }
  }
}

TEST(Memory, DoesNotDependOnTheOrderOfTheCameras) {
  reference::RandomOptions options;
  options.cameras = 3;
  for_random_problems(60, options, [&](const RandomProblem& problem, Random&) {
    const SearchSetup setup = make_setup(problem, SpaceKind::box, true);
    SearchSetup turned = setup;
    std::rotate(turned.rig.cameras.begin(), turned.rig.cameras.begin() + 1, turned.rig.cameras.end());
    std::rotate(turned.frames.begin(), turned.frames.begin() + 1, turned.frames.end());
    std::rotate(turned.settings.margins.begin(), turned.settings.margins.begin() + 1, turned.settings.margins.end());
    Asker one(setup);
    Asker other(turned);
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule capsule{p_world, p_world + Vector3d(0.05, 0, 0.02), 0.01};
      const Answer a = one.distance(capsule);
      const Answer b = other.distance(capsule);
      EXPECT_EQ(bits_of(a).front(), bits_of(b).front()) << p_world.transpose();
      EXPECT_TRUE(a.nearest.nearest_world == b.nearest.nearest_world ||
                  (a.nearest.nearest_world.hasNaN() && b.nearest.nearest_world.hasNaN()));
    }
  });
}

}  // namespace
}  // namespace depthgrid::search
