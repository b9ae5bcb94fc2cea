// Motion files: a small one by hand, broken ones, and CMU's where they are present (DEPTHGRID_DATA).
#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/mocap_clip.hpp"

namespace depthgrid::simulation::testing {
namespace {

/// A thigh down from the root, a shank down from the thigh; the shank's frame is turned by 90 degrees about z.
constexpr const char* kAsf = R"(# remark
:version 1.10
:units
  mass 1.0
  length 0.0254
  angle deg
:root
   order TX TY TZ RX RY RZ
:bonedata
  begin
     id 1
     name lfemur
     direction 0 -1 0
     length 0.5
     axis 0 0 0 XYZ
     dof rx ry rz
     limits (-160.0 20.0)
            (-70.0 70.0)
            (-60.0 70.0)
  end
  begin
     id 2
     name ltibia
     direction 0 -1 0
     length 0.4
     axis 0 0 90 XYZ
     dof rx
  end
:hierarchy
  begin
    root lfemur
    lfemur ltibia
  end
)";

constexpr const char* kAmc = R"(#!OML
:FULLY-SPECIFIED
:DEGREES
1
root 0 1 0 0 0 0
lfemur 0 0 0
ltibia 0
2
root 0.01 1 0 0 90 0
lfemur 90 0 0
ltibia 90
)";

TEST(Mocap, AnglesTurnAboutTheAxesOfTheBone) {
  const MocapSkeleton skeleton = parse_asf(kAsf, "asf");
  ASSERT_EQ(skeleton.bones.size(), 2U);
  EXPECT_EQ(skeleton.bones[1].name, "ltibia");
  EXPECT_EQ(*skeleton.bones[1].parent, 0U);
  const std::vector<MocapFrame> frames = parse_amc(kAmc, skeleton, "amc");
  ASSERT_EQ(frames.size(), 2U);
  const MocapJoints straight = joints(skeleton, frames[0]);
  EXPECT_LT((straight.end_m[0] - Eigen::Vector3d(0, 0.5, 0)).norm(), 1e-12);
  EXPECT_LT((straight.end_m[1] - Eigen::Vector3d(0, 0.1, 0)).norm(), 1e-12);
  // The thigh forward: about x by 90 degrees -y becomes -z, which the root turns to -x. The shank's x axis is the y
  // axis of the thigh, about which nothing that points along y turns.
  const MocapJoints bent = joints(skeleton, frames[1]);
  EXPECT_LT((bent.end_m[0] - Eigen::Vector3d(-0.49, 1, 0)).norm(), 1e-12);
  EXPECT_LT((bent.end_m[1] - Eigen::Vector3d(-0.89, 1, 0)).norm(), 1e-12);
}

TEST(Mocap, AClipIsZUpAndMovesStraightBetweenFrames) {
  const MocapSkeleton skeleton = parse_asf(kAsf, "asf");
  const MocapClip clip(skeleton, parse_amc(kAmc, skeleton, "amc"), 10);
  EXPECT_DOUBLE_EQ(clip.duration_s(), 0.1);
  const Eigen::Vector3d knee = clip.at(0)[0].b;
  const Eigen::Vector3d knee_after = clip.at(0.1)[0].b;
  EXPECT_LT((knee - Eigen::Vector3d(0, 0, 0.5)).norm(), 1e-12);
  EXPECT_LT((knee_after - Eigen::Vector3d(-0.49, 0, 1)).norm(), 1e-12);
  EXPECT_LT((clip.at(0.05)[0].b - 0.5 * (knee + knee_after)).norm(), 1e-12);
  EXPECT_EQ(clip.at(-1)[0].b, knee);
  EXPECT_EQ(clip.at(7)[0].b, knee_after);
  const double ankle_m_s = Eigen::Vector3d(-0.89, 0, 0.9).norm() * 10;
  EXPECT_NEAR(clip.v_max_m_s(), ankle_m_s, 1e-9);
  Pose T_world_floor = Pose::Identity();
  T_world_floor.translation() = Eigen::Vector3d(1, 2, 3);
  EXPECT_LT((clip.at(0, T_world_floor)[0].b - Eigen::Vector3d(1, 2, 3.5)).norm(), 1e-12);
}

std::string as_windows_writes(const std::string& text) {
  std::string result = "\xEF\xBB\xBF";
  for (const char c : text) {
    result += c == '\n' ? "\r\n" : std::string(1, c);
  }
  return result;
}

