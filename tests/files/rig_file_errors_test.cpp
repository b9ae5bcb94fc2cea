// Broken rig files: each is refused with one line that names the file, the place, the value and the rule.
#include <gtest/gtest.h>

#include "depthgrid/files/rig_file.hpp"
#include "files/rig_text.hpp"
#include "files/temporary_folder.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::small_rig;
using test::small_rig_with;

struct Broken {
  const char* name;
  std::string text;
  const char* message;
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

class BrokenRig : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenRig, IsRefusedWithItsReason) {
  EXPECT_EQ(message_of([] { parse_rig(GetParam().text, "rig.json"); }), GetParam().message);
}

#define FY_HINT                                                                                                      \
  "; y up or an image stored bottom-up? Write fy without its sign. Where y is up in camera and world (ICL-NUIM), "   \
  "change the signs of the second row and of the second column of T_world_cam and of y in all points; where images " \
  "are stored bottom-up, turn the rows round and write cy = height - 1 - cy"

const Broken kSyntax[] = {
    {"Empty", "", "rig.json: line 1, column 1: JSON syntax: The document is empty."},
    {"NoJson", "cameras: 3\n", "rig.json: line 1, column 1: JSON syntax: Invalid value. Near: cameras: 3"},
    {"Truncated", small_rig().substr(0, 130),
     "rig.json: line 5, column 13: JSON syntax: Invalid value. Near: \"frames\": "},
    {"TrailingComma", small_rig_with("\"note\": \"free text\"}", "\"note\": \"free text\",}"),
     "rig.json: line 14, column 59: JSON syntax: Missing a name for object member. Near: \"note\": \"free text\",}"},
    {"Comment", small_rig_with("\"name\"", "// a comment\n\"name\""),
     "rig.json: line 2, column 3: JSON syntax: Missing a name for object member. Near: // a comment"},
    {"NotANumber", small_rig_with("\"fx\": 10", "\"fx\": NaN"),
     "rig.json: line 7, column 51: JSON syntax: Invalid value. Near: \"height\": 6, \"fx\": NaN, \"fy\": 11, \"cx\":"},
    {"Infinity", small_rig_with("\"cx\": 3.5", "\"cx\": 1e999"),
     "rig.json: line 7, column 71: JSON syntax: Number too big to be stored in double. Near: 10, \"fy\": 11, \"cx\": "
     "1e999, \"cy\": 2.25,"},
    {"Nul", small_rig() + std::string(1, '\0'), "rig.json: line 17, column 1: JSON syntax: A NUL byte. Near: ?"},
    {"NotUtf8", small_rig_with("small", "sm\xFF"),
     "rig.json: line 2, column 14: JSON syntax: Invalid encoding in string. Near: \"name\": \"sm?\","},
    {"TwoDocuments", small_rig() + "{}",
     "rig.json: line 17, column 1: JSON syntax: The document root must not be followed by other values. Near: {}"},
    {"FirstHalfOfASurrogatePair", small_rig_with("small", "sm\\ud800"),
     "rig.json: line 2, column 14: JSON syntax: The surrogate pair in string is invalid. Near: \"name\": "
     "\"sm\\ud800\","},
    {"NestedDeeply", std::string(100000, '['),
     "rig.json: line 1, column 33: JSON syntax: Nested deeper than 32 levels. Near: "
     "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["},
};
INSTANTIATE_TEST_SUITE_P(Syntax, BrokenRig, ::testing::ValuesIn(kSyntax),
                         [](const auto& broken) { return broken.param.name; });

