// Every broken command line ends with 2 and one line, and every broken file with 1.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>
#include <vector>

#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Runs the line in a folder with the wall, a map and a file of points; checks all that holds for every wrong line.
void expect_refused(const std::string& line, int exit_code) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("points.csv", "frame,id,x,y,z\n5,hand,0.2,0,1.7\n6,hand,0.2,0,1.7\n");
  (void)folder.write("spheres.csv", "id,x,y,z,radius\nball,0.2,0,1.7,0.1\n");
  (void)folder.write("broken.csv", "hand,1,2\n");
  (void)folder.write("broken.json", "{");
  (void)folder.write("arm.urdf", R"(<robot name="arm"><link name="foot"/></robot>)");
  const auto before = folder.entries();
  const auto result = run_command(line, folder);
  EXPECT_EQ(result.exit_code, exit_code) << "depthgrid " << line << "\n" << result.err;
  EXPECT_THAT(result.err, StartsWith("depthgrid: ")) << line;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << line << "\n" << result.err;
  EXPECT_EQ(folder.entries(), before) << line << ": something was left behind";
}

const std::vector<std::string> kTopLines{
    "",
    "nonsense",
    "nonsense --help",
    "--help nonsense",
    "nonsense --version",
    "--version nonsense",
    "--nonsense",
    "--nonsense --help",
    "Distances . --point 0,0,1",
    "distance . --help",
    "''",
    "-x",
};
const std::string kDistances = "distances . --output out.csv ";
const std::string kPoint = "--point 0.2,0,1.7 ";
const std::string kSearch =
    kDistances + kPoint +
    "--method search --sensor ideal --unobserved obstacle --outside ignored --robot-pockets obstacle ";
