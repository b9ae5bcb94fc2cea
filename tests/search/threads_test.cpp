// Threads ask while others deliver images: every answer is that of one set of frames as they were delivered.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <set>
#include <thread>
#include <vector>

#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using reference::Random;
using reference::RandomProblem;

constexpr std::size_t kCameras = 3;

/// Two frames a camera, with different images, poses and times.
struct Deliveries {
  std::array<RandomProblem, 2> problems;
  SearchSetup setup;
  std::array<std::array<Frame, kCameras>, 2> frames;
  std::array<std::array<Pose, kCameras>, 2> poses;

  explicit Deliveries(std::uint64_t seed) {
    reference::RandomOptions options;
    options.cameras = static_cast<int>(kCameras);
    options.width_px = 32;
    options.margins = true;
    for (std::size_t i = 0; i < 2; ++i) {
      options.seed = seed + i;
      problems[i] = reference::make_random_problem(options);
    }
    setup = make_setup(problems[0], SpaceKind::box, true);
    setup.settings.v_max_m_s = 1;
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < kCameras; ++k) {
        // The second problem's cameras have their own intrinsics, so only its images are used, from a little beside.
        frames[i][k] = problems[i].frames[k];
        frames[i][k].depth.metres_per_unit = setup.rig.cameras[k].metres_per_unit;
        frames[i][k].time_s = 100 + 0.003 * static_cast<double>(k) + 0.005 * static_cast<double>(i);
        poses[i][k] = setup.rig.cameras[k].T_world_camera;
        poses[i][k].translation().x() += 0.02 * static_cast<double>(i);
      }
    }
  }
};

std::vector<Capsule> some_primitives() {
  std::vector<Capsule> primitives;
  Random random(1);
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d p_world = random.in_cube(0.5);
    primitives.push_back(i % 2 == 0 ? Capsule::point(p_world) : Capsule{p_world, p_world + random.in_cube(0.1), 0.03});
  }
  return primitives;
}

/// Everything of an answer that a torn image could change.
struct Told {
  std::vector<double> numbers;
  std::vector<int> states;
  bool operator==(const Told&) const = default;
};

Told told(const std::vector<Answer>& answers) {
  Told result;
  for (const Answer& answer : answers) {
    result.numbers.push_back(answer.nearest.distance_m);
    for (int i = 0; i < 3; ++i) {
      const double x = answer.nearest.nearest_world[i];
      result.numbers.push_back(std::isnan(x) ? -1e9 : x);
    }
    result.states.push_back(static_cast<int>(answer.nearest.state));
    result.states.push_back(answer.nearest.camera ? static_cast<int>(*answer.nearest.camera) : -1);
  }
  return result;
}

TEST(Threads, EveryAnswerIsThatOfOneSetOfFrames) {
  const test::RandomRun run = test::random_run(3);
  for (std::int64_t problem = 0; problem < std::min<std::int64_t>(run.count, 3); ++problem) {
    const Deliveries deliveries(run.seed + 10 * static_cast<std::uint64_t>(problem));
    const std::vector<Capsule> primitives = some_primitives();
    std::vector<Told> legal;
    for (unsigned set = 0; set < 1U << kCameras; ++set) {
      views::ViewStore store(deliveries.setup.rig, deliveries.setup.settings);
      for (std::size_t k = 0; k < kCameras; ++k) {
        const std::size_t i = (set >> k) & 1U;
        ASSERT_EQ(store.update(k, deliveries.frames[i][k], deliveries.poses[i][k]).result, UpdateResult::taken);
      }
      Search search;
      std::vector<Answer> answers(primitives.size());
      search.distances(store.snapshot(), primitives, answers);
      legal.push_back(told(answers));
    }
    std::set<std::vector<double>> different;
    for (const Told& one : legal) {
      different.insert(one.numbers);
    }
    ASSERT_GE(different.size(), 4U) << "the sets of frames can hardly be told apart";

    constexpr int kReaders = 3;
    views::ViewStore store(deliveries.setup.rig, deliveries.setup.settings, kReaders);
    for (std::size_t k = 0; k < kCameras; ++k) {
      (void)store.update(k, deliveries.frames[0][k], deliveries.poses[0][k]);
    }
    std::atomic<bool> stop{false};
    std::atomic<int> dropped{0};
    std::vector<std::thread> writers;
    for (std::size_t k = 0; k < kCameras; ++k) {
      writers.emplace_back([&, k] {
        Random random(k);  // no rhythm: each buffer gets one frame as well as the other
        while (!stop.load()) {
          const std::size_t i = random.chance(0.5) ? 1 : 0;
          const auto result = store.update(k, deliveries.frames[i][k], deliveries.poses[i][k]).result;
          dropped += result == UpdateResult::dropped ? 1 : 0;
          EXPECT_NE(result, UpdateResult::unusable);
        }
      });
    }
    std::vector<std::thread> readers;
    std::array<int, kReaders> illegal{};
    std::array<std::vector<int>, kReaders> seen;
    for (std::size_t r = 0; r < kReaders; ++r) {
      readers.emplace_back([&, r] {
        Search search;
        std::vector<Answer> answers(primitives.size());
        seen[r].assign(legal.size(), 0);
        // On a busy machine the writers may not have had a turn by then.
        const auto waiting = [&] { return std::count(seen[r].begin(), seen[r].end(), 0) + 1 >= std::ssize(legal); };
        for (int n = 0; n < 300 || (n < 30000 && waiting()); ++n) {
          const views::Snapshot snapshot = store.snapshot();
          search.distances(snapshot, primitives, answers);
          const auto found = std::find(legal.begin(), legal.end(), told(answers));
          if (found == legal.end()) {
            ++illegal[r];
          } else {
            ++seen[r][static_cast<std::size_t>(found - legal.begin())];
          }
        }
      });
    }
    for (std::thread& reader : readers) {
      reader.join();
    }
    stop = true;
    for (std::thread& writer : writers) {
      writer.join();
    }
    int sets_seen = 0;
    for (std::size_t set = 0; set < legal.size(); ++set) {
      sets_seen += seen[0][set] + seen[1][set] + seen[2][set] > 0 ? 1 : 0;
    }
    for (const int count : illegal) {
      EXPECT_EQ(count, 0) << "answers of no set of frames; problem seed " << deliveries.problems[0].options.seed;
    }
    EXPECT_GT(sets_seen, 1) << "the readers never saw a new frame";
    EXPECT_EQ(dropped.load(), 0) << "held snapshots and one spare buffer a camera are enough";
  }
}

TEST(Threads, MayShareOneSnapshot) {
  const Deliveries deliveries(4);
  const std::vector<Capsule> primitives = some_primitives();
  views::ViewStore store(deliveries.setup.rig, deliveries.setup.settings);
  for (std::size_t k = 0; k < kCameras; ++k) {
    (void)store.update(k, deliveries.frames[0][k], deliveries.poses[0][k]);
  }
  const views::Snapshot snapshot = store.snapshot();
  std::array<Told, 4> answered;
  std::vector<std::thread> readers;
  for (Told& mine : answered) {
    readers.emplace_back([&] {
      Search search;
      std::vector<Answer> answers(primitives.size());
      for (int n = 0; n < 50; ++n) {
        search.distances(snapshot, primitives, answers);
      }
      mine = told(answers);
    });
  }
  for (std::thread& reader : readers) {
    reader.join();
  }
  for (const Told& mine : answered) {
    EXPECT_EQ(mine, answered[0]);
  }
}

}  // namespace
}  // namespace depthgrid::search
