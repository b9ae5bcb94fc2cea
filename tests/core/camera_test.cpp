// Equations (1)-(3), the pixel-edge convention, poses and rigs.
#include "depthgrid/core/camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/core/rig.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

PinholeCamera kinect() { return {640, 480, 525, 520, 320.5, 239.5}; }

TEST(Camera, ProjectsByHand) {
  const DepthPoint p = project(kinect(), {0.4, -0.2, 2.0});
  EXPECT_DOUBLE_EQ(p.x_px, 525 * 0.2 + 320.5);
  EXPECT_DOUBLE_EQ(p.y_px, -520 * 0.1 + 239.5);
  EXPECT_EQ(p.depth_m, 2.0);
}

TEST(Camera, ProjectionAndBackIsTheIdentity) {
  const test::RandomRun run = test::random_run(100'000);
  std::mt19937_64 random(run.seed);
  std::uniform_real_distribution<double> lateral(-5, 5);
  std::uniform_real_distribution<double> depth(0.1, 10);
  const PinholeCamera camera = kinect();
  for (std::int64_t i = 0; i < run.count; ++i) {
    const Vector3d p(lateral(random), lateral(random), depth(random));
    const Vector3d back = deproject(camera, project(camera, p));
    ASSERT_LT((back - p).norm(), 1e-13) << run.reproduce() << ", point " << p.transpose();
  }
}

TEST(Camera, WorldToDepthSpaceAndBack) {
  // (1) with the inverse of T_world_camera, then (2), and back by (3).
  const Pose T_world_camera = look_at({1, -3, 1.5}, {0, 0, 1});
  const Vector3d p_world(0.2, 0.3, 0.8);
  const DepthPoint p = project(kinect(), T_world_camera.inverse() * p_world);
  EXPECT_GT(p.depth_m, 0);
  EXPECT_LT((T_world_camera * deproject(kinect(), p) - p_world).norm(), 1e-13);
}

TEST(Camera, OpencvPutsThePixelCentreAtZero) {
  // A point that OpenCV projects to (0, 0) is the centre of the first pixel: (0.5, 0.5) between pixel edges.
  const PinholeCamera camera = from_opencv(640, 480, 525, 525, 319.5, 239.5);
  EXPECT_EQ(camera.cx_px, 320);
  EXPECT_EQ(camera.cy_px, 240);
  const Vector3d ray((0 - 319.5) / 525, (0 - 239.5) / 525, 1);
  EXPECT_NEAR(project(camera, ray).x_px, 0.5, 1e-12);
  EXPECT_NEAR(project(camera, ray).y_px, 0.5, 1e-12);
  EXPECT_EQ(principal_point_opencv(camera), Eigen::Vector2d(319.5, 239.5));
}

TEST(Camera, ContainsItsPixelsOnly) {
  const PinholeCamera camera = kinect();
  EXPECT_TRUE(camera.contains(0, 0));
  EXPECT_TRUE(camera.contains(639, 479));
  EXPECT_FALSE(camera.contains(-1, 0));
  EXPECT_FALSE(camera.contains(0, -1));
  EXPECT_FALSE(camera.contains(640, 0));
  EXPECT_FALSE(camera.contains(0, 480));
}

TEST(BrokenCamera, NamesValueAndRule) {
  const auto message = [](auto change) {
    PinholeCamera camera = kinect();
    change(camera);
    return test::thrown_message([&camera] { validate(camera, "camera 'left'"); });
  };
  EXPECT_EQ(message([](PinholeCamera&) {}), "");
  EXPECT_EQ(message([](PinholeCamera& c) { c.width_px = 0; }),
            "camera 'left': width is 0 px, must be between 1 and 16384");
  EXPECT_EQ(message([](PinholeCamera& c) { c.height_px = 16385; }),
            "camera 'left': height is 16385 px, must be between 1 and 16384");
  EXPECT_EQ(message([](PinholeCamera& c) { c.fx_px = 0; }),
            "camera 'left': fx is 0 px, must be a positive finite number");
  EXPECT_EQ(message([](PinholeCamera& c) { c.fy_px = -525; }),
            "camera 'left': fy is -525 px, must be a positive finite number");
  EXPECT_EQ(message([](PinholeCamera& c) { c.fx_px = kNaN; }),
            "camera 'left': fx is nan px, must be a positive finite number");
  EXPECT_EQ(message([](PinholeCamera& c) { c.cx_px = kInf; }), "camera 'left': cx is inf px, must be finite");
  EXPECT_EQ(message([](PinholeCamera& c) { c.cy_px = kNaN; }), "camera 'left': cy is nan px, must be finite");
  EXPECT_THAT(test::thrown_message([] { from_opencv(640, 480, 0, 525, 319.5, 239.5); }), HasSubstr("fx is 0 px"));
}

Matrix4d matrix_of(const Matrix3d& rotation, const Vector3d& translation = Vector3d(1, 2, 3)) {
  Matrix4d matrix = Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = rotation;
  matrix.topRightCorner<3, 1>() = translation;
  return matrix;
}

Matrix3d some_rotation() {
  return (Eigen::AngleAxisd(0.7, Vector3d(1, 2, -0.5).normalized()) * Eigen::AngleAxisd(-1.2, Vector3d::UnitX()))
      .toRotationMatrix();
}

TEST(PoseFromMatrix, KeepsAnExactPose) {
  const Pose pose = pose_from_matrix(matrix_of(some_rotation()));
  EXPECT_LT((pose.linear() - some_rotation()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(pose.translation(), Vector3d(1, 2, 3));
}

TEST(PoseFromMatrix, RepairsUpToTheToleranceAndRefusesBeyond) {
  // A scale of 1 + s puts 2 s + s^2 on the diagonal of R^T R - I.
  const auto scaled = [](double deviation) { return matrix_of(some_rotation() * std::sqrt(1.0 + deviation)); };
  for (const double deviation : {1e-6, 0.99e-3, -0.99e-3}) {
    const Pose pose = pose_from_matrix(scaled(deviation));
    EXPECT_LT((pose.linear() - some_rotation()).cwiseAbs().maxCoeff(), 1e-14) << deviation;
    EXPECT_LT((pose.linear().transpose() * pose.linear() - Matrix3d::Identity()).norm(), 1e-14);
  }
  for (const double deviation : {1.01e-3, -1.01e-3, 0.1}) {
    EXPECT_THAT(
        test::thrown_message([&] { pose_from_matrix(scaled(deviation), "T_world_cam"); }),
        AllOf(HasSubstr("T_world_cam: rotation deviates from orthonormal by 0."), HasSubstr("must be at most 0.001")))
        << deviation;
  }
}

TEST(PoseFromMatrix, RepairsShearToTheNearestRotation) {
  Matrix3d sheared = some_rotation();
  sheared(0, 1) += 4e-4;
  const Pose pose = pose_from_matrix(matrix_of(sheared));
  EXPECT_NEAR(pose.linear().determinant(), 1.0, 1e-14);
  EXPECT_LT((pose.linear() - sheared).norm(), 4e-4);
}

TEST(BrokenPose, NamesValueAndRule) {
  const auto message = [](const Matrix4d& matrix) {
    return test::thrown_message([&matrix] { pose_from_matrix(matrix, "T_world_cam"); });
  };
  Matrix3d mirrored = some_rotation();
  mirrored.col(0) *= -1;
  EXPECT_EQ(
      message(matrix_of(mirrored)),
      "T_world_cam: rotation has determinant -1, must be +1 (right-handed frames): one axis is turned round; "
      "where y is up in camera and world (ICL-NUIM), change the signs of the second row and of the second column, and "
      "of y in all points");
  Matrix4d broken = matrix_of(some_rotation());
  broken(1, 2) = kNaN;
  EXPECT_EQ(message(broken), "T_world_cam: entry (1, 2) is nan, must be a finite number");
  broken = matrix_of(some_rotation());
  broken(0, 3) = kInf;
  EXPECT_EQ(message(broken), "T_world_cam: entry (0, 3) is inf, must be a finite number");
  EXPECT_THAT(message(matrix_of(some_rotation()).transpose()),
              AllOf(HasSubstr("last row is (1 2 3 1)"), HasSubstr("is the matrix transposed?")));
  EXPECT_THAT(message(Matrix4d::Zero()), HasSubstr("last row"));
}

TEST(LookAt, PutsTheTargetInTheMiddleAndUpUp) {
  const Vector3d position(2, -1, 1.5);
  const Vector3d target(0, 0.5, 0.7);
  const Pose T_world_camera = look_at(position, target);
  const Vector3d target_camera = T_world_camera.inverse() * target;
  EXPECT_NEAR(target_camera.x(), 0, 1e-15);
  EXPECT_NEAR(target_camera.y(), 0, 1e-15);
  EXPECT_NEAR(target_camera.z(), (target - position).norm(), 1e-14);
  EXPECT_NEAR(T_world_camera.linear().determinant(), 1, 1e-14);
  EXPECT_NEAR(T_world_camera.linear().col(0).z(), 0, 1e-15);  // the image's rows are level
  EXPECT_LT(T_world_camera.linear().col(1).z(), 0);           // y points down
  EXPECT_EQ(T_world_camera.translation(), position);
}

TEST(LookAt, RefusesWhatHasNoDirection) {
  EXPECT_THAT(test::thrown_message([] { look_at({1, 1, 1}, {1, 1, 1}); }), HasSubstr("viewing direction (0 0 0)"));
  EXPECT_THAT(test::thrown_message([] { look_at({0, 0, 3}, {0, 0, 0}); }), HasSubstr("not parallel to up (0 0 1)"));
  EXPECT_THAT(test::thrown_message([] { look_at({0, kNaN, 3}, {0, 0, 0}); }), HasSubstr("viewing direction"));
  EXPECT_NO_THROW(look_at({0, 0, 3}, {0, 0, 0}, Vector3d::UnitY()));
}

Rig two_cameras() {
  Rig rig;
  rig.name = "cell";
  rig.cameras.resize(2);
  rig.cameras[0].id = "left";
  rig.cameras[1].id = "right";
  for (RigCamera& camera : rig.cameras) {
    camera.intrinsics = kinect();
  }
  return rig;
}

TEST(Rig, FindsCamerasById) {
  EXPECT_EQ(camera_index(two_cameras(), "right"), 1U);
  EXPECT_EQ(test::thrown_message([] { camera_index(two_cameras(), "top"); }),
            "rig 'cell': there is no camera 'top', its cameras are left, right");
}

TEST(BrokenRig, NamesValueAndRule) {
  const auto message = [](auto change) {
    Rig rig = two_cameras();
    change(rig);
    return test::thrown_message([&rig] { validate(rig); });
  };
  EXPECT_EQ(message([](Rig&) {}), "");
  EXPECT_EQ(message([](Rig& r) { r.cameras.clear(); }), "rig 'cell': has no camera, needs at least one");
  EXPECT_EQ(message([](Rig& r) { r.cameras[1].id = "left"; }),
            "rig 'cell': camera id 'left' occurs twice, ids must be distinct");
  EXPECT_EQ(message([](Rig& r) { r.cameras[0].id.clear(); }), "rig 'cell': a camera has an empty id");
  EXPECT_EQ(message([](Rig& r) { r.cameras[1].metres_per_unit = 0; }),
            "camera 'right': metres_per_unit is 0, must be between 1e-06 and 0.01; did you mean 0.001 (images in "
            "millimetres)?");
  EXPECT_EQ(message([](Rig& r) { r.cameras[1].rule.far_m = 0; }),
            "camera 'right': far is 0 m, must be greater than near (0 m)");
  EXPECT_THAT(message([](Rig& r) { r.cameras[1].T_world_camera.linear() *= 2; }),
              HasSubstr("camera 'right': T_world_camera: rotation deviates from orthonormal by 3"));
}

}  // namespace
}  // namespace depthgrid