TEST(Mocap, AByteOrderMarkAndWindowsLinesAreIgnored) {
  const MocapSkeleton skeleton = parse_asf(as_windows_writes(kAsf), "asf");
  ASSERT_EQ(skeleton.bones.size(), 2U);
  EXPECT_EQ(skeleton.bones[1].name, "ltibia");
  EXPECT_EQ(parse_amc(as_windows_writes(kAmc), skeleton, "amc").size(), 2U);
}

std::string refusal(std::string asf, const std::string& from, const std::string& to, std::string amc = kAmc) {
  for (std::string* text : {&asf, &amc}) {
    const std::size_t at = text->find(from);
    if (at != std::string::npos) {
      text->replace(at, from.size(), to);
    }
  }
  try {
    const MocapSkeleton skeleton = parse_asf(asf, "asf");
    (void)parse_amc(amc, skeleton, "amc");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

// The same motion in radians, whichever of the two files says so; what it says and is not known is no detail.
TEST(Mocap, TheFramesSayTheirUnitOfAngles) {
  const auto last = [](const std::string& asf, const std::string& amc) {
    const MocapSkeleton skeleton = parse_asf(asf, "asf");
    return joints(skeleton, parse_amc(amc, skeleton, "amc").back()).end_m;
  };
  const auto with = [](std::string text, const std::vector<std::pair<std::string, std::string>>& changes) {
    for (const auto& [from, to] : changes) {
      const std::size_t at = text.find(from);
      EXPECT_NE(at, std::string::npos) << from;
      text.replace(at, from.size(), to);
    }
    return text;
  };
  const std::string quarter = std::to_string(std::numbers::pi / 2);  // six digits
  const std::string asf_rad = with(kAsf, {{"angle deg", "angle rad"}, {"0 0 90 XYZ", "0 0 " + quarter + " XYZ"}});
  const std::vector<std::pair<std::string, std::string>> in_radians = {
      {"0 90 0\n", "0 " + quarter + " 0\n"}, {"lfemur 90", "lfemur " + quarter}, {"ltibia 90", "ltibia " + quarter}};
  const std::string amc_rad = with(kAmc, in_radians);
  const std::vector<Eigen::Vector3d> expected = last(kAsf, kAmc);
  const auto same = [&expected](const std::vector<Eigen::Vector3d>& ends) {
    return (ends[0] - expected[0]).norm() < 1e-5 && (ends[1] - expected[1]).norm() < 1e-5;
  };
  EXPECT_TRUE(same(last(kAsf, with(amc_rad, {{":DEGREES", ":RADIANS"}}))));
  EXPECT_TRUE(same(last(asf_rad, with(amc_rad, {{":DEGREES\n", ""}}))));
  EXPECT_TRUE(same(last(asf_rad, kAmc)));
  EXPECT_FALSE(same(last(kAsf, amc_rad)));
  EXPECT_EQ(refusal(kAsf, ":DEGREES", ":DEGREES\n:RADIANS"),
            "amc, line 4: says :DEGREES and :RADIANS, must say one of them");
  EXPECT_EQ(refusal(kAsf, ":DEGREES", ":GRADIANS"),
            "amc, line 3: ':GRADIANS' is not known, must be :FULLY-SPECIFIED, :DEGREES or :RADIANS");
}

TEST(Mocap, BrokenFilesAreRefusedWithLineAndRule) {
  EXPECT_EQ(refusal(kAsf, "", ""), "accepted");
  EXPECT_EQ(refusal(kAsf, "length 0.4", "length 400"),
            "asf, line 28: bone 'ltibia' has no name, no direction, or is not 0 to 2.000000 m long");
  EXPECT_EQ(refusal(kAsf, "dof rx ry rz", "dof rx l"),
            "asf, line 16: bone 'lfemur' moves in 'l', must be rx, ry or rz");
  EXPECT_EQ(refusal(kAsf, "root lfemur\n", ""), "asf, line 31: 'lfemur' has children before it has a parent");
  EXPECT_EQ(refusal(kAsf, "lfemur ltibia\n", "lfemur foot\n"), "asf, line 32: 'foot' is no bone, or has two parents");
  EXPECT_EQ(refusal(kAsf, "length 0.0254", "length 0"),
            "asf, line 5: unit of length is 0.000000, must be positive, at least 0.0001");
  EXPECT_EQ(refusal(kAsf, "length 0.0254", "length 1e-300"),
            "asf, line 5: unit of length is 0.000000, must be positive, at least 0.0001");
  EXPECT_EQ(refusal(kAsf, "angle deg", "angle gon"), "asf, line 6: unit of angles is 'gon', must be deg or rad");
  EXPECT_EQ(refusal(std::string(kAsf) + ":units angle rad\n", "", ""),
            "asf, line 34: the units stand behind the bones that are measured in them, must stand before");
  EXPECT_EQ(refusal(kAsf, "id 2\n     name ltibia", "id 2\n     name l\x1b[2J"),
            "asf, line 32: 'ltibia' is no bone, or has two parents");
  EXPECT_EQ(refusal(kAsf, "lfemur ltibia\n", "lfemur l\x1b[2J\n"),
            "asf, line 32: 'l\\x1b[2J' is no bone, or has two parents");
  EXPECT_EQ(refusal(kAsf, "root 0.01", "root 2000"),
            "amc, line 9: the root is more than 1000.000000 m away; are the units of length right?");
  EXPECT_EQ(refusal("", "", ""), "asf, line 1: has no bones, or no hierarchy of them");
  EXPECT_EQ(refusal(kAsf, "ltibia 90", "ltibia x"), "amc, line 11: 'x' is no number below 1e9");
  EXPECT_EQ(refusal(kAsf, "ltibia 90", "foot 90"), "amc, line 11: 'foot' is no bone of the skeleton");
  EXPECT_EQ(refusal(kAsf, "\n2\n", "\n3\n"), "amc, line 8: expected frame 2 of at most 1000000");
  EXPECT_EQ(refusal(kAsf, "ltibia 90", "ltibia"), "amc, line 11: ends too early");
  const MocapSkeleton skeleton = parse_asf(kAsf, "asf");
  EXPECT_THROW(MocapClip(skeleton, {}, 120), Error);
  EXPECT_THROW(MocapClip(skeleton, {MocapFrame{}}, 120), Error);
  EXPECT_THROW((void)MocapClip::load("nowhere.asf", "nowhere.amc"), Error);
}

class CmuMocap : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* given = std::getenv("DEPTHGRID_DATA");
    folder_ = std::filesystem::path(given != nullptr ? given : "../shared/data") / "mocap_cmu";
    if (!std::filesystem::is_directory(folder_)) {
      GTEST_SKIP() << "no motion capture in '" << folder_.string()
                   << "': set DEPTHGRID_DATA to the folder with mocap_cmu (CMU's subject 02)";
    }
  }
  [[nodiscard]] MocapClip clip(const char* name) const { return MocapClip::load(folder_ / "02.asf", folder_ / name); }
  std::filesystem::path folder_;
};