const std::string kBoxed = kSearch + "--v-max 0 --box=-1,-1,0.5,1,1,2 ";
const std::vector<std::string> kDistancesLines{
    "distances",
    "distances " + kPoint,
    kDistances,
    "distances . extra " + kPoint,
    kDistances + kPoint + "--nonsense",
    kDistances + kPoint + "--nonsense --help",
    kDistances + kPoint + "more --help",
    kDistances + kPoint + "--rho -1",
    kDistances + kPoint + "--rho 0",
    kDistances + kPoint + "--rho nan",
    kDistances + kPoint + "--rho inf",
    kDistances + kPoint + "--rho 1e999",
    kDistances + kPoint + "--rho ''",
    kDistances + kPoint + "--rho wide",
    kDistances + kPoint + "--rho wide --help",
    kDistances + kPoint + "--rho 1 --rho 2",
    kDistances + kPoint + "--method exact",
    kDistances + kPoint + "--collect all",
    kDistances + kPoint + "--outside inside",
    kDistances + kPoint + "--window 3",
    kDistances + kPoint + "--format xml",
    kDistances + kPoint + "--in kitchen",
    kDistances + kPoint + "--d-min -1",
    kDistances + kPoint + "--step 0",
    kDistances + kPoint + "--step nan",
    kDistances + kPoint + "--step 1e-5",
    kDistances + kPoint + "--growth -1",
    kDistances + kPoint + "--count 0",
    kDistances + kPoint + "--count 65536",
    kDistances + kPoint + "--count 1.5",
    kDistances + kPoint + "--count 99999999999999",
    kDistances + kPoint + "--frames 4",
    kDistances + kPoint + "--frames 6:5",
    kDistances + kPoint + "--frames 5:6:0",
    kDistances + kPoint + "--frames 5:6:1:1",
    kDistances + kPoint + "--frames five",
    kDistances + kPoint + "--frames -1",
    kDistances + kPoint + "--frames 5,",
    kDistances + kPoint + "--frames ''",
    kDistances + kPoint + "--cameras middle",
    kDistances + kPoint + "--cameras left,left",
    kDistances + kPoint + "--cameras ''",
    kDistances + kPoint + "--principal middle",
    kDistances + kPoint + "--principal ''",
    kDistances + kPoint + "--cameras left --principal right",
    kDistances + kPoint + "--near -1",
    kDistances + kPoint + "--near 3 --far 2",
    kDistances + kPoint + "--far 0",
    kDistances + kPoint + "--beyond-far clamp",
    kDistances + kPoint + "--beyond-far stop",
    kDistances + kPoint + "--sensor kinect",
    kDistances + kPoint + "--margin-constant -0.01",
    kDistances + kPoint + "--margin-linear nan",
    kDistances + kPoint + "--margin-quadratic inf",
    kDistances + kPoint + "--margin-lateral 17",
    kDistances + kPoint + "--margin-lateral -1",
    kDistances + kPoint + "--margin-lateral 1.5",
    kDistances + kPoint + "--margin-translation -1",
    kDistances + kPoint + "--margin-rotation -1",
    kDistances + kPoint + "--margin-time -1",
    kDistances + kPoint + "--half-exposure 0.01",
    kDistances + kPoint + "--v-max 1",
    kDistances + kPoint + "--map wall.map",
    kDistances + kPoint + "--method letter --margin-constant 0.01",
    kDistances + kPoint + "--output a --output b",
    "distances . --output '' " + kPoint,
    "distances '' " + kPoint,
    kDistances + kPoint + "--pictures ''",
    kDistances + "--points ''",
    kDistances + "--point ''",
    kDistances + "--point",
    kDistances + "--point 1,2",
    kDistances + "--point 1,2,3,4,5",
    kDistances + "--point 1,2,x",
    kDistances + "--point 1,2,1e308",
    kDistances + "--point 1,2,nan",
    kDistances + "--point =1,2,3",
    kDistances + "--point \"$(printf 'a\\033[2J')=1,2,3\"",
    kDistances + "--point ball=0.2,0,1.7,0.1",
    kDistances + "--point a=0,0,1 --point a=0,0,2",
    kDistances + "--point hand=0,0,1 --points points.csv",
    kDistances + "--points spheres.csv",
    kSearch,
    kSearch + "--v-max 0",
    kSearch + "--v-max -1 --box=-1,-1,0.5,1,1,2",
    kSearch + "--v-max nan --box=-1,-1,0.5,1,1,2",
    kSearch + "--v-max 0 --box=0,0,0,1,1",
    kSearch + "--v-max 0 --box=0,0,0,1,-1,1",
    kSearch + "--v-max 0 --box=0,0,0,1,1,1e308",
    kSearch + "--v-max 0 --d-min 2 --d-max 1",
    kBoxed + "--d-max 3",
    kBoxed + "--rho -1",
    kBoxed + "--rho 1e9",
    kBoxed + "--resolution 0",
    kBoxed + "--resolution 9",
    kBoxed + "--budget-nodes 0",
    kBoxed + "--budget-nodes many",
    kBoxed + "--ignored-pocket 1",
    kBoxed + "--step 0.01",
    kBoxed + "--count 5",
    kBoxed + "--window image",
    kBoxed + "--margin-translation -1",
    kBoxed + "--half-exposure -1",
    kBoxed + "--time-uncertainty nan",
    kDistances + kPoint + "--method search",
};
const std::vector<std::string> kOtherLines{
    "info",
    "info . extra",
    "info . --nonsense",
    "info . --nonsense --help",
    "info . --frames 9",
    "info . --frames five",
    "info . --cameras middle",
    "info . --cameras left,left",
    "info . --near 3 --far 2",
    "info . --near -1",
    "info . --limit 0",
    "info . --limit nan",
    "info . --least-overlap 2",
    "info . --least-overlap nan",
    "info . --stride 0",
    "info . --stride 1.5",
    "info . --output ''",
    "info ''",
    "map",
    "map nonsense",
    "map nonsense --help",
    "map --nonsense",
    "map build",
    "map build .",
    "map build . --output",
    "map build . --output ''",
    "map build . extra --output wall.map",
    "map build . --nonsense --help",
    "map build . --output wall.map --count 0",
    "map build . --output wall.map --count 65536",
    "map build . --output wall.map --step nan",
    "map build . --output wall.map --step 0",
    "map build . --output wall.map --growth -1",
    "map build . --output wall.map --d-min -1",
    "map build . --output wall.map --storage octree",
    "map build . --output wall.map --memory 0",
    "map build . --output wall.map --memory nan",
    "map build . --output wall.map --threads -1",
    "map build . --output wall.map --threads 1e9",
    "map build . --output wall.map --cameras middle",
    "map build . --output wall.map --cameras left,left",
    "map build . --output wall.map --principal middle",
    "map info",
    "map info a b",
    "map info --nonsense --help",
    "map info ''",
    "rig",
    "rig nonsense --help",
    "rig from",
    "rig from rig.json",
    "rig from --output x.json",
    "rig from rig.json --output ''",
    "rig from rig.json --output x.json --nonsense --help",
    "demo extra",
    "demo --nonsense",
    "demo --nonsense --help",
    "demo --method exact",
    "demo --picture",
    "demo --picture ''",
    "demo --picture -",
    "map build . --output -",
    "rig from rig.json --output -",
    "robot arm.urdf --output -",
    "robot arm.urdf --tip hand",
    "robot arm.urdf --joints=1",
    "robot arm.urdf --package arm",
    "robot arm.urdf --shapes all",
    "robot arm.urdf --nonsense --help",
    "robot",
    "robot ''",
};

