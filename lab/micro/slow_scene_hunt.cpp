#include <algorithm>
#include <cstdio>
#include <random>
#include <string>

#include "depthgrid/search/search.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/micro/hard_images.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::lab {
namespace {

/// What the first call has to look at; counts, so that a scene is as slow on every machine.
std::int64_t work_of(const SlowScene& scene) {
  const HardImages hard = hard_images(scene);
  const auto store = stored(hard);
  search::Search searcher;
  const std::vector<Capsule> points = nine_on_arm();
  std::vector<Answer> answers(points.size());
  search::Count count;
  searcher.distances(store->snapshot(), points, answers, {}, &count);
  return count.nodes + count.ball_tests;
}

}  // namespace

/// Keeps the slower of a scene and its mutation; anew from the default where a fifth of the time found nothing.
void hunt_slow_scenes(double time_s, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  report::ProgressLine line("hunt", 100);
  const Stopwatch watch;
  SlowScene slowest;
  std::int64_t most = work_of(slowest);
  SlowScene current = slowest;
  std::int64_t work = most;
  double changed_s = 0;
  int scenes = 1;
  for (; watch.elapsed_s() < time_s; ++scenes) {
    if (watch.elapsed_s() - changed_s > 0.2 * time_s) {
      current = {};
      work = work_of(current);
      changed_s = watch.elapsed_s();
    }
    const SlowScene next = mutated(current, generator);
    const std::int64_t next_work = work_of(next);
    if (next_work > work) {
      current = next;
      work = next_work;
      changed_s = watch.elapsed_s();
      if (work > most) {
        slowest = current;
        most = work;
      }
    }
    line.update(static_cast<std::size_t>(100 * std::min(1.0, watch.elapsed_s() / time_s)),
                std::to_string(most) + " cubes and balls");
  }
  std::printf("%d scenes, the slowest takes %lld cubes and balls:\n%s\n", scenes, static_cast<long long>(most),
              to_text(slowest).c_str());
}

}  // namespace depthgrid::lab