const Broken kSchema[] = {
    {"List", "[]", "rig.json: top level: value [] breaks the rule \"type\": \"object\""},
    {"NoCameras", "{\"name\": \"a\"}", "rig.json: top level: key \"cameras\" is missing (rule \"required\")"},
    {"EmptyCameras", "{\"cameras\": []}", "rig.json: /cameras: value [] breaks the rule \"minItems\": 1"},
    {"MisspeltKey", small_rig_with("\"height\"", "\"heigth\""),
     "rig.json: /cameras/0: unknown key \"heigth\", did you mean 'height'?"},
    {"UnknownKey", small_rig_with("\"first\": 3", "\"exposure\": 3"),
     "rig.json: /frames: unknown key \"exposure\", known keys are first, count, simultaneous, tolerance_s, pose_gap_s, "
     "shared_clock, pattern, rate_hz, note"},
    {"HalfOfASurrogatePairInAKey", small_rig_with("\"first\": 3", "\"first\\udc00\": 3"),
     "rig.json: /frames: unknown key \"first\\xed\\xb0\\x80\", known keys are first, count, simultaneous, tolerance_s, "
     "pose_gap_s, shared_clock, pattern, rate_hz, note"},
    {"UnknownKeyAtTheTop", small_rig_with("\"name\"", "\"T_world_floor\""),
     "rig.json: top level: unknown key \"T_world_floor\", known keys are name, note, convention, world_frame, "
     "suggested_rigs, T_floor_world, depth, frames, cameras"},
    {"KeyTwice", small_rig_with("\"fx\": 10", "\"fx\": 10, \"fx\": 12"),
     "rig.json: /cameras/0: key \"fx\" occurs twice"},
    {"NoFocalLength", small_rig_with("\"fx\": 10, ", ""),
     "rig.json: /cameras/0: key \"fx\" is missing (rule \"required\")"},
    {"NegativeWidth", small_rig_with("\"width\": 8", "\"width\": -3"),
     "rig.json: /cameras/0/width: value -3 breaks the rule \"minimum\": 1"},
    {"HugeHeight", small_rig_with("\"height\": 6", "\"height\": 100000"),
     "rig.json: /cameras/0/height: value 100000 breaks the rule \"maximum\": 16384"},
    {"FractionalWidth", small_rig_with("\"width\": 8", "\"width\": 8.5"),
     "rig.json: /cameras/0/width: value 8.5 breaks the rule \"type\": \"integer\""},
    {"WidthBeyondIntegers", small_rig_with("\"width\": 8", "\"width\": 99999999999999999999"),
     "rig.json: /cameras/0/width: value 100000000000000000000.0 breaks the rule \"type\": \"integer\""},
    {"WidthAsText", small_rig_with("\"width\": 8", "\"width\": \"8\""),
     "rig.json: /cameras/0/width: value \"8\" breaks the rule \"type\": \"integer\""},
    {"ZeroFocalLength", small_rig_with("\"fx\": 10", "\"fx\": 0"),
     "rig.json: /cameras/0/fx: value 0 breaks the rule \"minimum\": 0 (exclusive)" FY_HINT},
    {"ZeroScale", small_rig_with("\"metres_per_unit\": 0.001", "\"metres_per_unit\": 0"),
     "rig.json: /depth/metres_per_unit: value 0 breaks the rule \"minimum\": 0.000001; metres of one unit: did you "
     "mean "
     "0.001 (images in millimetres)?"},
    {"InvalidValueTooLarge", small_rig_with("2047", "65536"),
     "rig.json: /depth/invalid_values/1: value 65536 breaks the rule \"maximum\": 65535"},
    {"UnknownDistortion", small_rig_with("plumb_bob", "cubemap"),
     "rig.json: /cameras/1/distortion/model: value \"cubemap\" breaks the rule \"enum\": "
     "[\"none\",\"brown_conrady\",\"plumb_bob\",\"radtan\",\"rational\",\"rat...; known are none, plumb_bob "
     "(brown_conrady, "
     "radtan), rational (rational_polynomial) and equidistant (fisheye, kannala_brandt4); RealSense's "
     "inverse_brown_conrady "
     "with five zeros is none; of other models rectify the images first"},
    {"ThreeRows", small_rig_with("[1, 0, 0, 0.5], ", ""),
     "rig.json: /cameras/0/T_world_cam: value [[0,1,0,0],[0,0,1,0],[0,0,0,1]] breaks the rule \"minItems\": 4"},
    {"ShortRow", small_rig_with("[1, 0, 0, 0.5]", "[1, 0, 0]"),
     "rig.json: /cameras/0/T_world_cam/0: value [1,0,0] breaks the rule \"minItems\": 4"},
    {"NullInPose", small_rig_with("0.5]", "null]"),
     "rig.json: /cameras/0/T_world_cam/0/3: value null breaks the rule \"type\": \"number\""},
    {"EmptyId", small_rig_with("\"left\"", "\"\""),
     "rig.json: /cameras/0/id: value \"\" breaks the rule \"minLength\": 1"},
    {"NoFrames", small_rig_with("\"count\": 10", "\"count\": 0"),
     "rig.json: /frames/count: value 0 breaks the rule \"minimum\": 1"},
    {"UnknownMargin", small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"translaton_m\": 0.1},"),
     "rig.json: /cameras/0/margins: unknown key \"translaton_m\", did you mean 'translation_m'?"},
    {"NegativeMargin", small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"noise_linear\": -0.1},"),
     "rig.json: /cameras/0/margins/noise_linear: value -0.1 breaks the rule \"minimum\": 0"},
    {"WideFilterRadius", small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"lateral_px\": 17},"),
     "rig.json: /cameras/0/margins/lateral_px: value 17 breaks the rule \"maximum\": 16"},
    {"FractionalFilterRadius",
     small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"lateral_px\": 1.5},"),
     "rig.json: /cameras/0/margins/lateral_px: value 1.5 breaks the rule \"type\": \"integer\""},
    {"MarginAsText",
     small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"rotation_rad\": \"1 degree\"},"),
     "rig.json: /cameras/0/margins/rotation_rad: value \"1 degree\" breaks the rule \"type\": \"number\""},
    {"SensorAsNumber", small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"sensor\": 1,"),
     "rig.json: /cameras/0/sensor: value 1 breaks the rule \"type\": \"string\""},
    {"NegativeRate", small_rig_with("\"rate_hz\": 4", "\"rate_hz\": -4"),
     "rig.json: /frames/rate_hz: value -4 breaks the rule \"minimum\": 0 (exclusive)"},
};
INSTANTIATE_TEST_SUITE_P(Schema, BrokenRig, ::testing::ValuesIn(kSchema),
                         [](const auto& broken) { return broken.param.name; });