TEST(WrongLines, OfTheTopLevelEndWith2) {
  for (const std::string& line : kTopLines) {
    expect_refused(line, 2);
  }
}

TEST(WrongLines, OfDistancesEndWith2) {
  for (const std::string& line : kDistancesLines) {
    expect_refused(line, 2);
  }
}

TEST(WrongLines, OfTheOtherCommandsEndWith2) {
  for (const std::string& line : kOtherLines) {
    expect_refused(line, 2);
  }
}

TEST(WrongLines, HelpAndVersionAloneEndWith0) {
  const TemporaryFolder folder;
  for (const std::string line : {"--help", "-h", "--version", "distances --help", "distances . --help",
                                 "map build --help", "distances . --rho 1 --help"}) {
    EXPECT_EQ(run_command(line, folder).exit_code, 0) << line;
  }
}

TEST(WrongFiles, EndWith1) {
  for (const std::string& line : std::vector<std::string>{
           "distances nowhere " + kPoint,
           "distances broken.json " + kPoint,
           "distances points.csv " + kPoint,
           "distances left_005.png " + kPoint,
           kDistances + "--points broken.csv",
           kDistances + "--points nowhere.csv",
           kDistances + kPoint + "--method letter --map nowhere.map",
           kDistances + kPoint + "--method letter --map rig.json",
           "distances . " + kPoint + "--output nowhere/out.csv",
           kDistances + kPoint + "--pictures nowhere/pictures",
           "info nowhere",
           "info broken.json",
           "map build nowhere --output wall.map",
           "map build broken.json --output wall.map",
           "map build . --output nowhere/wall.map",
           "map info nowhere.map",
           "map info rig.json",
           "demo --picture nowhere/demo.png",
       }) {
    expect_refused(line, 1);
  }
}

TEST(NoSuchCommand, IsNamedWithItsParent) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_command("nonsense --help", folder).err,
            "depthgrid: there is no command 'nonsense' (depthgrid --help lists them)\n");
  EXPECT_EQ(run_command("map nonsense", folder).err,
            "depthgrid: there is no command 'map nonsense' (depthgrid map --help lists them)\n");
}

// The address sanitizer reserves terabytes.
#ifdef __SANITIZE_ADDRESS__
const std::string kLimited = "timeout 60 ";
#else
const std::string kLimited = "ulimit -v 4000000 && timeout 20 ";
#endif

