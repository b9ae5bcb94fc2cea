#include "program/mcap_options.hpp"

#include <CLI/CLI.hpp>

namespace depthgrid::program {

void add_mcap_options(CLI::App& command, files::McapChoice& choice) {
  const char* const group = "MCAP files";
  command
      .add_option("--depth-topics", choice.depth_topics,
                  "topics of depth images, with commas: /left/depth/image_raw or left=/left/depth/image_raw (default: "
                  "all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_option("--world", choice.world_frame,
                  "frame that is the world (default: the one that /tf_static's transforms end at)")
      ->group(group);
  command
      .add_option("--rig", choice.rig,
                  "rig file of the cameras, in place of camera_info and /tf_static; its ids choose the topics")
      ->group(group);
  command
      .add_option("--tolerance", choice.tolerance_s,
                  "how far apart images of one frame may be, by their time stamps, seconds")
      ->group(group);
}

}  // namespace depthgrid::program
