// Every setting that is missing or out of range is refused with its value, the rule and what to do.
#include "depthgrid/views/settings.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <string>

#include "depthgrid/views/view_store.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::views {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Rig two_cameras() {
  Rig rig{.name = "cell", .cameras = std::vector<RigCamera>(2), .T_floor_world = {}};
  for (RigCamera& camera : rig.cameras) {
    camera.intrinsics = {8, 6, 10, 10, 4, 3};
  }
  rig.cameras[0].id = "left";
  rig.cameras[1].id = "right";
  return rig;
}

Settings good() {
  Settings settings;
  settings.space = BoxSpace{{-1, -1, 0}, {1, 1, 2}};
  settings.policies = {Policy::obstacle, Policy::ignored, Policy::obstacle, 0};
  settings.margins.resize(2, CameraMargins{.sensor = {}, .smallest_obstacle_m = 0});
  settings.v_max_m_s = 1.6;
  return settings;
}

/// The message for good settings after a change.
std::string message(const std::function<void(Settings&)>& change) {
  Settings settings = good();
  change(settings);
  return test::thrown_message([&settings] { validate(settings, two_cameras()); });
}

std::string message(const FrustumSpace& space) {
  return message([&space](Settings& s) { s.space = space; });
}

std::string message(const BoxSpace& space) {
  return message([&space](Settings& s) { s.space = space; });
}

TEST(SearchSettings, AcceptsWhatIsDeclared) {
  EXPECT_EQ(message([](Settings&) {}), "");
  EXPECT_EQ(message(FrustumSpace{1, 0, 3}), "");
  EXPECT_EQ(message([](Settings& s) { s.policies = {Policy::ignored, Policy::obstacle, Policy::ignored, 0.05}; }), "");
  EXPECT_EQ(message([](Settings& s) { s.v_max_m_s = 0; }), "");
  EXPECT_EQ(message([](Settings& s) { s.resolution_m = s.rho_m; }), "");
}

TEST(SearchSettings, HasNoSilentDefaults) {
  const std::string untouched = test::thrown_message([] { validate(Settings{}, two_cameras()); });
  EXPECT_EQ(untouched, "search settings: the space of interest is not set: choose a FrustumSpace or a BoxSpace");
  EXPECT_EQ(message([](Settings& s) { s.policies.unobserved = Policy::undeclared; }),
            "search settings: policy for unobserved space is not declared: choose obstacle or ignored");
  EXPECT_EQ(message([](Settings& s) { s.policies.outside = Policy::undeclared; }),
            "search settings: policy for space outside W is not declared: choose obstacle or ignored");
  EXPECT_EQ(message([](Settings& s) { s.policies.robot_pockets = Policy::undeclared; }),
            "search settings: policy for pockets behind the robot is not declared: choose obstacle or ignored");
  EXPECT_EQ(message([](Settings& s) { s.policies.outside = static_cast<Policy>(7); }),
            "search settings: policy for space outside W is not declared: choose obstacle or ignored");
  EXPECT_EQ(
      message([](Settings& s) { s.v_max_m_s = kNaN; }),
      "search settings: v_max, the speed of the fastest obstacle, is not set: 1.6 m/s for walking and 2 m/s for the "
      "motion of arms are ISO 13855's values; 0 only if all cameras expose at one instant or nothing moves");
  EXPECT_EQ(message([](Settings& s) { s.margins.resize(1); }),
            "search settings: there are margins for 1 cameras, must be one for each of the rig's 2");
}