/// Pipes never end, devices neither, and folders are no files: each is refused within a moment and with little memory.
TEST(WrongFiles, PipesDevicesAndFoldersEndInOneLine) {
  for (const std::string place : {"pipe", "/dev/zero", "folder"}) {
    for (const std::string& line :
         std::vector<std::string>{"distances " + place + " " + kPoint, kDistances + "--points " + place,
                                  "info " + place, kDistances + kPoint + "--method letter --map " + place,
                                  "map build " + place + " --output wall.map", "map info " + place}) {
      const TemporaryFolder folder;
      write_wall(folder);
      std::filesystem::create_directory(folder / "folder");
      ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
      const auto result = run_command(line + "; test $? = 1 || exit 9", folder, kLimited);
      EXPECT_EQ(result.exit_code, 0) << line << ": " << result.err;
      EXPECT_THAT(result.err, StartsWith("depthgrid: ")) << line;
      EXPECT_THAT(result.err, HasSubstr(place)) << line;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << line << "\n" << result.err;
    }
  }
}

TEST(WrongFiles, AnImageLargerThanMemoryEndsInOneLine) {
  const TemporaryFolder folder;
  write_wall(folder);
  std::string png = read_bytes(folder / "left_005.png");
  png.replace(16, 8, std::string("\x00\x00\x40\x00\x00\x00\x40\x00", 8));
  // The checksum of the header has to fit: CRC-32 of IHDR with 16384 x 16384 pixels of 16-bit gray.
  png.replace(29, 4, std::string("\xdc\x33\x93\x1b", 4));
  (void)folder.write("left_005.png", png + std::string(300000, '\0'));
  const auto result = run_command("distances . --sensor ideal " + kPoint, folder);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "depthgrid: ./left_005.png: is 16384 x 16384 pixels, the calibration of camera 'left' is for 64 x 48\n");
}

TEST(WrongFiles, ACameraLargerThanMemoryEndsInOneLine) {
  const TemporaryFolder folder;
  write_wall(folder);
  edit(folder, "rig.json", "\"width\": 64", "\"width\": 16384");
  edit(folder, "rig.json", "\"height\": 48", "\"height\": 16384");
  for (const std::string focal : {"fx", "fy"}) {
    edit(folder, "rig.json", "\"" + focal + "\": 60.0", "\"" + focal + "\": 12000.0");
  }
  edit(folder, "rig.json", "\"cx\": 31.5", "\"cx\": 8191.5");
  edit(folder, "rig.json", "\"cy\": 23.5", "\"cy\": 8191.5");
  const auto result = run_command("distances . --sensor ideal " + kPoint, folder);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "depthgrid: ./rig.json: camera 'left' has 16384 x 16384 = 268435456 pixels, images must have at most "
            "16777216\n");
}

/// What a file or an argument holds reaches the terminal as text only.
TEST(Terminal, IsNeverSteeredByNames) {
  const std::string esc = "\"$(printf '\\033]0;x\\007\\302\\233')\"";
  for (const std::string& line : std::vector<std::string>{
           "distances " + esc + " " + kPoint, "distances . --points " + esc, "distances . --point " + esc + "=0,0,1",
           "distances . --point 0,0," + esc, "distances . --sensor ideal " + kPoint + "--output " + esc + "/x",
           "distances . --sensor ideal " + kPoint + "--pictures " + esc + "/x/y",
           "distances . " + kPoint + "--cameras " + esc, "distances . " + kPoint + "--frames " + esc,
           "distances . " + kPoint + "--sensor " + esc, esc, "distances . " + kPoint + "--" + esc, "map info " + esc,
           "map build " + esc + " --output x", "map build . --count 5 --output x" + esc + " && mv x* y",
           "demo --picture " + esc + "/x", "info " + esc}) {
    const TemporaryFolder folder;
    write_wall(folder);
    const auto result = run_command(line, folder);
    for (const std::string& text : {result.out, result.err}) {
      EXPECT_TRUE(std::none_of(text.begin(), text.end(),
                               [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7F || c == 0x9B; }))
          << line << "\n"
          << text;
    }
    EXPECT_TRUE(result.exit_code == 0 || !result.err.empty()) << line;
  }
}