TEST_F(CmuMocap, APersonOfNormalSizeStandsOnTheFloor) {
  for (const auto& [name, frames] : {std::pair("02_01.amc", 343), std::pair("02_05.amc", 1854),
                                     std::pair("02_06.amc", 2235), std::pair("02_10.amc", 2645)}) {
    const MocapClip motion = clip(name);
    EXPECT_EQ(motion.frames(), static_cast<std::size_t>(frames)) << name;
    double lowest_m = 10;
    double highest_m = 0;
    for (double t = 0; t < motion.duration_s(); t += 0.1) {
      const std::vector<Capsule> body = motion.at(t);
      ASSERT_EQ(body.size(), 30U);
      for (const Capsule& part : body) {
        validate(part);
        lowest_m = std::min({lowest_m, part.a.z(), part.b.z()});
        highest_m = std::max({highest_m, part.a.z(), part.b.z()});
      }
    }
    EXPECT_GT(lowest_m, -0.05) << name;
    EXPECT_LT(lowest_m, 0.06) << name;
    EXPECT_GT(highest_m, 1.5) << name;
    EXPECT_LT(highest_m, 2.2) << name;
    EXPECT_GT(motion.v_max_m_s(), 0.5) << name;
    EXPECT_LT(motion.v_max_m_s(), 8.0) << name;
    std::printf("[ figures  ] %s: %.1f s, bone ends at %.2f to %.2f m, at most %.2f m/s\n", name, motion.duration_s(),
                lowest_m, highest_m, motion.v_max_m_s());
  }
}

TEST_F(CmuMocap, TheWalkTravels) {
  const MocapClip walk = clip("02_01.amc");
  const Eigen::Vector3d way_m = walk.at(walk.duration_s())[0].a - walk.at(0)[0].a;
  EXPECT_NEAR(way_m.head<2>().norm(), 3.34, 0.1);
}

}  // namespace
}  // namespace depthgrid::simulation::testing