TEST(SearchSettings, ChecksTheSpace) {
  EXPECT_EQ(message(FrustumSpace{2, 0.5, 3}),
            "search settings: principal camera is 2, the rig has 2 cameras, counted from 0");
  EXPECT_EQ(message(FrustumSpace{0, -0.5, 3}), "search settings: d_min is -0.5 m, must be between 0 and 100000 m");
  EXPECT_EQ(message(FrustumSpace{0, kNaN, 3}), "search settings: d_min is nan m, must be between 0 and 100000 m");
  const auto d_max = [](const std::string& value) {
    return "search settings: d_max is " + value + " m, must be greater than d_min (0.5 m) and at most 100000 m";
  };
  EXPECT_EQ(message(FrustumSpace{0, 0.5, 0.5}), d_max("0.5"));
  EXPECT_EQ(message(FrustumSpace{0, 0.5, kNaN}), d_max("nan"));
  EXPECT_EQ(message(FrustumSpace{0, 0.5, kInf}), d_max("inf"));
  EXPECT_EQ(message(BoxSpace{{-1, 1, 0}, {1, 1, 2}}),
            "search settings: box reaches from 1 to 1 m in y, the low corner must lie below the high one");
  EXPECT_EQ(
      message(BoxSpace{{-1, -1, 0}, {1, 1, kInf}}),
      "search settings: box reaches from 0 to inf m in z, must stay within 100000 m of the world's origin; a space "
      "without limits is not possible");
  EXPECT_EQ(
      message(BoxSpace{{kNaN, -1, 0}, {1, 1, 2}}),
      "search settings: box reaches from nan to 1 m in x, must stay within 100000 m of the world's origin; a space "
      "without limits is not possible");
}

TEST(SearchSettings, ChecksTheWidthOfTheSpace) {
  EXPECT_EQ(message(BoxSpace{{-100, -1, 0}, {100, 1, 2}}),
            "search settings: the space of interest is up to 200 m wide, must be at most 32768 times the resolution, "
            "163.84 m: nothing beyond the robot's reach and rho around it is needed");
  EXPECT_EQ(message([](Settings& s) {
              s.space = BoxSpace{{-10, -1, 0}, {10, 1, 2}};
              s.resolution_m = 0.0005;
            }).substr(0, 58),
            "search settings: the space of interest is up to 20 m wide,");
}

TEST(SearchSettings, ChecksThePocket) {
  EXPECT_EQ(message([](Settings& s) { s.policies.ignored_pocket_m = 0.05; }),
            "search settings: ignored_pocket is 0.05 m, must be 0 where pockets behind the robot count as obstacle; "
            "declare them ignored to use it");
  for (const auto& [value, text] : {std::pair(-0.01, "-0.01"), {kNaN, "nan"}, {kInf, "inf"}}) {
    EXPECT_EQ(
        message([v = value](Settings& s) {
          s.policies = {Policy::obstacle, Policy::obstacle, Policy::ignored, v};
        }),
        std::string("search settings: ignored_pocket is ") + text + " m, must be a finite number that is not negative");
  }
}

TEST(SearchSettings, ChecksTheMarginsOfEveryCamera) {
  const auto refused = [](double CameraMargins::*part, double value) {
    return message([&](Settings& s) { s.margins[1].*part = value; });
  };
  const std::string start = "search settings: camera 'right': ";
  const std::string rule = ", must be a finite number that is not negative";
  EXPECT_EQ(refused(&CameraMargins::translation_m, -0.5), start + "translation is -0.5 m" + rule);
  EXPECT_EQ(refused(&CameraMargins::rotation_rad, kNaN), start + "rotation is nan rad" + rule);
  EXPECT_EQ(refused(&CameraMargins::half_exposure_s, kInf), start + "half exposure is inf s" + rule);
  EXPECT_EQ(refused(&CameraMargins::time_uncertainty_s, -1), start + "time uncertainty is -1 s" + rule);
  EXPECT_EQ(refused(&CameraMargins::smallest_obstacle_m, -0.02), start + "smallest obstacle is -0.02 m" + rule);
  EXPECT_EQ(message([](Settings& s) { s.margins[1].sensor.lateral_px = 17; }),
            start + "filter radius is 17 px, must be between 0 and 16");
}

