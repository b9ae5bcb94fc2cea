// Cameras expose at different times. An object that moves between two exposures is where it was for one camera and
// where it is for the other, and each sees through the place in which the other sees it: both together carve it away.
// To subtract its motion from the final distance does not bring it back; every camera has to give up what may have
// changed.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "depthgrid/simulation/scene.hpp"
#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;

constexpr double kBallRadiusM = 0.025;
constexpr double kFocalPx = 200;
constexpr double kFarthestBallM = 2.8;  ///< from either camera

RigCamera camera_at(const char* id, const Vector3d& position_world) {
  RigCamera camera;
  camera.id = id;
  camera.intrinsics = {160, 120, kFocalPx, kFocalPx, 80, 60};
  camera.T_world_camera = look_at(position_world, Vector3d::Zero());
  return camera;
}

/// A closed room, and a ball that passes its middle at time 0.
struct Crossing {
  Vector3d velocity_m_s;

  [[nodiscard]] simulation::Scene scene(double time_s) const {
    simulation::Scene scene;
    for (const Vector3d& normal : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0),
                                   Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
      scene.add(simulation::Plane{normal, -3.0});
    }
    scene.add(simulation::Sphere{ball_world(time_s), kBallRadiusM});
    return scene;
  }
  [[nodiscard]] Vector3d ball_world(double time_s) const {
    return Vector3d(0.02, -0.01, 0.015) + velocity_m_s * time_s;
  }
};

SearchSetup two_cameras() {
  SearchSetup setup;
  setup.rig.name = "two cameras at a right angle";
  setup.rig.cameras = {camera_at("along x", {-2.2, 0, 0}), camera_at("along y", {0, -2.2, 0.1})};
  setup.settings.space = views::BoxSpace{{-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}};
  setup.settings.policies = {views::Policy::ignored, views::Policy::ignored, views::Policy::obstacle, 0};
  // Rays through the pixels' centres may miss the ball's nearest point: the neighbourhood of a pixel holds a centre
  // that is nearer to the middle of the ball's image, or lies within sqrt(1/2) pixel of it. There the surface is up to
  // (0.71 px)^2 / (2 R) behind that point; twice that covers that rays are not parallel.
  const double pixel_m = kFarthestBallM / kFocalPx;
  CameraMargins margins;
  margins.sensor = {0.5 * pixel_m * pixel_m / kBallRadiusM, 0, 0, 1};
  margins.smallest_obstacle_m = 0;
  setup.settings.margins = {margins, margins};
  setup.settings.rho_m = 0.3;
  setup.settings.v_max_m_s = 0;
  return setup;
}

/// The images of one moment: each camera's own exposure.
struct Exposures {
  std::vector<simulation::View> views;
  std::vector<Frame> frames;

  /// `stamped_s`: what the frames say; `taken_s`: when they were.
  Exposures(const Rig& rig, const Crossing& crossing, const std::vector<double>& stamped_s,
            const std::vector<double>& taken_s) {
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      const RigCamera& camera = rig.cameras[k];
      views.push_back(crossing.scene(taken_s[k]).render(camera.intrinsics, camera.T_world_camera));
    }
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      const DepthImage& image = views[k].depth_m;
      Frame frame;
      frame.depth =
          depth_view(std::span(image.data(), image.index(0, image.height_px())), image.width_px(), image.height_px());
      frame.time_s = stamped_s[k];
      frames.push_back(frame);
    }
  }
};

/// In the ball, on it and around it, on all sides.
std::vector<Capsule> points_around(const Vector3d& ball_world, reference::Random& random) {
  std::vector<Capsule> points{Capsule::point(ball_world)};
  for (int i = 0; i < 15; ++i) {
    points.push_back(Capsule::point(ball_world + random.uniform(0, 0.25) * random.direction()));
  }
  return points;
}

/// In how many frames some answer exceeds the true distance by more than allowed_m.
struct Lost {
  int frames = 0;
  int lost = 0;
  double largest_m = 0;  ///< excess over the true distance
};

Lost count_lost(SearchSetup setup, const Crossing& crossing, const std::vector<double>& delays_s, double allowed_m,
                double stamp_error_s = 0) {
  Lost result;
  reference::Random random(5);
  Search search;
  views::ViewStore store(setup.rig, setup.settings);
  for (int i = -2; i <= 2; ++i) {
    const double t_ref_s = i * 0.0373;
    const std::vector<double> stamped_s{t_ref_s - delays_s[0], t_ref_s - delays_s[1]};
    std::vector<double> taken_s;
    for (const double time_s : stamped_s) {
      taken_s.push_back(time_s + random.uniform(-stamp_error_s, stamp_error_s));
    }
    const Exposures exposures(setup.rig, crossing, stamped_s, taken_s);
    for (std::size_t k = 0; k < exposures.frames.size(); ++k) {
      EXPECT_EQ(store.update(k, exposures.frames[k]).result, UpdateResult::taken);
    }
    const views::Snapshot snapshot = store.snapshot();
    EXPECT_EQ(snapshot.reference_time_s(), t_ref_s);
    const std::vector<Capsule> points = points_around(crossing.ball_world(t_ref_s), random);
    std::vector<Answer> answers(points.size());
    search.distances(snapshot, points, answers);
    const simulation::Scene truth = crossing.scene(t_ref_s);
    bool lost = false;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const double excess_m = answers[p].nearest.distance_m - truth.distance(points[p].a).distance_m;
      lost = lost || excess_m > allowed_m;
      result.largest_m = std::max(result.largest_m, excess_m);
    }
    ++result.frames;
    result.lost += lost ? 1 : 0;
  }
  return result;
}

