// A program compiled for AVX2 beside a library that is not: the same layout, the same allocations, the same answers.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "depthgrid/search/search.hpp"

namespace depthgrid {
namespace {

TEST(WiderVectors, TheLibraryAnswersAProgramForANewerProcessor) {
  if (__builtin_cpu_supports("avx2") == 0) {
    GTEST_SKIP() << "this processor has no AVX2";
  }
  // Dynamic objects of this program between those of the library: both use the same allocation functions.
  std::vector<Eigen::VectorXd> own;
  for (int n = 1; n < 40; ++n) {
    own.emplace_back(Eigen::VectorXd::LinSpaced(n, 0, 1));
  }
  Rig rig;
  rig.name = "one";
  RigCamera camera;
  camera.id = "front";
  camera.intrinsics = {64, 48, 50, 50, 32, 24};
  camera.T_world_camera = look_at({0, 0, 0}, {1, 0, 0});
  rig.cameras.assign(3, camera);
  rig.cameras[1].id = "second";
  rig.cameras[2].id = "third";
  views::Settings settings;
  settings.space = views::BoxSpace{{-3, -3, -3}, {3, 3, 3}};
  settings.policies = {views::Policy::ignored, views::Policy::ignored, views::Policy::obstacle, 0};
  settings.margins.resize(3, CameraMargins{.sensor = {}, .smallest_obstacle_m = 0});
  settings.v_max_m_s = 0;
  views::ViewStore store(rig, settings);
  const std::vector<float> wall_m(64 * 48, 2.0F);
  Frame frame;
  frame.depth = {wall_m.data(), DepthFormat::float32_metres, 64, 48, 0, 1.0};
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(store.update(k, frame).result, UpdateResult::taken);
  }
  search::Search search;
  std::vector<Answer> answers(2);
  const std::vector<Capsule> asked{Capsule::point({1.8, 0, 0}), Capsule::sphere({1.8, 0.1, 0}, 0.05)};
  search.distances(store.snapshot(), asked, answers);
  EXPECT_NEAR(answers[0].nearest.distance_m, 0.2, 0.006);
  EXPECT_LE(answers[0].nearest.distance_m, 0.2);
  EXPECT_NEAR(answers[1].nearest.distance_m, 0.15, 0.006);
  EXPECT_NEAR(answers[0].nearest.direction_world.x(), 1, 0.1);
  EXPECT_EQ(own.back().size(), 39);
}

}  // namespace
}  // namespace depthgrid