TEST(SearchSettings, WantTheSmallestObstacleDeclared) {
  EXPECT_EQ(message([](Settings& s) { s.margins[0].smallest_obstacle_m = 0.05; }), "");
  EXPECT_THAT(message([](Settings& s) { s.margins[1] = CameraMargins{}; }),
              testing::StartsWith("search settings: camera 'right': the smallest obstacle is not declared"));
}

TEST(SearchSettings, ChecksTheNumbers) {
  const auto refused = [](double Settings::*part, double value) {
    return message([&](Settings& s) { s.*part = value; });
  };
  const std::string start = "search settings: ";
  const std::string rho = " m, must be greater than 0 and at most 100 m";
  EXPECT_EQ(refused(&Settings::rho_m, 0), start + "rho is 0" + rho);
  EXPECT_EQ(refused(&Settings::rho_m, kNaN), start + "rho is nan" + rho);
  EXPECT_EQ(refused(&Settings::rho_m, kInf), start + "rho is inf" + rho);
  const std::string resolution = " m, must be between 0.0005 m and rho (0.4 m)";
  EXPECT_EQ(refused(&Settings::resolution_m, 0.0004), start + "resolution is 0.0004" + resolution);
  EXPECT_EQ(refused(&Settings::resolution_m, 0.5), start + "resolution is 0.5" + resolution);
  EXPECT_EQ(refused(&Settings::resolution_m, kNaN), start + "resolution is nan" + resolution);
  EXPECT_EQ(refused(&Settings::v_max_m_s, -1), start + "v_max is -1 m/s, must be a finite number that is not negative");
  EXPECT_EQ(refused(&Settings::v_max_m_s, kInf),
            start + "v_max is inf m/s, must be a finite number that is not negative");
  EXPECT_EQ(refused(&Settings::max_frame_age_s, -1), start + "max_frame_age is -1 s, must not be negative");
  EXPECT_EQ(refused(&Settings::max_frame_age_s, kNaN), start + "max_frame_age is nan s, must not be negative");
  EXPECT_EQ(refused(&Settings::direction_blend, 1.1), start + "direction_blend is 1.1, must be between 0 and 1");
  EXPECT_EQ(refused(&Settings::repulsion_alpha, -1), start + "repulsion_alpha is -1, must be between 0 and 100");
}

TEST(SearchSettings, ChecksTheNumberOfCameras) {
  Rig rig = two_cameras();
  Settings settings = good();
  rig.cameras.resize(17, rig.cameras[0]);
  settings.margins.resize(17);
  EXPECT_EQ(test::thrown_message([&] { validate(settings, rig); }),
            "search settings: the rig has 17 cameras, at most 16 are supported");
}

TEST(ViewStoreErrors, RefusesWhatItCannotUse) {
  EXPECT_EQ(test::thrown_message([] { ViewStore(two_cameras(), good()); }), "");
  EXPECT_EQ(test::thrown_message([] { ViewStore(two_cameras(), good(), 0); }),
            "view store: held_snapshots is 0, must be between 1 and 13");
  EXPECT_EQ(test::thrown_message([] { ViewStore(two_cameras(), good(), 14); }),
            "view store: held_snapshots is 14, must be between 1 and 13");
  EXPECT_EQ(test::thrown_message([] { ViewStore(two_cameras(), Settings{}); }),
            "search settings: the space of interest is not set: choose a FrustumSpace or a BoxSpace");
  EXPECT_EQ(test::thrown_message([] { ViewStore(Rig{}, good()); }), "rig '': has no camera, needs at least one");
  Rig distorted = two_cameras();
  distorted.cameras[1].distortion =
      make_distortion(Distortion::Model::plumb_bob, std::array{-0.1, 0.01, 0.001, 0.0, 0.0});
  EXPECT_EQ(test::thrown_message([&] { ViewStore(distorted, good()); }),
            "view store: camera 'right' has lens distortion, its images must be undistorted first and the rig given "
            "without distortion");
}

}  // namespace
}  // namespace depthgrid::views
