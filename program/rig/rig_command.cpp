#include "program/rig/rig_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <sstream>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/text_file.hpp"
#include "program/output_check.hpp"
#include "program/output_file.hpp"
#include "program/rig/imported_camera.hpp"
#include "program/rig/rig_options.hpp"
#include "program/warning.hpp"

namespace depthgrid::program {

namespace {

void run(const RigOptions& options) {
  std::vector<NamedFile> inputs;
  for (const std::string& file : options.files) {
    inputs.push_back({"the calibration", file});
  }
  refuse_overwriting({{"--output", options.output}}, inputs);
  check_output_file(options.output);
  std::vector<ImportedCamera> cameras;
  for (const std::string& file : options.files) {
    for (ImportedCamera& camera : import_cameras(files::read_text_file(file), file, options.import)) {
      cameras.push_back(std::move(camera));
    }
  }
  const files::RigFile rig = make_rig(cameras, options);
  files::save_rig(rig, options.output);
  if (cameras.size() > 1) {
    warn(
        options.output +
        ": says that images of one frame were taken at the same time; if they were not, write \"simultaneous\": false");
  }
  std::ostringstream text;
  text << printable(options.output) << ":\n";
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const RigCamera& camera = rig.rig.cameras[k];
    const auto& t = camera.T_world_camera.translation();
    text << "  " << camera.id << ": " << cameras[k].format << ", " << camera.intrinsics.width_px << " x "
         << camera.intrinsics.height_px << ", "
         << (distorts(camera.distortion) ? to_string(camera.distortion.model) : "no distortion") << ", at (" << t.x()
         << ", " << t.y() << ", " << t.z() << ") m"
         << (rig.depth_files[k].empty() ? ", depth_files still to be named" : "") << "\n";
  }
  OutputFile output("-");
  output.write(text.str());
  output.commit();
}

void add_from_command(CLI::App& rig) {
  auto options = std::make_shared<RigOptions>();
  CLI::App* command = rig.add_subcommand("from", "a rig file from calibration files of other programs");
  command
      ->add_option("FILE", options->files,
                   "ROS camera_info, Kalibr camchain, Open3D intrinsic or Azure Kinect calibration; recognised by what "
                   "stands in them")
      ->required();
  command->add_option("--output", options->output, "rig file to write")->required();
  command->add_option("--metres-per-unit", options->metres_per_unit, "of the 16-bit images: M, or ID=M for one camera")
      ->allow_extra_args(false);
  command->add_option("--sensor", options->sensors, "sensor model or none: NAME, or ID=NAME for one camera")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--pose", options->poses,
          "T_world_camera: [ID=]x,y,z,qx,qy,qz,qw, 16 numbers row after row, or identity; of a Kalibr chain only "
          "the first camera's")
      ->allow_extra_args(false);
  command->add_option("--ids", options->ids, "names of all cameras, in their order")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--depth-files", options->depth_files, "[ID=]PATTERN of the image files, for instance a/%04d.png")
      ->allow_extra_args(false);
  command->add_option("--frames", options->frames, "numbers of the frames, FIRST:LAST");
  command->add_flag("--rectified", options->import.rectified,
                    "ROS: the images are rectified ones; takes P instead of K and the distortion");
  command->add_option("--depth-mode", options->import.depth_mode,
                      "Azure Kinect: nfov_unbinned, nfov_2x2binned, wfov_unbinned or wfov_2x2binned");
  command->footer(
      "Examples:\n"
      "  depthgrid rig from left.yaml right.yaml --metres-per-unit 0.001 --sensor realsense_d435 \\\n"
      "      --pose left=0,0,1.2,0,0,0,1 --pose right=0.4,0,1.2,0,0,0,1 --output rig.json\n"
      "  depthgrid rig from camchain.yaml --pose cam0=identity --metres-per-unit 0.001 --sensor none --output "
      "rig.json\n"
      "What files do not say is asked for; a table of files stands in docs/rig-file.md.");
  command->callback([options] { run(*options); });
}

}  // namespace

void add_rig_command(CLI::App& app) {
  CLI::App* rig = app.add_subcommand("rig", "rig files: make one from other calibrations");
  rig->require_subcommand(1);
  add_from_command(*rig);
}

}  // namespace depthgrid::program