const Broken kMeaning[] = {
    {"IdTwice", small_rig_with("\"right\"", "\"left\""),
     "rig.json: /cameras/1/id: 'left' is also the id of /cameras/0, ids must be distinct"},
    {"IdOfTwoLines", small_rig_with("\"right\"", "\"ri\\nght\""),
     "rig.json: /cameras/1/id: \"ri\\nght\" holds a control character, names must not"},
    {"HalfOfASurrogatePairInAnId", small_rig_with("\"right\"", "\"ri\\udc00ght\""),
     "rig.json: /cameras/1/id: \"ri\\xed\\xb0\\x80ght\" holds a control character, names must not"},
    {"HalfOfASurrogatePairInAPath", small_rig_with("left/depth", "left\\udfffdepth"),
     "rig.json: /cameras/0/depth_files: \"left\\xed\\xbf\\xbfdepth_%03d.png\" holds a control character, names must "
     "not"},
    {"NoScale", small_rig_with("\"metres_per_unit\": 0.001, ", ""),
     "rig.json: /cameras/0: metres_per_unit is given neither here nor in /depth, depth values need a scale"},
    {"SkewRotation", small_rig_with("[1, 0, 0, 0.5]", "[1, 0.01, 0, 0.5]"),
     "rig.json: /cameras/0/T_world_cam: matrix: rotation deviates from orthonormal by 0.01, must be at most 0.001; "
     "with too few digits, or not a rotation?"},
    {"Reflection", small_rig_with("[1, 0, 0, 0.5]", "[-1, 0, 0, 0.5]"),
     "rig.json: /cameras/0/T_world_cam: matrix: rotation has determinant -1, must be +1 (right-handed frames): one "
     "axis is turned round; where y is up in camera and world (ICL-NUIM), change the signs of the second row and of "
     "the "
     "second column, and of y in all points"},
    {"Transposed",
     small_rig_with("[[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]",
                    "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0.5, 0, 0, 1]]"),
     "rig.json: /cameras/0/T_world_cam: matrix: last row is (0.5   0   0   1), must be (0 0 0 1); is the matrix "
     "transposed?"},
    {"NearBeyondFar", small_rig_with("\"near_m\": 0.25", "\"near_m\": 5"),
     "rig.json: /cameras/1: depth range: far is 4 m, must be greater than near (5 m)"},
    {"UnknownSensor", small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"sensor\": \"kinect\","),
     "rig.json: /cameras/0/sensor: there is no sensor model 'kinect', known are ideal, kinect_v1, realsense_d415, "
     "realsense_d435, realsense_d455, azure_kinect_nfov, azure_kinect_nfov_binned, azure_kinect_wfov, "
     "azure_kinect_wfov_binned"},
    {"MarginsWithoutNoise",
     small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"translation_m\": 0.1},"),
     "rig.json: /cameras/0/margins: says nothing about the depth's noise, and there is no sensor; give "
     "noise_constant_m, noise_linear or noise_quadratic_per_m, or name a \"sensor\" (\"ideal\" has no noise)"},
    {"FarBeforeTheSensorsNear",
     small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"sensor\": \"kinect_v1\", \"far_m\": 0.4,"),
     "rig.json: /cameras/0: depth range: far is 0.4 m, must be greater than near (0.5 m)"},
    {"ThreeCoefficients", small_rig_with("[0, 0, 0, 0, 0]", "[0.1, 0, 0]"),
     "rig.json: /cameras/1/distortion: distortion plumb_bob: 3 coefficients given, must be 4 or 5 (k1 k2 p1 p2 k3)"},
    {"CoefficientsWithoutModel", small_rig_with("\"plumb_bob\", \"coeffs\": [0,", "\"none\", \"coeffs\": [0.1,"),
     "rig.json: /cameras/1/distortion: distortion none: coefficient 0 is 0.1, must be 0; is the model plumb_bob, "
     "rational or equidistant?"},
    {"NoConversion", small_rig_with("depth_%03d", "depth"),
     "rig.json: /cameras/0/depth_files: 'left/depth.png' has no %d or %0Nd, but /frames/count is 10"},
    {"TextConversion", small_rig_with("depth_%03d", "depth_%s"),
     "rig.json: /cameras/0/depth_files: 'left/depth_%s.png' has a '%' that does not start %d, %0Nd or %f"},
    {"WideConversion", small_rig_with("depth_%03d", "depth_%0999d"),
     "rig.json: /cameras/0/depth_files: 'left/depth_%0999d.png' has a '%' that does not start %d, %0Nd or %f"},
    {"TwoConversions", small_rig_with("left/depth_%03d", "%03d/depth_%03d"),
     "rig.json: /cameras/0/depth_files: '%03d/depth_%03d.png' has two conversions, only one frame number can be put "
     "in"},
    {"OtherConversion", small_rig_with("depth_%03d", "depth_%04d"),
     "rig.json: /cameras/0/depth_files: 'left/depth_%04d.png' has %04d, but /frames/pattern is '%03d'"},
    {"AbsolutePath", small_rig_with("left/depth", "/left/depth"),
     "rig.json: /cameras/0/depth_files: '/left/depth_%03d.png' is an absolute path, must be relative to the rig file's "
     "folder"},
    {"PathOutOfTheFolder", small_rig_with("left/depth", "left/../../depth"),
     "rig.json: /cameras/0/depth_files: 'left/../../depth_%03d.png' has a part '..', must stay in the rig file's "
     "folder"},
    {"NulInPath", small_rig_with("left/depth", "left\\u0000depth"),
     "rig.json: /cameras/0/depth_files: \"left\\x00depth_%03d.png\" holds a control character, names must not"},
    {"PatternWithText", small_rig_with("\"pattern\": \"%03d\"", "\"pattern\": \"depth_%03d\""),
     "rig.json: /frames/pattern: 'depth_%03d' is not a conversion %d or %0Nd and nothing else"},
};
INSTANTIATE_TEST_SUITE_P(Meaning, BrokenRig, ::testing::ValuesIn(kMeaning),
                         [](const auto& broken) { return broken.param.name; });