/// Across both views, along either, and slanting.
std::vector<Vector3d> directions() {
  return {{0, 0, 1},
          {0, 0, -1},
          {1, 0, 0},
          {-1, 0, 0},
          {0, 1, 0},
          {0, -1, 0},
          Vector3d(1, 1, 0).normalized(),
          Vector3d(1, -1, 0).normalized(),
          Vector3d(-1, 1, 0.5).normalized(),
          Vector3d(-1, -1, -1).normalized()};
}

std::string name(double speed_m_s, double skew_s, const Vector3d& direction, std::size_t late) {
  std::ostringstream text;
  text << speed_m_s << " m/s towards " << direction.transpose() << ", camera " << late << " " << skew_s << " s early";
  return text.str();
}

template <class Check>
void for_crossings(Check&& check) {
  for (const double speed_m_s : {1.6, 2.0}) {
    for (const double skew_s : {0.033, 0.066}) {
      for (const Vector3d& direction : directions()) {
        for (const std::size_t early : {0U, 1U}) {
          SCOPED_TRACE(name(speed_m_s, skew_s, direction, early));
          std::vector<double> delays_s(2, 0.0);
          delays_s[early] = skew_s;
          check(Crossing{speed_m_s * direction}, speed_m_s, skew_s, delays_s);
        }
      }
    }
  }
}

TEST(TimeSkew, WithTheMarginTheBallIsNeverLost) {
  for_crossings([](const Crossing& crossing, double speed_m_s, double, const std::vector<double>& delays_s) {
    SearchSetup setup = two_cameras();
    setup.settings.v_max_m_s = speed_m_s;
    const Lost lost = count_lost(setup, crossing, delays_s, 0);
    EXPECT_EQ(lost.lost, 0) << "of " << lost.frames << " frames, by up to " << lost.largest_m << " m";
  });
}

/// Not where it flies straight away from the camera that is early: there it stays in its own shadow.
TEST(TimeSkew, WithoutTheMarginTheBallIsLost) {
  for_crossings([](const Crossing& crossing, double speed_m_s, double, const std::vector<double>& delays_s) {
    const Vector3d early_looks = delays_s[0] > 0 ? Vector3d::UnitX() : Vector3d::UnitY();
    if (crossing.velocity_m_s.dot(early_looks) > 0.99 * speed_m_s) {
      return;
    }
    const Lost lost = count_lost(two_cameras(), crossing, delays_s, 0);
    EXPECT_GT(lost.lost, 0) << "of " << lost.frames << " frames";
  });
}

/// Across both views, and by more than its size as the images show it (a pixel and a half larger on each side), nothing
/// of the ball is left: to subtract the motion from the answer is not enough.
TEST(TimeSkew, SubtractingTheMotionFromTheAnswerDoesNotBringTheBallBack) {
  const double seen_m = 2 * (kBallRadiusM + 1.5 * kFarthestBallM / kFocalPx);
  int told = 0;
  for_crossings([&](const Crossing& crossing, double speed_m_s, double skew_s, const std::vector<double>& delays_s) {
    if (speed_m_s * skew_s > seen_m && std::abs(crossing.velocity_m_s.z()) == speed_m_s) {
      const Lost lost = count_lost(two_cameras(), crossing, delays_s, speed_m_s * skew_s);
      EXPECT_GT(lost.lost, 0) << "of " << lost.frames << " frames";
      ++told;
    }
  });
  EXPECT_GT(told, 0);
}

TEST(TimeSkew, ABallThatIsSeenAtOneTimeIsNotLost) {
  for (const Vector3d& direction : directions()) {
    const Lost lost = count_lost(two_cameras(), {2.0 * direction}, {0, 0}, 0);
    EXPECT_EQ(lost.lost, 0) << direction.transpose() << ": by up to " << lost.largest_m << " m";
  }
}

TEST(TimeSkew, TimeStampsMayErrByWhatIsStated) {
  int lost_without = 0;
  for_crossings([&](const Crossing& crossing, double speed_m_s, double, const std::vector<double>& delays_s) {
    SearchSetup setup = two_cameras();
    setup.settings.v_max_m_s = speed_m_s;
    constexpr double kErrorS = 0.02;
    lost_without += count_lost(setup, crossing, delays_s, 0, kErrorS).lost;
    for (CameraMargins& margins : setup.settings.margins) {
      margins.time_uncertainty_s = kErrorS;
    }
    const Lost lost = count_lost(setup, crossing, delays_s, 0, kErrorS);
    EXPECT_EQ(lost.lost, 0) << "of " << lost.frames << " frames, by up to " << lost.largest_m << " m";
  });
  EXPECT_GT(lost_without, 0);
}

}  // namespace
}  // namespace depthgrid::search
