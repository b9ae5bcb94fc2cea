// Random cells of posts with cameras that err, things and holes: the same answer as a slow twin's, cameras that decide
// by their own pixels, and no thing in a layer that was found.
#include <gtest/gtest.h>

#include <random>

#include "avoidance/padding_twin.hpp"
#include "avoidance/post_cell.hpp"
#include "support/random_run.hpp"

namespace depthgrid::avoidance {
namespace {

using Eigen::Vector3d;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  bool happens(double share) { return between(0, 1) < share; }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_); }

 private:
  std::mt19937_64 engine_;
};

test::PostOptions random_options(Draw& draw, const std::vector<Pose>& cameras) {
  test::PostOptions options;
  options.T_world_camera = cameras;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    options.nearer_m.push_back(draw.happens(0.5) ? draw.between(0, 0.08) : 0);
  }
  while (draw.happens(0.5)) {
    const double turn_rad = draw.between(-3.1, 3.1);
    const double away_m = 0.05 + 0.04 + draw.between(0.1, 0.4);
    const Vector3d foot(0, 0.8 * static_cast<double>(draw.below(2)), draw.between(0.2, 0.6));
    options.things_world.push_back(
        Capsule::sphere(foot + away_m * Vector3d(std::cos(turn_rad), std::sin(turn_rad), 0), 0.04));
  }
  while (draw.happens(0.2)) {
    options.holes.push_back({draw.below(cameras.size()),
                             {draw.between(-0.2, 0.2), draw.between(-0.2, 1), draw.between(0.1, 0.7)},
                             static_cast<int>(draw.below(3))});
  }
  return options;
}

TEST(LeastPaddingOfRandomCells, IsThatOfTheSlowTwin) {
  const depthgrid::test::RandomRun run = depthgrid::test::random_run(12);
  int decided = 0;
  int none = 0;
  int of_several = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Draw draw(run.seed + static_cast<std::uint64_t>(i));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    std::vector<Pose> cameras;
    const std::size_t count = 2 + draw.below(2);
    const double first_rad = draw.between(-3.1, 3.1);
    for (std::size_t k = 0; k < count; ++k) {
      const double turn_rad = first_rad + 6.28 * static_cast<double>(k) / static_cast<double>(count);
      const Vector3d middle(0, 0.4, 0.4);
      cameras.push_back(look_at(
          middle + Vector3d(1.7 * std::cos(turn_rad), 1.7 * std::sin(turn_rad), draw.between(-0.2, 0.6)), middle));
    }
    std::vector<test::PostOptions> instants{random_options(draw, cameras)};
    if (draw.happens(0.5)) {
      instants.push_back(random_options(draw, cameras));
    }
    test::PostCell cell = test::post_cell(instants);
    cell.settings.paddings_m = padding_ladder(0.01, 0.15, 0.02);
    const LeastPadding found = least_padding(cell.rig, cell.model, cell.cells, cell.settings);
    const auto twins =
        test::twin_paddings(cell.rig, cell.model, cell.cells, cell.settings, *cell.settings.robot_within_m);
    ASSERT_EQ(found.links.size(), twins.size()) << what;
    double most_m = 0;
    for (std::size_t k = 0; k < twins.size(); ++k) {
      const LinkPadding& link = found.links[k];
      EXPECT_EQ(link.least_m, twins[k].least_m) << what << ", " << link.name;
      EXPECT_EQ(link.covers_from_m, twins[k].covers_from_m) << what << ", " << link.name;
      EXPECT_EQ(link.clear_to_m, std::min(twins[k].clear_to_m, link.tested_to_m)) << what << ", " << link.name;
      most_m = std::max(most_m, link.least_m.value_or(0));
      none += link.least_m ? 0 : 1;
      EXPECT_TRUE(link.least_m || link.before) << what << ": without a word";
      if (link.least_m && link.before && link.before->decides) {
        const NotClear& why = *link.before;
        const Vector3d& place = why.answer.nearest.nearest_world;
        ++decided;
        const auto says = [&](std::size_t camera, double padding_m, double slack_m) {
          return test::pixel_says(cell.rig, cell.model, cell.cells[why.cell], cell.settings, padding_m, camera, place,
                                  slack_m);
        };
        EXPECT_EQ(says(*why.decides, *link.least_m, 0), test::PixelSays::frees) << what << ", " << link.name;
        const double slack_m = cell.settings.search.resolution_m + 1e-4;
        for (std::size_t camera = 0; camera < count; ++camera) {
          const test::PixelSays pixel = says(camera, why.padding_m, slack_m);
          EXPECT_NE(pixel, test::PixelSays::frees) << what << ", camera " << camera;
          EXPECT_EQ(why.cameras[camera].state == ProximityState::unobserved, pixel == test::PixelSays::not_in_its_image)
              << what << ", camera " << camera;
        }
      }
    }
    if (found.decides) {
      EXPECT_EQ(found.links[*found.decides].least_m, most_m) << what;
      of_several += most_m > cell.settings.paddings_m.front() ? 1 : 0;
    }
    // What really stands there stays outside of the padding that was found, but for one step of 2 cm.
    for (std::size_t k = 0; k < twins.size(); ++k) {
      const Capsule& post = test::post_world(found.links[k].name == "post" ? 0 : 1);
      for (const Capsule& thing : cell.things_world) {
        const double away_m = distance_to_axis(post, thing.a) - post.radius_m - thing.radius_m;
        if (found.links[k].least_m && away_m > *cell.settings.robot_within_m + 0.021) {
          EXPECT_GT(away_m, *found.links[k].least_m) << what << ", " << found.links[k].name;
        }
      }
    }
  }
  if (run.count >= 12) {
    EXPECT_GT(decided, 0);
    EXPECT_GT(none, 0);
    EXPECT_GT(of_several, 0);
  }
  std::cout << decided << " links decided by a camera, " << none << " not clear, " << of_several << " of " << run.count
            << " cells decided\n";
}

}  // namespace
}  // namespace depthgrid::avoidance
