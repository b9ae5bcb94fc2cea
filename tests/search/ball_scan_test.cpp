// A ball meets what one camera has not seen free exactly if it meets the not known free part of one of its pixels,
// whatever vectors, blocks and windows the pixels are looked for with.
#include "depthgrid/views/ball_scan.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/views/ball_query.hpp"
#include "depthgrid/views/prepared_image.hpp"
#include "depthgrid/views/view_store.hpp"
#include "reference/random_problem.hpp"
#include "support/random_run.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Random;
using views::Clip;
using views::LocalCamera;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// What meets_not_known_free() is exact to.
constexpr double kExactM = 3e-9;

/// One camera at the origin with walls, thin things before them, and a robot that is not seen where it is.
class Scene {
 public:
  explicit Scene(Random& random) {
    const int width_px = random.integer(1, 320);
    const int height_px = random.integer(1, 140);
    const double focal_px = random.uniform(0.35, 1.2) * width_px;
    camera_.id = "front";
    camera_.intrinsics = {width_px,
                          height_px,
                          focal_px,
                          focal_px * random.uniform(0.9, 1.1),
                          width_px * random.uniform(0.3, 0.7),
                          height_px * random.uniform(0.3, 0.7)};
    camera_.rule.near_m = random.chance(0.5) ? 0.0 : random.uniform(0.1, 0.6);
    const auto pixels = static_cast<std::size_t>(width_px * height_px);
    depth_m_.assign(pixels, static_cast<float>(random.uniform(2, 4)));
    const auto fill = [&](std::vector<float>& image, int most_px, float value) {
      const int u0 = random.integer(0, width_px - 1);
      const int v0 = random.integer(0, height_px - 1);
      const int u1 = std::min(u0 + random.integer(1, most_px), width_px);
      const int v1 = std::min(v0 + random.integer(1, most_px), height_px);
      for (int v = v0; v < v1; ++v) {
        std::fill(image.begin() + v * width_px + u0, image.begin() + v * width_px + u1, value);
      }
    };
    for (int n = random.integer(0, 12); n > 0; --n) {
      fill(depth_m_, random.chance(0.7) ? 1 : 40, static_cast<float>(random.chance(0.2) ? 0 : random.uniform(0.4, 3)));
    }
    near_m_.assign(pixels, 0.0F);
    far_m_.assign(pixels, 0.0F);
    for (int n = random.integer(0, 3); n > 0; --n) {
      const double from_m = random.uniform(0.3, 2.5);
      Random same = random;  // both ends at the same pixels
      fill(near_m_, 60, static_cast<float>(from_m));
      random = same;
      fill(far_m_, 60, static_cast<float>(from_m + 0.4));
    }
    Rig rig;
    rig.name = "one camera";
    rig.cameras = {camera_};
    views::Settings settings;
    settings.space = views::BoxSpace{{-5, -5, -5}, {5, 5, 5}};
    settings.policies = {views::Policy::obstacle, views::Policy::obstacle, views::Policy::obstacle, 0};
    settings.margins = {CameraMargins{.sensor = {0, 0, 0, 0}, .smallest_obstacle_m = 0}};
    settings.v_max_m_s = 0;
    store_.emplace(rig, settings);
    EXPECT_EQ(
        store_->update(0, {depth_view(depth_m_, width_px, height_px), {near_m_.data(), far_m_.data(), width_px}, 1.0})
            .result,
        UpdateResult::taken);
    snapshot_.emplace(store_->snapshot());
    make_local(*snapshot_, 0, Vector3d::Zero(), 6, local_);
  }

  [[nodiscard]] const LocalCamera& local() const { return local_; }
  [[nodiscard]] const PinholeCamera& pinhole() const { return camera_.intrinsics; }

  /// The depths of a pixel that are not known free, each part closed.
  [[nodiscard]] std::vector<std::array<double, 2>> not_free(int u, int v) const {
    const views::PreparedImage& image = views::prepared(snapshot_->view(0));
    const double blind_m = camera_.rule.near_m;
    const double free_m = static_cast<double>(image.free_m.at(u, v));
    std::vector<std::array<double, 2>> parts{{std::max(free_m, blind_m), kInfinity}};
    if (blind_m > 0) {
      parts.push_back({0, blind_m});
    }
    if (!image.has_islands || !(image.island_near_m.at(u, v) <= image.island_far_m.at(u, v))) {
      return parts;
    }
    const double low_m = static_cast<double>(image.island_near_m.at(u, v));
    const double high_m = static_cast<double>(image.island_far_m.at(u, v));
    std::vector<std::array<double, 2>> rest;
    for (const auto& [begin_m, end_m] : parts) {
      if (begin_m < low_m) {
        rest.push_back({begin_m, std::min(end_m, low_m)});
      }
      if (end_m > high_m) {
        rest.push_back({std::max(begin_m, high_m), end_m});
      }
    }
    return rest;
  }

  /// How far from a point the nearest not known free part of any pixel is.
  [[nodiscard]] double distance_m(const Vector3d& p) const {
    double square = kInfinity;
    for (int v = 0; v < pinhole().height_px; ++v) {
      for (int u = 0; u < pinhole().width_px; ++u) {
        for (const auto& [begin_m, end_m] : not_free(u, v)) {
          square = std::min(square, squared_distance(pixel_frustum(pinhole(), u, v, begin_m, end_m), p));
        }
      }
    }
    return std::sqrt(square);
  }

