// What the command says when something is broken: one line, the right exit code, and nothing left behind.
#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <vector>

#include "program/command.hpp"

namespace depthgrid::test {
namespace {

struct Case {
  std::string name;
  std::function<void(const TemporaryFolder&)> damage;  ///< done to a good recording
  std::string arguments;
  int exit_code;
  std::string message;  ///< the whole of standard error without "depthgrid: " and the end of line
};

void PrintTo(const Case& broken, std::ostream* out) { *out << broken.name; }

class Broken : public ::testing::TestWithParam<Case> {};

TEST_P(Broken, IsRefusedWithOneLine) {
  const Case& broken = GetParam();
  const TemporaryFolder folder;
  write_wall(folder);
  if (broken.damage) {
    broken.damage(folder);
  }
  const auto before = folder.entries();
  const auto result = run_command(broken.arguments, folder);
  EXPECT_EQ(result.exit_code, broken.exit_code);
  EXPECT_EQ(result.err, "depthgrid: " + broken.message + "\n") << "standard output:\n" << result.out;
  EXPECT_EQ(folder.entries(), before) << "something was left behind";
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) { return info.param.name; }

const std::string kGood = "distances . --output answers.csv ";
const std::string kPoint = "--point 0.2,0,1.7 ";
const std::string kExact = kGood + kPoint + "--sensor ideal ";
const std::string kSearch = "--method search --sensor ideal --unobserved obstacle --outside ignored ";

INSTANTIATE_TEST_SUITE_P(
    CommandLine, Broken,
    ::testing::Values(
        Case{"NoCommand", {}, "", 2, "A subcommand is required (depthgrid --help explains)"},
        Case{"UnknownCommand", {}, "distance .", 2, "there is no command 'distance' (depthgrid --help lists them)"},
        Case{"UnknownOption",
             {},
             kGood + kPoint + "--rhoo 1",
             2,
             "The following arguments were not expected: 1 --rhoo (depthgrid --help explains)"},
        Case{"NoRecording", {}, "distances " + kPoint, 2, "RECORDING is required (depthgrid --help explains)"},
        Case{"OptionWithoutValue",
             {},
             kGood + "--point",
             2,
             "--point: 1 required TEXT missing (depthgrid --help explains)"},
        Case{"ValueNoNumber",
             {},
             kGood + kPoint + "--rho wide",
             2,
             "Could not convert: --rho = wide (depthgrid --help explains)"},
        Case{"ValueOutOfRange",
             {},
             kGood + kPoint + "--rho -1",
             2,
             "evaluation settings: rho is -1 m, must be a positive finite number"},
        Case{"UnknownVariant",
             {},
             kGood + kPoint + "--method exact",
             2,
             "--method: exact not in {letter,corrected,search} (depthgrid --help explains)"},
        Case{"UnknownSensor",
             {},
             kGood + kPoint + "--sensor kinect",
             2,
             "--sensor: there is no sensor model 'kinect', known are ideal, kinect_v1, realsense_d415, realsense_d435, "
             "realsense_d455, azure_kinect_nfov, azure_kinect_nfov_binned, azure_kinect_wfov, azure_kinect_wfov_binned "
             "(depthgrid --help explains)"},
        Case{"MarginOfTheLetter",
             {},
             kGood + kPoint + "--variant letter --margin-constant 0.01",
             2,
             "--margin-... has no effect with --method letter, which knows no margins; use --method corrected"},
        Case{"MapOfCorrected",
             {},
             kGood + kPoint + "--map wall.map",
             2,
             "--map has no effect with --method corrected, which looks at whole cells; use --method letter"},
        Case{"NoMarginsOfTheSearch",
             {},
             kGood + kPoint + "--method search",
             2,
             "camera 'left' has no margins in the rig file; give --sensor NAME (ideal: no noise) or --margin-constant, "
             "--margin-linear, --margin-quadratic"},
        Case{"NoExposureThoughObstaclesMove",
             {},
             kGood + kPoint + "--method search --margin-constant 0.004 --margin-quadratic 0.006 --v-max 2",
             2,
             "camera 'left': obstacles move (--v-max 2) and nothing says for how long an image is exposed; give "
             "--half-exposure S or --sensor NAME"},
        Case{"NothingDeclared",
             {},
             kGood + kPoint + "--method search --sensor ideal",
             2,
             "--method search needs --unobserved obstacle|ignored, --outside obstacle|ignored, --robot-pockets "
             "obstacle|ignored, --v-max M/S, the space of interest (--box x0,y0,z0,x1,y1,z1 or --d-min and --d-max): "
             "nothing that decides what counts as an obstacle has a default (docs/search.md)"},
        Case{"RobotPocketsUndeclared",
             {},
             kGood + kPoint + kSearch + "--v-max 2 --box 0,0,0,1,1,1",
             2,
             "--method search needs --robot-pockets obstacle|ignored: nothing that decides what counts as an obstacle "
             "has a default (docs/search.md)"},
        Case{"BoxOfFive",
             {},
             kGood + kPoint + kSearch + "--robot-pockets obstacle --v-max 2 --box 0,0,0,1,1",
             2,
             "--box 0,0,0,1,1: must be six numbers x0,y0,z0,x1,y1,z1, metres: the low and the high corner"},
        Case{"BoxOfSeven",
             {},
             kGood + kPoint + kSearch + "--robot-pockets obstacle --v-max 2 --box 0,0,0,1,1,1,1",
             2,
             "--box 0,0,0,1,1,1,1: must be six numbers x0,y0,z0,x1,y1,z1, metres: the low and the high corner"},
        Case{"BoxInsideOut",
             {},
             kGood + kPoint + kSearch + "--robot-pockets obstacle --v-max 2 --box 0,0,0,1,-1,1",
             2,
             "search settings: box reaches from 0 to -1 m in y, the low corner must lie below the high one"},
        Case{"BoxAndFrustum",
             {},
             kGood + kPoint + kSearch + "--robot-pockets obstacle --v-max 2 --box 0,0,0,1,1,1 --d-max 3",
             2,
             "--box and --d-min, --d-max exclude each other: the space of interest is a box or a camera's view"},
        Case{"NegativeSpeed",
             {},
             kGood + kPoint + kSearch + "--robot-pockets obstacle --v-max -2 --box 0,0,0,1,1,1",
             2,
             "search settings: v_max is -2 m/s, must be a finite number that is not negative"},
        Case{"NoBudget",
             {},
             kGood + kPoint + kSearch + "--robot-pockets obstacle --v-max 2 --box 0,0,0,1,1,1 --budget-nodes 0",
             2,
             "--budget-nodes 0 must be at least 1"},
        Case{"GridOptionOfTheSearch",
             {},
             kGood + kPoint + kSearch + "--step 0.02",
             2,
             "--step has no effect with --method search, which has no depth grid"},
        Case{"MapOfTheSearch",
             {},
             kGood + kPoint + kSearch + "--map wall.map",
             2,
             "--map has no effect with --method search, which has no depth grid; use --method letter"},
        Case{"SearchOptionOfTheGrid",
             {},
             kGood + kPoint + "--v-max 2",
             2,
             "--v-max has no effect with --method corrected; use --method search"},
        Case{"ExposureOfTheGrid",
             {},
             kGood + kPoint + "--half-exposure 0.01",
             2,
             "--half-exposure and --time-uncertainty have no effect with --method corrected, which knows no speed of "
             "obstacles; use --margin-time, or --method search with --v-max"},
        Case{"RadiusOfTheGrid",
             {},
             kGood + "--point ball=0.2,0,1.7,0.1",
             2,
             "control point 'ball' has a radius, which only --method search knows"},
        Case{"ClampWithoutFar",
             {},
             kGood + kPoint + "--beyond-far clamp",
             2,
             "--beyond-far clamp needs a farthest measurable depth: give --far"},
        Case{"StepTooSmallForTheFarEnd",
             {},
             kGood + kPoint + "--step 1e-5 --far 2",
             2,
             "depth cells: 65535 cells of 1e-05 m (growth 0) reach to 0.94355 m, must reach the far end 2 m; give a "
             "larger --step or --growth, or --count"},
        Case{"StepTooSmallForTheDeepestReading",
             {},
             kGood + kPoint + "--step 1e-5",
             2,
             "depth cells: 65535 cells of 1e-05 m (growth 0) reach to 0.94355 m, must reach the far end 2 m; give a "
             "larger --step or --growth, or --count"},
        Case{"NegativeMargin",
             {},
             kGood + kPoint + "--margin-constant -0.01",
             2,
             "sensor margin: constant is -0.01 m, must be a finite number that is not negative"},
        Case{"FramesBackwards",
             {},
             kGood + kPoint + "--frames 6:5",
             2,
             "--frames 6:5: '6:5' needs first <= last and step >= 1"},
        Case{"FramesMissing", {}, kGood + kPoint + "--frames 5:7", 2, "--frames 5:7: the recording has frames 5 to 6"},
        Case{"FramesNoNumber",
             {},
             kGood + kPoint + "--frames five",
             2,
             "--frames five: 'five' is not a frame number; write 5, 0:80, 0:80:8 or 1,4,9"},
        Case{"StrideZero", {}, "info . --stride 0", 2, "--stride 0 must be at least 1"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    ControlPoints, Broken,
    ::testing::Values(
        Case{"None", {}, kGood, 2, "no control point: give --point x,y,z (metres, repeatable) or --points FILE.csv"},
        Case{
            "TwoCoordinates",
            {},
            kGood + "--point 1,2",
            2,
            "--point 1,2: control point '1,2': column 1: 2 values, must be 3 (x,y,z in metres), 4 (with a radius) or 7 "
            "(x,y,z,radius,x2,y2,z2)"},
        Case{"NotANumber",
             {},
             kGood + "--point hand=1,2,x",
             2,
             "--point hand=1,2,x: control point '1,2,x': column 5: z is 'x', must be a number in metres"},
        Case{"Nan",
             {},
             kGood + "--point nan,0,1",
             2,
             "--point nan,0,1: control point 'nan,0,1': column 1: x is 'nan', must be finite"},
        Case{"EmptyName", {}, kGood + "--point =0,0,1", 2, "--point =0,0,1: the name before '=' is empty"},
        Case{"SameName",
             {},
             kGood + "--point a=0,0,1 --point a=0,0,2",
             2,
             "--point: two control points are called 'a'; names must differ"},
        Case{"FileAbsent", {}, kGood + "--points none.csv", 1, "none.csv: cannot be read: No such file or directory"},
        Case{"FileWithNan", [](const TemporaryFolder& f) { (void)f.write("p.csv", "id,x,y,z\nhand,0,nan,1\n"); },
             kGood + "--points p.csv", 1, "p.csv: line 2, column 8: y is 'nan', must be finite"},
        Case{"FileWithoutPoints", [](const TemporaryFolder& f) { (void)f.write("p.csv", "id,x,y,z\n"); },
             kGood + "--points p.csv", 1, "p.csv: holds no control point, needs at least one row id,x,y,z"},
        Case{"FileWithTooFewValues", [](const TemporaryFolder& f) { (void)f.write("p.csv", "hand,0,1\n"); },
             kGood + "--points p.csv", 1,
             "p.csv: line 1, column 1: 3 values, must be 4 (id,x,y,z) or 5 (frame,id,x,y,z); radius and x2,y2,z2 need "
             "a header row"},
        Case{"NoFloorFrame",
             [](const TemporaryFolder& f) {
               auto file = wall_rig();
               file.rig.T_floor_world.reset();
               files::save_rig(file, f / "rig.json");
             },
             kGood + kPoint + "--in floor", 2,
             "--in floor: the rig file has no T_floor_world, so there is no floor frame; use --in world"}),
    name_of);

void remove_first_pose(const TemporaryFolder& folder) {
  std::string text = read_bytes(folder / "rig.json");
  const auto key = text.find("\"T_world_cam\"");
  ASSERT_NE(key, std::string::npos);
  int depth = 0;
  auto end = text.find('[', key);
  do {
    depth += text[end] == '[' ? 1 : text[end] == ']' ? -1 : 0;
    ++end;
  } while (depth > 0);
  // The comma that separated the pose goes with it.
  const auto before = text.find_last_not_of(" \n", key - 1);
  const auto begin = text[before] == ',' ? before : key;
  if (begin == key) {
    end = text.find(',', end) + 1;
  }
  (void)folder.write("rig.json", text.erase(begin, end - begin));
}

/// A camera that measures nothing in any frame.
void write_blind(const TemporaryFolder& folder, const std::string& camera) {
  for (int frame = 5; frame < 7; ++frame) {
    files::write_png_gray16(folder / files::depth_file_name(camera + "_%03d.png", frame), 64, 48,
                            std::vector<std::uint16_t>(std::size_t{64} * 48));
  }
}

void truncate(const TemporaryFolder& folder, const std::string& name) {
  const std::string bytes = read_bytes(folder / name);
  (void)folder.write(name, bytes.substr(0, bytes.size() / 2));
}

INSTANTIATE_TEST_SUITE_P(
    Recording, Broken,
    ::testing::Values(
        Case{"Absent",
             {},
             "distances nowhere --output answers.csv " + kPoint,
             1,
             "nowhere: cannot be read: No such file or directory"},
        Case{"TruncatedImage", [](const TemporaryFolder& f) { truncate(f, "right_006.png"); }, kExact, 1,
             "./right_006.png: broken PNG: the file ends too early (truncated)"},
        Case{"TruncatedImageInfo", [](const TemporaryFolder& f) { truncate(f, "left_005.png"); },
             "info . --output info.txt", 1, "./left_005.png: broken PNG: the file ends too early (truncated)"},
        Case{"MissingFrame", [](const TemporaryFolder& f) { std::filesystem::remove(f / "right_006.png"); }, kExact, 1,
             "./right_006.png: cannot be read: No such file or directory"},
        Case{"WrongImageSize",
             [](const TemporaryFolder& f) {
               files::write_png_gray16(f / "left_005.png", 32, 48, std::vector<std::uint16_t>(std::size_t{32} * 48));
             },
             kExact, 1, "./left_005.png: is 32 x 48 pixels, the calibration of camera 'left' is for 64 x 48"},
        Case{"RigWithoutPose", remove_first_pose, kGood + kPoint, 1,
             "./rig.json: /cameras/0: key \"T_world_cam\" is missing; a camera that moves has \"trajectory\" or "
             "\"pose_files\" in "
             "its place"},
        Case{"RigWithUnknownKey", [](const TemporaryFolder& f) { edit(f, "rig.json", "\"name\"", "\"nane\""); },
             kGood + kPoint, 1, "./rig.json: top level: unknown key \"nane\", did you mean 'name'?"},
        Case{"UnknownCamera",
             {},
             kGood + kPoint + "--cameras left,middle",
             2,
             "./rig.json: rig 'wall': there is no camera 'middle', its cameras are left, right"},
        Case{"UnknownPrincipal",
             {},
             kGood + kPoint + "--principal middle",
             2,
             "rig 'wall': there is no camera 'middle', its cameras are left, right"},
        Case{"NearBehindFar",
             {},
             kGood + kPoint + "--near 3 --far 2",
             2,
             "./rig.json: camera 'left': far is 2 m, must be greater than near (3 m)"},
        Case{"NotSimultaneous",
             [](const TemporaryFolder& f) {
               auto file = wall_rig();
               file.simultaneous = false;
               files::save_rig(file, f / "rig.json");
             },
             kGood + kPoint, 2,
             "the rig file says \"simultaneous\": false, so images of one number are of different times; give "
             "--static-scene if nothing moves, or --margin-time with how far an obstacle moves between them"},
        Case{
            "PrincipalMeasuresNothing", [](const TemporaryFolder& f) { write_blind(f, "left"); }, kGood + kPoint, 1,
            "camera 'left' spans the depth grid and measures nothing in the chosen frames, so the grid has no far end; "
            "give --far or --count, or another --principal"},
        Case{"UnreadableMap", [](const TemporaryFolder& f) { (void)f.write("wall.map", "no map"); },
             kGood + kPoint + "--variant letter --map wall.map", 1,
             "map file 'wall.map': has 6 bytes, a map file has at least 64; is it cut off?"},
        Case{"MapAbsent",
             {},
             kGood + kPoint + "--variant letter --map wall.map",
             1,
             "file 'wall.map': cannot open: No such file or directory"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Output, Broken,
    ::testing::Values(Case{"FolderAbsent",
                           {},
                           "distances . " + kPoint + "--output none/answers.csv",
                           1,
                           "cannot write none/answers.csv: there is no folder none; create it first"},
                      Case{"IsAFolder", [](const TemporaryFolder& f) { std::filesystem::create_directory(f / "a"); },
                           "distances . " + kPoint + "--output a", 1, "cannot write a: it is a folder; name a file"},
                      Case{"PicturesFolderAbsent",
                           {},
                           kGood + kPoint + "--pictures none/pictures",
                           1,
                           "cannot create the folder none/pictures: there is no folder none; create it first"},
                      Case{"PicturesInTheWay",
                           {},
                           kGood + kPoint + "--pictures rig.json",
                           1,
                           "cannot create the folder rig.json: a file of that name is in the way"}),
    name_of);

TEST(OutputFile, StaysAsItWasWhenTheCommandFails) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("answers.csv", "old");
  std::filesystem::remove(folder / "right_006.png");
  const auto before = folder.entries();
  EXPECT_EQ(run_command(kGood + kPoint, folder).exit_code, 1);
  EXPECT_EQ(read_bytes(folder / "answers.csv"), "old");
  EXPECT_EQ(folder.entries(), before);
}

TEST(BlindPrincipal, IsFineWhereTheUserSaysHowFarTheGridReaches) {
  const TemporaryFolder folder;
  write_wall(folder);
  write_blind(folder, "left");
  for (const std::string enough : {"--count 200", "--far 3", "--principal right"}) {
    const auto result = run_command("distances . " + kPoint + enough, folder);
    EXPECT_EQ(result.exit_code, 0) << enough << ": " << result.err;
  }
}

TEST(StandardOutput, AFullOneIsAnError) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto result = run_command("distances . " + kPoint + "> /dev/full; test $? = 1", folder);
  EXPECT_EQ(result.exit_code, 0);
}

}  // namespace
}  // namespace depthgrid::test