TEST(Terminal, NamesOfARigFileArePrintable) {
  const TemporaryFolder folder;
  write_wall(folder);
  edit(folder, "rig.json", "\"left\"", "\"le\\u009bft\"");
  const auto result = run_command("info .", folder);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "depthgrid: ./rig.json: /cameras/0/id: \"le\\xc2\\x9bft\" holds a control character, names must not\n");
}

TEST(ForeignRecording, IsExplained) {
  struct Foreign {
    std::string name, bytes, what;
  };
  for (const auto& [name, bytes, what] :
       {Foreign{"a.bag", "#ROSBAG V2.0\n", "a ROS 1 bag"}, Foreign{"renamed.json", "#ROSBAG V2.0\n", "a ROS 1 bag"},
        Foreign{"a.ONI", "NI10....", "an OpenNI recording"}, Foreign{"a.db3", "SQLite format 3", "a ROS 2 bag"},
        Foreign{"empty.bag", "", "a ROS 1 bag"}, Foreign{"a.svo2", "...", "a recording of a ZED camera"},
        Foreign{"bag2/metadata_0.db3", "", "a ROS 2 bag"},
        Foreign{"bag2/metadata.yaml", "rosbag2_bagfile_information:", "a ROS 2 bag"}}) {
    const TemporaryFolder folder;
    (void)folder.write(name, bytes);
    const std::string given = name.substr(0, name.find("/metadata"));
    for (const std::string& line :
         {"distances " + given + " " + kPoint, "info " + given, "map build " + given + " --output x.map"}) {
      const auto result = run_command(line, folder);
      EXPECT_EQ(result.exit_code, 1) << line;
      EXPECT_THAT(result.err, HasSubstr(given + ": is " + what)) << line;
      EXPECT_THAT(result.err, HasSubstr("16-bit PNG files")) << line;
      EXPECT_THAT(result.err, HasSubstr("docs/rig-file.md")) << line;
    }
  }
}

/// Nobody says anything about the errors of the wall's cameras: that is said once, in one line, and the command goes
/// on.
TEST(ExactCameras, AreWarnedOfOnce) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::string question = "distances . --frames 5 " + kPoint;
  const auto silent = run_command(question + "--sensor ideal", folder);
  const auto warned = run_command(question, folder);
  EXPECT_EQ(warned.exit_code, 0);
  EXPECT_EQ(warned.out, silent.out);
  EXPECT_EQ(warned.err,
            "depthgrid: warning: nothing says how far the readings of 'left', 'right' may err, so they count as exact "
            "and distances may be too large; give --sensor NAME (ideal: they are exact)\n");
  for (const std::string said :
       {"--sensor ideal", "--margin-constant 0", "--margin-translation 0", "--sensor kinect-v1 --margin-translation 0",
        "--sensor kinect-v1 --margin-rotation 0", "--method letter --sensor ideal"}) {
    EXPECT_EQ(run_command(question + said, folder).err, "") << said;
  }
  EXPECT_EQ(run_command(question + "--method letter", folder).err,
            "depthgrid: warning: --method letter allows for no errors of readings and calibration, so distances may be "
            "too large; --method corrected and search do (--sensor ideal: there are none)\n");
  EXPECT_EQ(
      run_command(question + "--sensor kinect-v1", folder).err,
      "depthgrid: warning: nothing says how far the calibration of 'left', 'right' may err, so it counts as exact "
      "and distances may be too large; give --margin-translation and --margin-rotation (0: it is exact)\n");
  auto file = wall_rig();
  file.rig.cameras[0].margins = CameraMargins{};
  files::save_rig(file, folder / "rig.json");
  EXPECT_THAT(run_command(question, folder).err, HasSubstr("the readings of 'right' may err"));
  EXPECT_EQ(run_command(question + "--cameras left", folder).err, "") << "zero said in the rig file";
}

}  // namespace
}  // namespace depthgrid::test