  /// A point where something begins or ends: in a pixel that differs from the wall around it, if there is one.
  [[nodiscard]] Vector3d somewhere(Random& random) const {
    int u = 0;
    int v = 0;
    for (int attempt = 0; attempt < 300; ++attempt) {
      u = random.integer(0, pinhole().width_px - 1);
      v = random.integer(0, pinhole().height_px - 1);
      if (depth_m_[static_cast<std::size_t>(v * pinhole().width_px + u)] < 1.9F) {
        break;
      }
    }
    const std::vector<std::array<double, 2>> parts = not_free(u, v);
    const auto& part = parts[static_cast<std::size_t>(random.integer(0, static_cast<int>(parts.size()) - 1))];
    const double end_m = random.chance(0.5) && part[1] < kInfinity ? part[1] : part[0];
    const double depth_m = std::max(end_m + (random.chance(0.5) ? random.uniform(0, 0.5) : 0.0), 0.05);
    return deproject(pinhole(), {u + random.uniform(0, 1), v + random.uniform(0, 1), depth_m});
  }

 private:
  RigCamera camera_;
  std::vector<float> depth_m_, near_m_, far_m_;
  std::optional<views::ViewStore> store_;
  std::optional<views::Snapshot> snapshot_;
  LocalCamera local_;
};

struct BallCase {
  Vector3d p;
  double radius_m;
  double distance_m;  ///< of the centre from what is not known free
};

std::vector<BallCase> random_balls(const Scene& scene, Random& random) {
  std::vector<BallCase> balls;
  for (int n = 0; n < 30; ++n) {
    const double reach_m = std::exp(random.uniform(std::log(0.003), std::log(0.8)));
    const Vector3d p = scene.somewhere(random) + random.uniform(0, 1) * reach_m * random.direction();
    const double distance_m = scene.distance_m(p);
    // Balls that hardly meet it, and balls that hardly do not.
    for (const double share : {0.5, 0.999, 1.001, 1.2}) {
      balls.push_back({p, distance_m > 0 ? share * distance_m : reach_m, distance_m});
    }
  }
  return balls;
}

bool is_scanned(const Scene& scene, const BallCase& ball) {
  return ball.p.z() - ball.radius_m > scene.local().near_m && ball.p.z() > ball.radius_m;
}

TEST(Balls, MeetWhatOneOfThePixelsHasNotFree) {
  const test::RandomRun run = test::random_run(100);
  int met = 0;
  int passed = 0;
  int large = 0;
  for (std::int64_t n = 0; n < run.count && !testing::Test::HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    Random random(again.seed);
    const Scene scene(random);
    const std::vector<BallCase> balls = random_balls(scene, random);
    // What lies outside the image does not count, so that balls may reach over its edges.
    const Clip clip{true, 0, kInfinity, 0, std::numeric_limits<float>::infinity()};
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      for (const BallCase& ball : balls) {
        const bool answer = meets_not_known_free(scene.local(), clip, ball.p, ball.radius_m);
        EXPECT_TRUE(answer || ball.distance_m > ball.radius_m)
            << hwy::TargetName(target) << ": a ball around " << ball.p.transpose() << " of radius " << ball.radius_m
            << " meets what is " << ball.distance_m << " m away";
        EXPECT_TRUE(!answer || ball.distance_m <= ball.radius_m + kExactM)
            << hwy::TargetName(target) << ": a ball around " << ball.p.transpose() << " of radius " << ball.radius_m
            << " does not reach what is " << ball.distance_m << " m away";
        met += answer && is_scanned(scene, ball) ? 1 : 0;
        passed += !answer && is_scanned(scene, ball) ? 1 : 0;
        large += !answer && 2 * ball.radius_m / ball.p.z() * scene.pinhole().fx_px > 80 ? 1 : 0;
      }
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  EXPECT_TRUE((met > 100 && passed > 100 && large > 20) || run.count < 100) << met << ", " << passed << ", " << large;
}

/// Where what lies outside of the image counts, however little of the ball does and at whichever side.
TEST(Balls, MeetWhatLiesOutsideOfTheImage) {
  const test::RandomRun run = test::random_run(100);
  int left = 0;
  for (std::int64_t n = 0; n < run.count && !testing::Test::HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    Random random(again.seed);
    const Scene scene(random);
    const PinholeCamera& c = scene.pinhole();
    for (int i = 0; i < 40; ++i) {
      const double z_m = random.uniform(0.7, 1.5);
      const double radius_m = random.uniform(0.002, 0.05);
      const bool across = random.chance(0.5);
      const bool first = random.chance(0.5);
      // A border's plane x = s z, and a place within reach of it near some row, or column.
      const double slope =
          across ? ((first ? 0 : c.width_px) - c.cx_px) / c.fx_px : ((first ? 0 : c.height_px) - c.cy_px) / c.fy_px;
      const double in_m = random.uniform(0, 0.99) * radius_m * std::sqrt(1 + slope * slope) * (first ? 1 : -1);
      const double along = random.uniform(0.3, 0.7);
      const double other =
          across ? (along * c.height_px - c.cy_px) / c.fy_px : (along * c.width_px - c.cx_px) / c.fx_px;
      const Vector3d p =
          across ? Vector3d(slope * z_m + in_m, other * z_m, z_m) : Vector3d(other * z_m, slope * z_m + in_m, z_m);
      EXPECT_TRUE(meets_not_known_free(scene.local(), Clip{}, p, radius_m)) << p.transpose() << ", " << radius_m;
      ++left;
    }
  }
  EXPECT_GT(left, 0);
}

}  // namespace
}  // namespace depthgrid::search