/// Units that were mistaken: each is refused, and the message says what was probably meant.
const Broken kImplausible[] = {
    {"UnitsOfOneMetre", small_rig_with("\"metres_per_unit\": 0.001", "\"metres_per_unit\": 1000"),
     "rig.json: /depth/metres_per_unit: value 1000 breaks the rule \"maximum\": 0.01; metres of one unit: did you mean "
     "0.001 (images in millimetres)? Most tools name the inverse, units of one metre (depth_scale 1000, DepthMapFactor "
     "5000): write 1/1000 = 0.001, 1/5000 = 0.0002"},
    {"UnitsOfACamera", small_rig_with("\"metres_per_unit\": 0.0005", "\"metres_per_unit\": 1"),
     "rig.json: /cameras/1/metres_per_unit: value 1 breaks the rule \"maximum\": 0.01; metres of one unit: did you "
     "mean "
     "0.001 (images in millimetres)? Most tools name the inverse, units of one metre (depth_scale 1000, DepthMapFactor "
     "5000): write 1/1000 = 0.001, 1/5000 = 0.0002"},
    {"NegativeFy", small_rig_with("\"fy\": 11", "\"fy\": -480"),
     "rig.json: /cameras/0/fy: value -480 breaks the rule \"minimum\": 0 (exclusive)" FY_HINT},
    {"FxDividedByTheWidth", small_rig_with("\"fx\": 10", "\"fx\": 0.15"),
     "rig.json: /cameras/0: intrinsics: fx is 0.15 px in an image of width 8 px, a field of view of 175.7048291 "
     "degrees, "
     "must be 2 to 175; is it in millimetres or metres? needed are pixels, usually 0.4 to 2 times the width"},
    {"PrincipalPointOfAnotherImage", small_rig_with("\"cx\": 3.5", "\"cx\": 35"),
     "rig.json: /cameras/0: intrinsics: cx is 35 px in an image of width 8 px, must be within one width of the image; "
     "is "
     "the calibration for another image size? (half the width would be 3.5)"},
    {"PoseInMillimetres", small_rig_with("[1, 0, 0, 0.5]", "[1, 0, 0, 500]"),
     "rig.json: /cameras/0/T_world_cam: matrix: translation is (500, 0, 0) m, no coordinate may be beyond 100 m; in "
     "millimetres? did you mean (0.5, 0, 0)? if not, move the world's origin near the cameras"},
    {"BaselineInMillimetres", small_rig_with("[1, 0, 0, 0.5]", "[1, 0, 0, 60]"),
     "rig.json: /cameras: camera 0 stands 62.03224968 m from the nearest other one (1), must be at most 50 m; are the "
     "poses in millimetres? did you mean 0.06203224968 m?"},
    {"NearInMillimetres", small_rig_with("\"near_m\": 0.25", "\"near_m\": 250"),
     "rig.json: /cameras/1/near_m: value 250 breaks the rule \"maximum\": 10; in millimetres? lengths are metres"},
    {"FarInMillimetres", small_rig_with("\"far_m\": 4", "\"far_m\": 4000"),
     "rig.json: /cameras/1/far_m: value 4000 breaks the rule \"maximum\": 500; in millimetres? lengths are metres; "
     "null: "
     "no limit"},
    {"MarginInMillimetres",
     small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"translation_m\": 5},"),
     "rig.json: /cameras/0/margins/translation_m: value 5 breaks the rule \"maximum\": 1; in millimetres? lengths are "
     "metres"},
    {"MarginInDegrees", small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"rotation_rad\": 1},"),
     "rig.json: /cameras/0/margins/rotation_rad: value 1 breaks the rule \"maximum\": 0.5; in degrees? angles are "
     "radians, 1 degree is 0.01745"},
    {"ExposureInMilliseconds",
     small_rig_with("\"id\": \"left\",", "\"id\": \"left\", \"margins\": {\"half_exposure_s\": 16},"),
     "rig.json: /cameras/0/margins/half_exposure_s: value 16 breaks the rule \"maximum\": 1; in milliseconds? times "
     "are "
     "seconds"},
    {"AbsurdDistortion", small_rig_with("[0, 0, 0, 0, 0]", "[0, 0, 3, 0, 0]"),
     "rig.json: /cameras/1: intrinsics: distortion: p1, p2 is 3, 0, must be at most 0.5 to either side; the order is "
     "k1 "
     "k2 p1 p2 k3 ..., are they k3 and k4?"},
    {"ScaledRotation",
     small_rig_with("[[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0]", "[[2, 0, 0, 0.5], [0, 2, 0, 0], [0, 0, 2, 0]"),
     "rig.json: /cameras/0/T_world_cam: matrix: rotation deviates from orthonormal by 3, must be at most 0.001; it is "
     "scaled by 2: divide its nine numbers by that"},
    {"Utf16", std::string("\xFF\xFE{\0}\0", 6),
     "rig.json: is UTF-16 or UTF-32 text, must be UTF-8 or ASCII; save it as UTF-8 (PowerShell: Out-File -Encoding "
     "utf8)"},
};
INSTANTIATE_TEST_SUITE_P(Implausible, BrokenRig, ::testing::ValuesIn(kImplausible),
                         [](const auto& broken) { return broken.param.name; });

TEST(BrokenRigFile, AbsentFileIsNamed) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(message_of([&] { load_rig(folder / "rig.json"); }, folder.path()),
            "rig.json: cannot be read: No such file or directory");
}

TEST(BrokenRigFile, FolderIsNoRigFile) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(message_of([&] { load_rig(folder.path() / "."); }, folder.path()), ".: cannot be read: Is a directory");
}

}  // namespace
}  // namespace depthgrid::files
